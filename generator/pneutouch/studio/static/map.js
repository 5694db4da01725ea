// The area Map: the design's figures over two of its fields, and the design as a point that can be moved there.
import { element, short } from "./dom.js";
import { Fields, untyped } from "./fields.js";
import { Job, JobPage } from "./jobs.js";
import { at, MapPicture, missing, swatch } from "./mapped.js";
import { Point } from "./point.js";

const PRESSURES = "pneumatics.driving_pressures_kPa";
const FIELDS = [
  "membrane.inner_radius_mm",
  "membrane.wall_thickness_mm",
  "indentation.depth_mm",
  "indentation.plate_diameter_mm",
  "pneumatics.dead_volume_mL",
  "pneumatics.ambient_pressure_kPa",
  PRESSURES,
];
const AXES = { x: ["Across", FIELDS[0]], y: ["Up", FIELDS[1]] };
/** Least and greatest share of the present value that a range begins with, and its end where that value is 0. */
const [LEAST, MOST, FROM_ZERO] = [0.6, 1.6, { "pneumatics.dead_volume_mL": 2, [PRESSURES]: 20 }];

/** What is asked for, as fields of a form. */
function groups(label) {
  const usual = { unit: "", low: null, high: null, default: null, help: "", optional: false, options: [] };
  const options = FIELDS.map((name) => ({ name, title: name }));
  const axis = (letter, words) => [
    { ...usual, name: `${letter}.field`, label: words, kind: "choice", options },
    { ...usual, name: `${letter}.low`, label: "from", kind: "number" },
    { ...usual, name: `${letter}.high`, label: "to", kind: "number" },
  ];
  const pressure = { ...usual, name: "map.pressure_kPa", label, kind: "number", unit: "kPa" };
  return [{ name: "map", fields: [...Object.entries(AXES).flatMap(([letter, [words]]) => axis(letter, words)), pressure] }];
}

class DesignMap extends JobPage {
  constructor(root, page) {
    super("The map cannot be computed.");
    Object.assign(this, { root, page, map: null, own: new Set(), figure: "sensitivity" });
    this.values = Object.fromEntries(Object.entries(AXES).map(([letter, [, name]]) => [`${letter}.field`, name]));
    this.fields = new Fields(groups("Driving pressure"), (name, text) => this.changed(name, text));
    this.status = element("p", { class: "status", role: "status", "aria-live": "polite" });
    this.progress = element("progress", { max: 1, value: 0, "aria-label": "Progress of the map" });
    this.stop = element("button", { type: "button", onclick: () => this.cancel() }, "Cancel");
    this.under = element("div", { class: "under", hidden: true }, this.progress, this.stop);
    this.problems = element("ul", { class: "problems" });
    this.old = element("div", { class: "old", role: "status", hidden: true }, element("span", {}, "This map is of an older design."), element("button", { type: "button", onclick: (event) => this.compute(event) }, "Compute again"));
    this.tiles = element("div", { class: "tiles", role: "group", "aria-label": "Figure that is drawn" });
    this.place = element("p", { class: "place" });
    this.key = element("div", { class: "key" });
    this.point = new Point((values) => this.read(values), (values, settled) => this.put(values, settled));
    this.picture = new MapPicture(this.point.mark);
    this.point.on(this.picture);
    this.card = element("div", { class: "card", hidden: true }, this.tiles, this.place, this.picture.host, this.key);
    this.results = element("div", { tabindex: -1 }, this.status, this.under, element("div", { role: "alert" }, this.problems), this.old, this.card);
    root.replaceChildren(this.form(), this.results);
    document.addEventListener("form", () => this.follow());
    this.report("Choose two fields of the design and their ranges, then compute the map.");
    this.follow();
  }

  form() {
    this.begin = element("button", { type: "submit", class: "first" }, "Compute map");
    const rows = this.fields.rows(this.fields.groups[0].fields.map((field) => field.name));
    for (const letter of Object.keys(AXES)) {
      for (const option of this.input(`${letter}.field`).options) option.textContent = this.titled(option.value);
    }
    const range = (...ends) => element("div", { class: "range" }, ...ends);
    return element(
      "form",
      { "aria-label": "Map", autocomplete: "off", novalidate: true, onsubmit: (event) => this.compute(event) },
      ...[0, 3].map((k) => element("fieldset", { "aria-label": k ? "Up" : "Across" }, rows[k], range(rows[k + 1], rows[k + 2]))),
      rows[6],
      // A field keeps the focus while the button is pressed: its help would go, and the button move from under the pointer.
      element("div", { class: "submit", onmousedown: (event) => event.preventDefault() }, this.begin),
    );
  }

  input(name) {
    return this.fields.fields.get(name).input;
  }

  /** Words of a field of the design, and its unit. */
  named(name) {
    const { label, unit } = this.page.field(name).field;
    return { words: name === PRESSURES ? "Driving pressure" : label, unit };
  }

  titled(name) {
    const { words, unit } = this.named(name);
    return `${words} (${unit})`;
  }

  /** Numbers of a field of the design as it is now; one of most. */
  numbers(name) {
    const { input } = this.page.field(name);
    return (input.value || input.placeholder).split(",").map(Number);
  }

  /** The present number of a field; of several driving pressures the nearest to the map's. */
  present(name) {
    const wanted = Number(this.values["map.pressure_kPa"]);
    return this.numbers(name).reduce((one, other) => (Math.abs(other - wanted) < Math.abs(one - wanted) ? other : one));
  }

  changed(name, text) {
    this.values[name] = untyped(this.fields.fields.get(name).field, text);
    const [letter, part] = name.split(".");
    if (part === "field") {
      this.own.delete(letter);
      this.begun(letter);
    } else this.own.add(letter);
    this.fill();
  }

  /** The range that an axis begins with, around the present value. */
  begun(letter) {
    const name = this.values[`${letter}.field`];
    const { low, high } = this.page.field(name).field;
    const value = this.present(name);
    const end = (share) => String(Number(Math.max(low, Math.min(high, value ? share * value : share === MOST ? FROM_ZERO[name] : 0)).toPrecision(3)));
    Object.assign(this.values, { [`${letter}.low`]: end(LEAST), [`${letter}.high`]: end(MOST) });
  }

  /** What was not typed follows the design until a map of it is there. */
  follow() {
    if (!this.map || this.map.state.base !== this.page.state().base) {
      const all = this.numbers(PRESSURES).sort((a, b) => a - b);
      if (!this.own.has("map")) this.values["map.pressure_kPa"] = String(all.find((each) => each > 0) ?? all[0]);
      for (const letter of Object.keys(AXES)) if (!this.own.has(letter)) this.begun(letter);
      this.fill();
    }
    this.shown();
  }

  fill() {
    for (const [name, { field, input, row }] of this.fields.fields) {
      if (document.activeElement !== input || field.kind === "choice") this.fields.fill(field, input, this.values[name]);
      const [letter] = name.split(".");
      const { field: asked } = this.page.field(letter === "map" ? PRESSURES : this.values[`${letter}.field`]);
      row.querySelector(".help").textContent = field.kind === "choice" ? asked.help : `From ${asked.low} to ${asked.high} ${asked.unit}.`;
    }
    this.fields.fields.get("map.pressure_kPa").row.hidden = Object.keys(AXES).some((letter) => this.values[`${letter}.field`] === PRESSURES);
  }

  async compute(event) {
    event.preventDefault();
    if (this.job) return;
    this.problem([]);
    this.progress.removeAttribute("value");
    this.report("The map begins.", true);
    const [state, values] = [this.page.state(), { ...this.values }];
    this.running(new Job("map", { question: state, values }, (progress) => this.moved(progress, ({ done, total, what }) => `${done} of ${total} ${what}.`)));
    try {
      const done = await this.job.done;
      if (done) this.answered({ ...done.content, number: done.job, state, at: values["map.pressure_kPa"] });
      else this.report("The map was cancelled.");
    } catch (error) {
      this.failed(error);
    } finally {
      this.running(null);
      this.shown();
    }
  }

  problem(problems) {
    const words = ({ message, fields }) => ({ fields, message: fields.some((name) => this.page.field(name)) ? `${fields[0]}: ${message}` : message });
    const without = this.fields.wrong(problems.map(words));
    this.problems.replaceChildren(...without.map((message) => element("li", {}, message)));
  }

  answered(map) {
    this.map = map;
    for (const [name, label] of Object.entries(map.labels)) map.labels[name] = label.replace(/\s+/g, " ").replace("± %", "±\u00a0%");
    const value = map.figures.sensitivity.flat().some((each) => each !== null);
    const fixed = [map.x.field, map.y.field].includes(PRESSURES) ? "" : ` at ${map.at} kPa`;
    this.report(value ? `Figures of ${map.x.values.length * map.y.values.length} designs${fixed}, by the atlas.` : "No design of this map has a value; the legend below it says why.");
    this.card.hidden = false;
    const tile = ([name, label]) => {
      const choose = () => {
        this.figure = name;
        this.shown();
      };
      return element("button", { type: "button", class: "tile", onclick: choose }, element("span", {}, label), element("b", {}));
    };
    this.tiles.replaceChildren(...Object.entries(map.labels).map(tile));
  }

  /** The map as it is now: its figure, the target on it, the present design, and whether it is of the present design. */
  shown() {
    if (!this.map) return;
    const { map } = this;
    const old = this.base(map.state) !== this.base(this.page.state());
    this.old.hidden = !old || this.job !== null;
    this.results.classList.toggle("stale", old || this.job !== null);
    const names = { x: this.titled(map.x.field), y: this.titled(map.y.field) };
    const windows = this.target();
    const design = [map.x.field, map.y.field].map((name) => this.present(name));
    const drawn = JSON.stringify([map.number, this.figure, windows]);
    if (drawn !== this.drawn) {
      this.picture.show(map, this.figure, names, windows, design);
      this.legend(windows);
    }
    this.drawn = drawn;
    this.picture.put(design);
    this.read(design);
  }

  /** A design without what the map varies or sets by itself. */
  base({ base, values, version }) {
    const varied = [this.map.x.field, this.map.y.field, PRESSURES];
    return JSON.stringify([base, version, Object.entries(values).filter(([name]) => !varied.includes(name)).sort()]);
  }

  /** The lines that the target draws: the ends of its sensitivity, its force. */
  target() {
    const { sensitivity, tolerance, force } = this.page.target?.() ?? {};
    const ends = [1 - tolerance / 100, 1 + tolerance / 100].map((share) => share * sensitivity);
    return [
      sensitivity ? { figure: "sensitivity", levels: ends, look: "ends", words: `target: sensitivity ${ends.map((end) => short(end)).join(" to ")} kPa/N` } : null,
      force ? { figure: "force-range", levels: [force], look: "least", words: `target: force range of ${short(force)} N` } : null,
    ].filter(Boolean);
  }

  legend(windows) {
    const line = (look) => element("svg:svg", { width: 30, height: 16, "aria-hidden": "true" }, ...["under", look].map((one) => element("svg:line", { x1: 0, x2: 30, y1: 8, y2: 8, class: `target ${one}` })));
    const reasons = missing(this.map, this.figure).map(([reason, count], k) => element("li", { "data-count": count }, swatch(k), `${reason} (${count})`));
    const title = reasons.length ? element("p", {}, "No value, number of designs:") : "";
    const targets = windows.map((one) => element("li", {}, line(one.look), one.words));
    this.key.replaceChildren(title, element("ul", { class: "reasons" }, ...reasons), element("ul", {}, ...targets));
  }

  /** Read out the figures at values of both fields. */
  read([x, y]) {
    const { map } = this;
    for (const [k, name] of Object.keys(map.labels).entries()) {
      const tile = this.tiles.children[k];
      tile.setAttribute("aria-pressed", String(name === this.figure));
      tile.lastChild.textContent = short(at(map, name, x, y).value, 3);
    }
    const { value, reason } = at(map, this.figure, x, y);
    const figure = value === null ? `no value (${reason})` : `${map.labels[this.figure]} ${short(value, 3)}`;
    const of = (name, number) => `${this.named(name).words} ${short(number)} ${this.named(name).unit}`;
    this.place.textContent = `${of(map.x.field, x)}, ${of(map.y.field, y)}: ${figure}`;
    this.point.say(this.place.textContent, x);
  }

  /** Make the values of both fields those of the design. */
  put(values, settled) {
    const { base, values: before } = this.page.state();
    const changed = [this.map.x.field, this.map.y.field].map((name, k) => [name, this.text(name, values[k])]);
    this.page.go({ base, values: { ...before, ...Object.fromEntries(changed) } }, settled);
  }

  /** A value as the state has it; a driving pressure takes the place of the one that the point had. */
  text(name, value) {
    if (name !== PRESSURES) return String(value);
    const all = this.numbers(name).map((each) => (each === this.present(name) ? value : each));
    this.values["map.pressure_kPa"] = String(value);
    return `[${[...new Set(all)].sort((a, b) => a - b).join(", ")}]`;
  }
}

export function open(root, page) {
  return new DesignMap(root, page);
}
