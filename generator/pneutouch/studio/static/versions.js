// Designs as the page read them: the version of each file, which the page's states are changes to, and the answer to it.
import { post } from "./requests.js";

/** Status of an answer: the file was changed since the page read it, by another page or an editor. */
export const CHANGED = 412;

export class Versions {
  constructor() {
    Object.assign(this, { known: {}, plain: {} });
  }

  /** A state with the version of the file that its changes are made to; null: as the file is. */
  of(state) {
    return { ...state, version: this.known[state.base] ?? null };
  }

  /** From here on the states of a design are changes to this version of its file; null: to the file as it is then. */
  read(base, version = null) {
    if (this.known[base] !== version) delete this.plain[base];
    this.known[base] = version;
  }

  /** Get the values of the design itself, for its form, and call `then`: the answer to changes that cannot work holds none. */
  async fetch(base, then) {
    const question = this.of({ base, values: {} });
    try {
      const { status, content } = this.plain[base] ? {} : await post("/api/quick", question);
      if (status === 200) this.answered(question, content);
      then();
    } catch {
      // The studio was stopped: the next move says so.
    }
  }

  /** Note an answer; the question with the version that it was answered for. */
  answered(question, content) {
    this.read(question.base, content.version);
    if (!Object.keys(question.values).length) this.plain[question.base] = content;
    return this.of(question);
  }
}
