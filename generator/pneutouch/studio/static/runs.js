// The runs of a campaign: the columns found in their files, what each run is, and what became of it.
import { element, short } from "./dom.js";

const CHANNELS = ["time", "position", "force", "pressure", "volume"];

const cell = (tag, ...words) => element(tag, {}, ...words);

export function table(head, rows, more = {}) {
  return element(
    "table",
    more,
    element("thead", {}, element("tr", {}, ...head.map((words) => (words ? element("th", { scope: "col" }, words) : element("td"))))),
    element("tbody", {}, ...rows),
  );
}

export const row = ([first, ...rest], more = {}) =>
  element("tr", more, element("th", { scope: "row" }, first), ...rest.map((one) => cell("td", one)));

/** A table that scrolls sideways by itself. */
export const scroll = (label, ...content) => element("div", { class: "scroll", tabindex: "0", role: "group", "aria-label": label }, ...content);

const named = (column) =>
  column ? element("span", { class: column.found ? "found" : "" }, `${column.sign < 0 ? "−" : ""}${column.name}`, element("small", {}, ` ${column.unit}`)) : "";

export class RunsTable {
  /** `restated(words)`: columns were given another sign or unit, in the words of the field Columns. */
  constructor(restated) {
    this.restated = restated;
    this.columns = element("div");
    this.list = element("div", { class: "runs" });
    this.notes = element("div");
    this.kept = element("details", {}, element("summary", {}, "Lines of a campaign file that keep it"), element("pre", { tabindex: "0" }));
    this.root = element("section", { class: "card", "aria-labelledby": "runs-title", hidden: true }, element("h2", { id: "runs-title" }, "Runs"), this.columns, this.kept, this.list, this.notes);
    this.inputs = null;
  }

  hide() {
    this.root.hidden = true;
    this.inputs = null;
  }

  show(found) {
    this.root.hidden = false;
    this.showColumns(found.runs, found.units);
    this.kept.hidden = !found.read_as;
    this.kept.querySelector("pre").textContent = found.read_as;
    if (found.planned) this.showPlanned(found.runs);
    else if (!this.inputs) this.showProposed(found);
    else this.mark(found.runs);
    this.showNotes(found);
  }

  /** Files whose columns are alike, and which column is which channel in which unit. */
  showColumns(runs, units) {
    const alike = new Map();
    for (const run of runs.filter((one) => one.columns.length)) {
      const key = JSON.stringify([run.columns, run.format]);
      alike.set(key, [...(alike.get(key) ?? []), run]);
    }
    const rows = [...alike.values()].map((some) => {
      const by = new Map(some[0].columns.map((column) => [column.channel, column]));
      const files = some.length > 1 ? `${some.length} files` : some[0].file;
      return row([files, ...CHANNELS.map((channel) => named(by.get(channel)))]);
    });
    const any = runs.some((run) => run.columns.some((column) => column.found));
    const note = any ? element("p", { class: "muted" }, element("span", { class: "found" }, "Underlined"), ": found by its header or its unit.") : "";
    const shown = rows.length ? scroll("Recognised columns", table(["columns of", ...CHANNELS], rows, { id: "measure-columns" })) : "";
    const one = alike.size === 1 ? [...alike.values()][0][0].columns : [];
    this.columns.replaceChildren(shown, note, one.length ? this.turns(one, units) : "");
  }

  /** Another sign or unit of a column, where all files have the same columns. */
  turns(columns, units) {
    const said = (changed) => {
      const all = columns.map((column) => ({ ...column, ...(column.channel === changed.channel ? changed : {}) }));
      this.restated(all.map(({ channel, sign, name, unit }) => `${channel}=${sign < 0 ? "-" : ""}${name}${unit ? `:${unit}` : ""}`).join(", "));
    };
    const parts = columns.map(({ channel, sign, unit }) => {
      const options = units[channel].map((each) => element("option", { value: each, selected: each === unit }, each));
      const chosen = element("select", { "aria-label": `unit of the ${channel}`, onchange: (event) => said({ channel, unit: event.target.value }) }, ...options);
      const turn = { type: "button", "aria-label": `turn the sign of the ${channel}`, onclick: () => said({ channel, sign: -sign }) };
      return element("span", { class: "turn" }, `${channel} `, chosen, channel === "time" ? "" : element("button", turn, "±"));
    });
    return element("p", { class: "turns", id: "measure-turns" }, ...parts);
  }

  showPlanned(runs) {
    const rows = runs.map((run) =>
      row([run.file, run.kind, run.sensor, run.resin, short(run.driving_pressure_kPa), run.run, short(run.age_days), this.state(run)]),
    );
    const head = ["file", "kind", "sensor", "resin", "kPa", "run", "age, days", "state"];
    this.list.replaceChildren(scroll("Runs", table(head, rows, { id: "measure-runs" })));
  }

  /** Runs that came without a campaign file: what each is can be changed. */
  showProposed({ runs, kinds = [] }) {
    this.inputs = runs.map((run) => this.inputsOf(run, kinds));
    const rows = this.inputs.map((one) =>
      row([element("label", {}, one.used, ` ${one.run.file}`), one.kind, one.sensor, one.driving_pressure_kPa, one.run_number, one.age_days, one.state]),
    );
    const head = ["file", "kind", "sensor", "kPa", "run", "age, days", "state"];
    this.list.replaceChildren(scroll("Runs", table(head, rows, { id: "measure-runs", class: "edited" })));
  }

  inputsOf(run, kinds) {
    const text = (name, value, size) =>
      element("input", { type: "text", size, value: String(value), "aria-label": `${name} of ${run.file}`, inputmode: size < 9 ? "decimal" : null });
    const kind = element("select", { "aria-label": `kind of ${run.file}` }, ...kinds.map((one) => element("option", { value: one, selected: one === run.kind }, one)));
    return {
      run,
      used: element("input", { type: "checkbox", checked: true, "aria-label": `use ${run.file}` }),
      kind,
      sensor: text("sensor", run.sensor, 14),
      driving_pressure_kPa: text("driving pressure in kPa", short(run.driving_pressure_kPa), 6),
      run_number: text("run number", run.run, 4),
      age_days: text("age in days", run.age_days, 5),
      state: this.state(run),
    };
  }

  mark(runs) {
    for (const [place, run] of runs.entries()) {
      const fresh = this.state(run);
      this.inputs[place].state.replaceWith(fresh);
      this.inputs[place].state = fresh;
    }
  }

  state(run) {
    if (run.left) return element("span", { class: "muted" }, "left out");
    if (run.problem) return element("span", { class: "bad" }, "not used");
    if (run.questions?.length) return element("span", { class: "suspect" }, "question");
    if (run.doubtful?.some((one) => !one.used)) return element("span", { class: "suspect" }, "read in part");
    return element("span", { class: "good" }, run.planned === false || run.doubtful ? "read" : "found");
  }

  /** What is wrong with each file, in the words of the commands. */
  showNotes({ runs, unused }) {
    const notes = [];
    const note = (kind, word, file, text) =>
      notes.push(element("div", { class: `finding ${kind}` }, element("p", {}, element("b", {}, word), ` ${file}`), element("p", { class: "reason" }, text)));
    for (const run of runs) {
      if (run.problem) note("error", "not used", run.file, run.problem);
      for (const text of run.questions ?? []) note("warning", "question", run.file, text);
    }
    const doubtful = runs.flatMap((run) => (run.doubtful ?? []).map((one) => ({ ...one, file: run.file })));
    if (doubtful.length) notes.push(this.doubtful(doubtful));
    if (unused?.length) note("note", "not used", `${unused.length} files`, unused.join(", "));
    this.notes.replaceChildren(...notes);
  }

  /** Parts of runs that may be wrong: whether they are used, where they are, and why. */
  doubtful(parts) {
    const left = parts.filter((one) => !one.used).length;
    const rows = parts.map((one) => row([one.file, one.used ? "noted, used" : "left out", `${one.start_s} to ${one.end_s}`, one.why]));
    return element(
      "details",
      {},
      element("summary", {}, `${left} doubtful parts left out, ${parts.length - left} noted and used`),
      scroll("Doubtful parts", table(["file", "", "s", "why"], rows, { class: "words" })),
    );
  }

  /** The runs as stated; null where the campaign file does. */
  runs() {
    if (!this.inputs) return null;
    const number = (input) => (input.value.trim() !== "" && Number.isFinite(Number(input.value)) ? Number(input.value) : input.value);
    return this.inputs
      .filter((one) => one.used.checked)
      .map((one) => ({
        file: one.run.file,
        kind: one.kind.value,
        sensor: one.sensor.value,
        resin: one.run.resin,
        driving_pressure_kPa: number(one.driving_pressure_kPa),
        run: number(one.run_number),
        age_days: number(one.age_days),
      }));
  }
}
