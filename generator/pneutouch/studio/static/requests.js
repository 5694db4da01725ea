// Questions to the studio: one sent at a time, and of those that wait the newest alone.

export class Stopped extends Error {}

const STOPPED =
  `pneutouch studio does not answer: it was stopped. Start it again with --port ${location.port} and open the address that it prints: ` +
  "then this page answers again. Its design is in its address.";

const KEY = "pneutouch-key";
const REPLACED = "This page belongs to a studio that was stopped. Open the address that the new one printed, and this page answers again.";

/** Give the token of the address, which opens once, for the key. The browser keeps it for the pages of this very port. */
export async function unlock() {
  const token = new URLSearchParams(location.search).get("token");
  if (token === null) return;
  history.replaceState(null, "", location.pathname + location.hash);
  const headers = { "Content-Type": "application/json", [KEY]: token };
  const answer = await fetch("/api/open", { method: "POST", headers });
  if (answer.ok) localStorage.setItem(KEY, (await answer.json()).key);
}

/** Like fetch, but with the key, and with words for a studio that was stopped. The page tries again with the user's next move. */
export async function send(path, options = {}, silent = STOPPED) {
  const key = localStorage.getItem(KEY) ?? "";
  let answer;
  try {
    answer = await fetch(path, { ...options, headers: { ...options.headers, [KEY]: key } });
  } catch {
    throw new Stopped(silent);
  }
  if (answer.status === 403) throw new Stopped(key ? REPLACED : await answer.text());
  return answer;
}

export async function post(path, question) {
  const answer = await send(path, {
    method: "POST",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify(question),
  });
  const type = answer.headers.get("content-type") || "";
  const content = type.includes("json") ? await answer.json() : { problems: [{ message: await answer.text(), fields: [] }] };
  return { status: answer.status, content };
}

/** Sends questions to `path`; while one has no answer yet the newest one waits, unless it is the same, and older ones are dropped. */
export class Line {
  /** `replaced(question)`: the studio gave the place of a question to another one. */
  constructor(path, answered, failed, replaced = () => {}) {
    Object.assign(this, { path, answered, failed, replaced, busy: false, waiting: null, sent: null });
  }

  async send(question) {
    if (this.busy) {
      this.waiting = JSON.stringify(question) === this.sent ? null : question;
      return;
    }
    this.busy = true;
    let next = question;
    while (next !== null) {
      this.waiting = null;
      this.sent = JSON.stringify(next);
      try {
        const { status, content } = await post(this.path, next);
        if (status === 409) this.replaced(next);
        else this.answered(next, status, content);
      } catch (error) {
        this.failed(next, error);
      }
      next = this.waiting;
    }
    this.busy = false;
  }
}
