// The area Files: build with progress, the files and the datasheet; open, save and export.
import { options, quoted, written } from "./address.js";
import { copied, element } from "./dom.js";
import { Built } from "./built.js";
import { Job } from "./jobs.js";
import { ENDINGS, notify, openFile } from "./opening.js";
import { post } from "./requests.js";

const labelled = (words, input, ...more) => element("label", { class: "named" }, element("span", {}, words), input, ...more);
const text = (more = {}) => element("input", { type: "text", autocomplete: "off", spellcheck: "false", maxlength: 100, ...more });
const button = (words, onclick, more = {}) => element("button", { type: "button", onclick, ...more }, words);

/** The name that a state brings along: its title where that was changed, as for a candidate that was chosen; else its base's. */
function ownName({ base, values }) {
  const title = values["document.title"] ?? "";
  return title.toLowerCase().replace(/[^a-z0-9]+/g, "-").replace(/^-|-$/g, "").slice(0, 60) || base;
}

/** A problem in words; its field is named where the words do not. */
const worded = ({ message, fields = [] }) => element("p", {}, fields.length && !message.includes(fields[0]) ? `${fields[0]}: ${message}` : message);

/** A card with its heading. */
function card(id, title, ...content) {
  return element("section", { class: "card", "aria-labelledby": `${id}-title` }, element("h2", { id: `${id}-title` }, title), ...content);
}

/** A command to be typed, with a button that copies it; hidden where `left` has keys that are left out: no option does that. */
class Command {
  constructor(id) {
    this.code = element("code", { id });
    this.copy = button("Copy", () => this.taken());
    this.line = element("div", { class: "command" }, element("pre", { tabindex: 0, "aria-label": "Command" }, this.code), this.copy);
    this.row = element("div", {}, element("p", { class: "muted" }, "The command that does the same:"), this.line);
  }

  show(words, left) {
    this.code.textContent = words;
    this.copy.textContent = "Copy";
    this.row.hidden = left.length > 0;
  }

  async taken() {
    if (await copied(this.code.textContent)) this.copy.textContent = "Copied";
    else getSelection().selectAllChildren(this.code);
  }
}

class Files {
  constructor(root, page) {
    Object.assign(this, { page, job: null, opened: null });
    this.built = new Built(page);
    root.replaceChildren(element("div", { class: "files" }, this.buildCard(), this.built.files, this.openCard(), this.saveCard(), this.built.sheet));
    document.addEventListener("design", () => this.show());
    document.addEventListener("opened", ({ detail }) => this.named(detail));
    this.show();
    this.adopt();
  }

  buildCard() {
    this.name = text({ id: "build-name", oninput: () => this.show() });
    this.begin = button("Build", () => this.build(), { id: "build", class: "primary" });
    this.cancel = button("Cancel", () => this.job?.cancel(), { id: "build-cancel", hidden: true });
    this.progress = element("progress", { id: "build-progress", max: 1, value: 0, "aria-label": "Progress of the build", hidden: true });
    this.status = element("p", { id: "build-status", role: "status", class: "muted" });
    this.problems = element("div", { id: "build-problems", role: "alert" });
    this.buildCommand = new Command("build-command");
    this.left = element("p", { class: "muted", id: "build-left" });
    const words = "Print files, prediction, datasheet and print sheet of the design as it is now.";
    const row = element("div", { class: "row" }, labelled("Name", this.name), this.begin, this.cancel);
    return card("build", "Build", element("p", { class: "muted" }, words), row, this.progress, this.status, this.problems, this.buildCommand.row, this.left);
  }

  openCard() {
    const chosen = (event) => {
      const [file] = event.target.files;
      if (file) openFile(file, this.page);
      event.target.value = "";
    };
    const input = element("input", { type: "file", id: "open-file", accept: ENDINGS, onchange: chosen });
    const words = "A 3MF that was built, a design file (.toml) or an exported design (.json) becomes the design of this page. Dropping it anywhere on the page does the same.";
    return card("open", "Open", element("p", { class: "muted" }, words), labelled("File", input));
  }

  saveCard() {
    this.saveName = text({ id: "save-name", oninput: () => this.show() });
    this.replace = element("input", { type: "checkbox", id: "save-replace" });
    this.replaceRow = element("label", { class: "check", hidden: true }, this.replace, " Replace the file that is there");
    this.saveProblems = element("div", { id: "save-problems", role: "alert" });
    this.saveCommand = new Command("save-command");
    const save = element("form", { class: "plain", "aria-label": "Save as design", onsubmit: (event) => this.save(event) },
      element("div", { class: "row" }, labelled("Name", this.saveName), element("button", { type: "submit", id: "save" }, "Save")),
      this.replaceRow);
    const exported = button("Export", () => this.exported(), { id: "export" });
    const words = "Writes a design file into your folder. It is then among the designs of this page and of the commands.";
    const other = "Export downloads the design and its changes as a small file, to be opened on this page again.";
    return card("save", "Save as design", element("p", { class: "muted" }, words), save, this.saveProblems, this.saveCommand.row,
      element("div", { class: "row end" }, element("p", { class: "muted" }, other), exported));
  }

  /** What depends on the design: names that stand where none is typed, commands, and whether files are of this design. */
  show() {
    const state = this.page.state();
    if (this.opened && this.opened.base !== state.base) {
      if (this.name.value === this.opened.name) this.name.value = "";
      this.opened = null;
    }
    const own = ownName(state);
    this.name.placeholder = own;
    this.saveName.placeholder = own === state.base ? `my-${own}` : own;
    const base = this.page.words(state.base);
    const left = Object.keys(state.values).filter((key) => state.values[key] === null);
    const name = this.name.value.trim() || own;
    this.buildCommand.show(`pneutouch build ${options(state, base)}${name !== state.base ? ` --name ${quoted(name)}` : ""}`, left);
    this.saveCommand.show(`pneutouch new ${quoted(this.saveAs())} --from ${options(state, base)}`, left);
    this.left.textContent = left.length ? `No option of the commands leaves out ${left.join(", ")}: save the design, and build it by its name.` : "";
    this.built.compare(written(state));
  }

  saveAs() {
    return this.saveName.value.trim() || this.saveName.placeholder;
  }

  /** A file that was opened names what is built and saved from it. */
  named({ name, base }) {
    this.opened = { name, base };
    this.name.value = name === base ? "" : name;
    this.saveName.value = name === base ? "" : name;
    this.show();
  }

  build() {
    const question = this.page.state();
    const name = this.name.value.trim() || ownName(question);
    this.watch(new Job("build", { question, ...(name === question.base ? {} : { name }) }, (progress) => this.moved(progress)));
  }

  /** A build that was begun before this page was opened, or on another one. */
  async adopt() {
    const known = await Job.known("build", (progress) => this.moved(progress)).catch(() => null);
    if (known && !this.job) this.watch(known);
  }

  async watch(job) {
    this.job = job;
    this.busy(true);
    this.problems.replaceChildren();
    this.moved({});
    try {
      const done = await job.done;
      if (done) this.built.show(job, done, written(this.page.state()));
      this.status.textContent = done ? `Built ${done.content.name}: ${done.files.length} files.` : "Cancelled. Nothing was kept.";
    } catch (error) {
      this.status.textContent = "";
      await this.failed(error);
    }
    this.job = null;
    this.busy(false);
  }

  async failed(error) {
    this.problems.replaceChildren(...(error.problems ?? [error]).map(worded));
    const other = error.busy ? await Job.known(null).catch(() => null) : null;
    if (!other?.running) return;
    const end = async () => {
      await other.cancel();
      this.problems.replaceChildren();
      this.status.textContent = "The other job was cancelled.";
    };
    this.problems.append(button("Cancel the other job", end));
  }

  busy(on) {
    const held = [this.begin, this.cancel].includes(document.activeElement);
    this.begin.disabled = on;
    this.progress.hidden = this.cancel.hidden = !on;
    // What was pressed is gone: the keyboard goes on with the other one.
    if (held) (on ? this.cancel : this.begin).focus();
  }

  moved({ done, total, what }) {
    if (total) Object.assign(this.progress, { max: total, value: done });
    else this.progress.removeAttribute("value");
    const stage = what ? `Building: ${what}, step ${done + 1} of ${total}.` : "Starting.";
    this.status.textContent = this.job?.unwanted ? "Cancelling." : stage;
  }

  async save(event) {
    event.preventDefault();
    this.saveProblems.replaceChildren();
    const request = { question: this.page.state(), name: this.saveAs(), replace: !this.replaceRow.hidden && this.replace.checked };
    let answer;
    try {
      answer = await post("/api/designs", request);
    } catch (error) {
      answer = { status: 0, content: { problems: [{ message: error.message }] } };
    }
    const { status, content } = answer;
    this.replaceRow.hidden = status !== 409;
    this.replace.checked = false;
    if (status !== 200) {
      this.saveProblems.replaceChildren(...content.problems.map(worded));
      if (status === 409) this.replace.focus();
      return;
    }
    this.saveName.value = "";
    this.page.saved(content.name);
    notify(`Saved as ${content.file}. It is now the design of this page.`);
  }

  exported() {
    const { base, values } = this.page.state();
    const content = { format: "pneutouch/exported-design/1", version: this.page.version(), base, values };
    const url = URL.createObjectURL(new Blob([`${JSON.stringify(content, null, 2)}\n`], { type: "application/json" }));
    element("a", { href: url, download: `${base}.json` }).click();
    setTimeout(() => URL.revokeObjectURL(url), 10000);
  }
}

export function open(root, page) {
  return new Files(root, page);
}
