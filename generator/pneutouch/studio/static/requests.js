// Questions to the studio: one sent at a time, and of those that wait the newest alone.

export class Stopped extends Error {}

export async function post(path, question) {
  let answer;
  try {
    answer = await fetch(path, {
      method: "POST",
      headers: { "Content-Type": "application/json" },
      body: JSON.stringify(question),
    });
  } catch {
    throw new Stopped("pneutouch studio does not answer: it was stopped. Start it again; this design is in the address.");
  }
  if (answer.status === 403) {
    throw new Stopped("This page belongs to a studio that was stopped. Open the address that the new one printed.");
  }
  const type = answer.headers.get("content-type") || "";
  const content = type.includes("json") ? await answer.json() : { problems: [{ message: await answer.text(), fields: [] }] };
  return { status: answer.status, content };
}

/** Sends questions to `path`; while one question has no answer yet the newest other one waits, and older ones are dropped. */
export class Line {
  constructor(path, answered, failed) {
    Object.assign(this, { path, answered, failed, busy: false, waiting: null });
  }

  async send(question) {
    if (this.busy) {
      this.waiting = question;
      return;
    }
    this.busy = true;
    let next = question;
    while (next !== null) {
      this.waiting = null;
      try {
        const { status, content } = await post(this.path, next);
        if (status !== 409) this.answered(next, status, content);
      } catch (error) {
        this.failed(next, error);
      }
      next = this.waiting;
    }
    this.busy = false;
  }
}
