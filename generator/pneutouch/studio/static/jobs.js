// Jobs of the studio: started, watched, cancelled; and files given to it.
import { post, send, Stopped } from "./requests.js";

const PAUSE = 300;

const LARGEST_MB = 64;

/** What went wrong, as the studio's problems; `busy` where another job runs. */
export class Failed extends Error {
  constructor(problems, busy = false) {
    super(problems.map((each) => each.message).join("; "));
    Object.assign(this, { problems, busy });
  }
}

/** A job that runs: `done` is a promise of its document, null where it was cancelled, and fails with `Failed`. */
export class Job {
  /** `moved` is called with {done, total, what} while the job runs. */
  constructor(kind, request, moved = () => {}) {
    this.done = this.run(post(`/api/jobs/${kind}`, request), moved);
  }

  /** The newest job of a kind (any, where none is given) that runs or has its files still; null without one. */
  static async known(kind, moved = () => {}) {
    const { jobs } = await (await send("/api/jobs")).json();
    const own = jobs.filter((one) => (!kind || one.kind === kind) && ["running", "done"].includes(one.state)).at(-1);
    if (!own) return null;
    const job = Object.create(Job.prototype);
    job.running = own.state === "running";
    job.done = job.run(Promise.resolve({ status: 202, content: own }), moved);
    return job;
  }

  async run(begun, moved) {
    const { status, content } = await begun;
    if (status !== 202) throw new Failed(content.problems, status === 409);
    this.path = `/api/jobs/${content.job}`;
    this.files = `/files/${content.ticket}`;
    if (this.unwanted) await this.cancel();
    let job = content;
    while (job.state === "running") {
      await new Promise((next) => setTimeout(next, PAUSE));
      job = await (await send(this.path)).json();
      moved(job.progress ?? {});
    }
    if (job.state === "cancelled") return null;
    if (job.state !== "done") throw new Failed(job.content?.problems ?? job.problems);
    return job;
  }

  async cancel() {
    this.unwanted = true;
    if (this.path) await post(`${this.path}/cancel`, {});
  }

  /** Addresses of a job's files: one by its name (`show` to look at it in place), and all in one archive. */
  file(name, show = false) {
    return `${this.files}/${name.split("/").map(encodeURIComponent).join("/")}${show ? "?show=1" : ""}`;
  }

  get archive() {
    return `${this.files}.zip`;
  }
}

/** Gives a file of the user to the studio; the number that jobs name it by. */
export async function upload(file) {
  if (file.size > LARGEST_MB * 2 ** 20) {
    throw new Failed([{ message: `${file.name}: a file has at most ${LARGEST_MB} MB`, fields: [] }]);
  }
  const options = { method: "POST", headers: { "Content-Type": "application/octet-stream" }, body: file };
  const silent = `${file.name} cannot be read (a folder is no file), or pneutouch studio was stopped.`;
  const answer = await send(`/api/uploads?name=${encodeURIComponent(file.name)}`, options, silent);
  const content = await answer.json();
  if (answer.status !== 200) throw new Failed(content.problems);
  return content.upload;
}

/** A page with one job at a time: its status, progress, cancelling and failure; `impossible` is said where it fails. */
export class JobPage {
  constructor(impossible) {
    Object.assign(this, { impossible, job: null });
  }

  report(words, busy = false) {
    this.status.textContent = words;
    this.status.classList.toggle("busy", busy);
  }

  running(job) {
    this.job = job;
    this.begin.disabled = Boolean(job);
    this.under.hidden = !job;
    // On a narrow screen the results are below the form.
    if (job) this.under.scrollIntoView({ block: "nearest" });
    this.results.classList.toggle("stale", Boolean(job));
  }

  moved(progress, words) {
    if (!progress.total) return;
    Object.assign(this.progress, { max: progress.total, value: progress.done });
    this.report(words(progress), true);
  }

  async cancel() {
    this.report("Cancelling.", true);
    await this.job?.cancel();
  }

  failed(error) {
    if (!(error instanceof Failed)) {
      this.report(error instanceof Stopped ? error.message : `The page has a fault: ${error.message}`);
      if (!(error instanceof Stopped)) throw error;
      return;
    }
    this.problem(error.problems);
    this.report(this.impossible);
    this.root.querySelector(".faulty input, .faulty select, .faulty textarea")?.focus();
  }
}
