// Jobs of the studio: started, watched, cancelled; and files given to it.
import { post, Stopped } from "./requests.js";

const PAUSE = 300;

/** What went wrong, as the studio's problems. */
export class Failed extends Error {
  constructor(problems) {
    super(problems.map((each) => each.message).join("; "));
    this.problems = problems;
  }
}

async function get(path) {
  try {
    return await (await fetch(path)).json();
  } catch {
    throw new Stopped("pneutouch studio does not answer: it was stopped. Start it again; this design is in the address.");
  }
}

/** A job that runs: `done` is a promise of its document, null where it was cancelled, and fails with `Failed`. */
export class Job {
  /** `moved` is called with {done, total, what} while the job runs. */
  constructor(kind, request, moved = () => {}) {
    this.done = this.run(kind, request, moved);
  }

  async run(kind, request, moved) {
    const { status, content } = await post(`/api/jobs/${kind}`, request);
    if (status !== 202) throw new Failed(content.problems);
    this.path = `/api/jobs/${content.job}`;
    if (this.unwanted) await this.cancel();
    let job = content;
    while (job.state === "running") {
      await new Promise((next) => setTimeout(next, PAUSE));
      job = await get(this.path);
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
    return `${this.path}/files/${name.split("/").map(encodeURIComponent).join("/")}${show ? "?show=1" : ""}`;
  }

  get archive() {
    return `${this.path}/files.zip`;
  }
}

/** Gives a file of the user to the studio; the number that jobs name it by. */
export async function upload(file) {
  let answer;
  try {
    answer = await fetch(`/api/uploads?name=${encodeURIComponent(file.name)}`, {
      method: "POST",
      headers: { "Content-Type": "application/octet-stream" },
      body: file,
    });
  } catch {
    throw new Stopped("pneutouch studio does not answer: it was stopped, or it refused the file.");
  }
  const content = await answer.json();
  if (answer.status !== 200) throw new Failed(content.problems);
  return content.upload;
}
