// The area Measure: runs of a campaign given, their columns recognised, then characterized and calibrated by jobs.
import { byId, element } from "./dom.js";
import { Fitting } from "./fitting.js";
import { chosen, dropped, give } from "./given.js";
import { Failed, Job } from "./jobs.js";
import { Measured } from "./measured.js";
import { RunsTable } from "./runs.js";

const DELIMITERS = [["", "found"], [",", "comma"], [";", "semicolon"], ["\t", "tab"], [" ", "space"]];
const DECIMALS = [["", "found"], [".", "point"], [",", "comma"]];

const choice = (name, options) =>
  element("select", { name }, ...options.map(([value, words]) => element("option", { value }, words)));

const labelled = (words, input, help = null) =>
  element("div", { class: "field long" }, element("label", {}, words, input), help ? element("p", { class: "help" }, help) : null);

class Measure {
  constructor(root, page) {
    Object.assign(this, { root, page, files: new Map(), job: null, found: null, failed: [] });
    this.table = new RunsTable((words) => this.restate(words));
    this.measured = new Measured();
    this.fitting = new Fitting(this);
    root.append(element("div", { class: "work" }, this.form(), this.results()));
    this.listen();
    this.refresh();
  }

  form() {
    const picker = (words, more) => {
      const input = element("input", { type: "file", multiple: true, hidden: true, "aria-label": words, ...more });
      input.onchange = () => {
        const files = chosen(input.files);
        this.take(() => Promise.resolve(files));
        input.value = "";
      };
      return [element("button", { type: "button", onclick: () => input.click() }, words), input];
    };
    this.drop = element(
      "div",
      { class: "drop" },
      element("p", {}, element("b", {}, "Drop the files of the runs here"), ", or the folder of a campaign."),
      element("div", { class: "row" }, ...picker("Choose files"), ...picker("Choose a folder", { webkitdirectory: true, id: "measure-folder" })),
      element("p", { class: "muted" }, "CSV and other text, .xlsx, .parquet, .tdms, .lvm; campaign.toml states what each run is."),
    );
    this.sum = element("p", { class: "muted", id: "measure-files" });
    this.clear = element("button", { type: "button", onclick: () => this.forget() }, "Clear");
    this.compared = element("select", { id: "measure-design" });
    this.note = element("p", { class: "muted" });
    this.reading = element(
      "details",
      {},
      element("summary", {}, "How files are read"),
      labelled("Columns", element("input", { type: "text", name: "columns", spellcheck: "false" }), "Left out: found by their headers. Such as force=Load:N, position=-Travel:mm; a minus before the name turns the sign."),
      labelled("Decimal mark", choice("decimal", DECIMALS)),
      labelled("Delimiter", choice("delimiter", DELIMITERS)),
      labelled("Encoding", element("input", { type: "text", name: "encoding", spellcheck: "false" }), "Left out: found. Such as cp1252."),
      labelled("Rows before the header", element("input", { type: "text", name: "skip_rows", inputmode: "numeric" })),
      labelled("Sheet or group", element("input", { type: "text", name: "sheet" })),
    );
    this.reading.onchange = () => this.recognise();
    this.start = element("button", { type: "submit", class: "primary" }, "Characterize");
    this.stop = element("button", { type: "button", hidden: true, onclick: () => this.job?.cancel() }, "Cancel");
    const form = element(
      "form",
      { "aria-label": "Measured runs", autocomplete: "off" },
      element("h2", {}, "Runs of a campaign"),
      this.drop,
      element("div", { class: "row between" }, this.sum, this.clear),
      labelled("Compare with", this.compared),
      this.note,
      this.reading,
      element("div", { class: "row go" }, this.start, this.stop),
    );
    form.onsubmit = (event) => {
      event.preventDefault();
      this.characterize();
    };
    return form;
  }

  results() {
    this.status = element("p", { class: "status", role: "status", "aria-live": "polite", id: "measure-status" });
    this.wrong = element("ul", { class: "problems", id: "measure-problems" });
    this.about = element(
      "p",
      { class: "lead" },
      "Give the files that the rig recorded. Shown are the columns that were found, the figures with their intervals next to the prediction, and a model fitted to the sensor.",
    );
    return element("div", { class: "results" }, this.status, element("div", { role: "alert" }, this.wrong), this.about, this.table.root, this.measured.root, this.fitting.root, this.measured.sheet);
  }

  listen() {
    // Wherever files are dropped while this area is shown, they are runs.
    const over = (event) => {
      if (document.body.dataset.area !== "measure" || !event.dataTransfer?.types.includes("Files")) return false;
      event.preventDefault();
      this.drop.classList.toggle("over", event.type === "dragover");
      return true;
    };
    for (const kind of ["dragenter", "dragover", "dragleave"]) document.addEventListener(kind, over);
    document.addEventListener("drop", (event) => {
      if (!over(event)) return;
      const files = dropped(event.dataTransfer);
      this.take(() => files);
    });
    this.compared.onchange = () => this.found && !this.found.planned && this.recognise();
    document.addEventListener("design", () => this.refresh());
    new MutationObserver(() => !this.root.hidden && this.refresh()).observe(this.root, { attributeFilter: ["hidden"] });
  }

  report(words, busy = false) {
    this.status.textContent = words;
    this.status.classList.toggle("busy", busy);
  }

  problems(list) {
    this.wrong.replaceChildren(...list.map((words) => element("li", {}, words)));
  }

  /** The state of buttons and choices, which follow from the files and the page's design. */
  refresh() {
    const bytes = [...this.files.values()].reduce((sum, one) => sum + one.bytes, 0);
    this.sum.textContent = this.files.size ? `${this.files.size} files, ${(bytes / 1e6).toPrecision(3)} MB` : "No files yet.";
    this.clear.disabled = !this.files.size || this.job !== null;
    this.start.disabled = !this.found || this.job !== null;
    this.stop.hidden = this.job === null;
    this.fitting.enable(this.job === null);
    const state = this.page.state();
    const changes = Object.keys(state.values).length;
    const more = changes ? `, ${changes} ${changes > 1 ? "values" : "value"} changed` : "";
    const options = [["page", `the page's design: ${state.base}${more}`]];
    if (this.found?.design) options.push(["campaign", `the campaign's design: ${this.found.design}`]);
    const kept = this.compared.value;
    this.compared.replaceChildren(...options.map(([value, words]) => element("option", { value }, words)));
    if (options.some(([value]) => value === kept)) this.compared.value = kept;
    const other = this.found?.design && this.found.design !== state.base;
    this.note.textContent = other ? `The campaign names ${this.found.design}.` : "";
    this.about.hidden = this.files.size > 0;
  }

  forget() {
    this.files.clear();
    this.found = null;
    for (const part of [this.table, this.measured, this.fitting]) part.hide();
    this.problems([]);
    this.report("");
    this.refresh();
  }

  /** Take files that `found` promises, and recognise what they are. */
  async take(found) {
    if (this.job) return;
    try {
      const { given, problems } = await give(await found(), (done, total) => this.report(`File ${done + 1} of ${total} is taken.`, true));
      for (const one of given) this.files.set(one.path, one);
      this.problems(problems);
      this.refresh();
      if (given.length) await this.recognise(problems);
      else this.report(problems.length ? "No file was taken." : "There was no file.");
    } catch (error) {
      this.report(error.message);
    }
  }

  request(more = {}) {
    const files = [...this.files.values()];
    const stated = Object.fromEntries([...this.reading.querySelectorAll("[name]")].map((input) => [input.name, input.value]));
    const { columns, ...format } = stated;
    const { base, values, version } = this.page.state();
    const design = this.compared.value === "campaign" ? null : { base, values, version };
    return { uploads: files.map((one) => one.upload), paths: files.map((one) => one.path), design, columns, format, runs: this.table.runs(), ...more };
  }

  /** The content of a job of `kind` and the job, null where it was cancelled or failed, which is reported. */
  async run(kind, words, more = {}) {
    if (this.job) return null;
    this.problems([]);
    this.failed = [];
    this.report(words, true);
    const moved = ({ done, total, what }) => this.report(what ? `${what[0].toUpperCase()}${what.slice(1)}${total ? `: ${done} of ${total}` : ""}.` : words, true);
    this.job = new Job(kind, this.request(more), moved);
    const { job } = this;
    this.refresh();
    try {
      const done = await job.done;
      if (!done) this.report("Cancelled.");
      return done && { content: done.content, job };
    } catch (error) {
      if (error instanceof Failed) this.failed = error.problems.map((one) => one.message);
      this.problems(this.failed);
      this.report(error instanceof Failed ? "Not done." : error.message);
      return null;
    } finally {
      this.job = null;
      this.refresh();
    }
  }

  /** Read the files again, with columns in other words. */
  restate(words) {
    const given = this.reading.querySelector("[name=columns]");
    given.value = words;
    this.reading.open = true;
    return this.recognise();
  }

  async recognise(problems = []) {
    if (!this.files.size) return;
    this.found = null;
    for (const part of [this.table, this.measured, this.fitting]) part.hide();
    const answer = await this.run("recognise", "Looking for columns.", { runs: null });
    if (!answer) return;
    this.problems(problems);
    this.found = answer.content;
    this.table.show(answer.content);
    this.refresh();
    const wrong = answer.content.runs.filter((one) => one.problem).length;
    const count = answer.content.runs.length;
    const runs = `${count} ${count === 1 ? "run" : "runs"}`;
    const summary = answer.content.planned ? "as campaign.toml lists them" : "without a campaign.toml: state what each is";
    this.report(`${runs}, ${summary}.${wrong ? ` ${wrong} cannot be read as stated.` : ""}`);
    this.root.dataset.state = "recognised";
  }

  async characterize() {
    const answer = await this.run("characterize", "Reading the runs.");
    if (!answer) return;
    const { content, job } = answer;
    this.table.show({ ...this.found, runs: this.found.planned ? content.runs : this.joined(content.runs), read_as: content.read_as });
    this.measured.show(content, job);
    this.fitting.show(content);
    const failed = content.document.failures.length;
    this.report(`Measured on ${content.design}, predicted by the model ${content.model}.${failed ? ` ${failed} of ${content.runs.length} files could not be used: see Runs.` : ""}`);
    this.root.dataset.state = "measured";
  }

  /** Runs that were proposed with what became of them; those that were left out stay listed. */
  joined(runs) {
    const read = new Map(runs.map((run) => [run.file, run]));
    return this.found.runs.map((run) => ({ ...run, ...(read.get(run.file) ?? { problem: null, left: true }) }));
  }
}

export function open(root, page) {
  byId("area-measure").measure = new Measure(root, page);
}
