// The area Pads: an object is moved over a pad; shown is what the cells read, and what is read back from that.
import { element, short } from "./dom.js";
import { Fields, toPlace, untyped } from "./fields.js";
import { Failed, Job, JobPage } from "./jobs.js";
import { Point } from "./point.js";
import { Line, post } from "./requests.js";
import { PadPicture } from "./touched.js";

const AT = ["touch.x_mm", "touch.y_mm"];
const PLACES = { ball: AT, cylinder: AT, plate: ["touch.slope_x", "touch.slope_y"] };
/** Fields that some objects alone have. */
const OWN = { ball: [...AT, "touch.radius_mm"], cylinder: [...AT, "touch.radius_mm", "touch.turn_deg"], plate: PLACES.plate };
const KINDS = {
  none: "Read back: no contact.",
  ball: "Read back: a ball.",
  plate: "Read back: a plate.",
  cylinder: "Read back: a cylinder or an edge.",
  either: "Read back: a touch; these readings do not tell balls, plates and cylinders apart.",
  outside: "Read back: outside. No ball, plate or cylinder within the range of the cells explains the readings.",
};
/** Standard deviations of the half width of an interval that holds 95 %. */
const HALF = 1.96;
const OBJECT = "Shade: pressure rise. Lines: the ball or cylinder, dotted where it is as low as the tops of the domes; or the way in which the plate rises. Cross: centre of the force. Dot and dashed ellipse: the centre as read, with its 95 % region.";

class PadFields extends Fields {
  slides({ low }) {
    return low !== null && low >= 0;
  }
}

class PadPage extends JobPage {
  constructor(root, page) {
    super("The pad does not answer.");
    Object.assign(this, { root, values: {} });
    this.status = element("p", { class: "status", role: "status", "aria-live": "polite" });
    this.under = element("div", { class: "under", hidden: true }, element("progress", { "aria-label": "The table is made" }), element("button", { type: "button", onclick: () => this.cancel() }, "Cancel"));
    this.begin = element("button", { type: "button", class: "first", hidden: true, onclick: () => this.tabulate() }, "Tabulate the cell");
    this.problems = element("ul", { class: "problems" });
    const put = (values) => this.changed(Object.fromEntries(PLACES[this.text("touch.object")].map((name, k) => [name, String(values[k])])));
    this.point = new Point(put, put, "Object on the pad");
    this.picture = new PadPicture(this.point);
    this.words = element("p", { class: "place", role: "status" });
    this.table = element("table");
    this.card = element("div", { class: "card touched", hidden: true }, element("div", {}, this.picture.host, element("p", { class: "muted" }, OBJECT)), element("div", {}, this.words, this.table, this.picture.bars));
    this.results = element("div", { tabindex: -1 }, this.status, this.under, this.begin, element("div", { role: "alert" }, this.problems), this.card);
    this.names = element("select", { onchange: () => this.open(this.names.value) }, ...page.pads().map((name) => element("option", {}, name)));
    this.rows = element("div");
    root.replaceChildren(this.results, element("form", { "aria-label": "Pad", onsubmit: (event) => event.preventDefault() }, element("div", { class: "field long" }, element("label", {}, "Pad", this.names)), this.rows));
    this.line = new Line("/api/pad/touch", (...given) => this.answered(...given), (_, error) => this.failed(error));
    this.open(new URLSearchParams(location.search).get("name") ?? this.names.value);
  }

  text(name) {
    return untyped({ kind: "choice" }, this.values[name]);
  }

  /** Open a pad by its name, which the address then has. */
  async open(name) {
    Object.assign(this, { name, fields: null });
    history.replaceState(null, "", `/pad?name=${encodeURIComponent(name)}${location.hash}`);
    this.names.value = name;
    this.report("Opening the pad.", true);
    this.card.hidden = true;
    for (const each of [this.rows, this.words, this.table, this.problems]) each.replaceChildren();
    try {
      const { status, content } = await post("/api/pad", { base: name, values: {} });
      if (this.name !== name) return;
      if (status !== 200) throw new Failed(content.problems);
      const { fields } = content.groups[0];
      this.card.hidden = false;
      this.fields = new PadFields(content.groups, (field, text) => this.changed({ [field]: text }));
      this.rows.replaceChildren(...this.fields.rows(fields.map((field) => field.name)));
      this.picture.answer = null;
      this.values = Object.fromEntries(fields.map((field) => [field.name, String(field.default)]));
      this.changed({}, content);
    } catch (error) {
      this.failed(error);
    }
  }

  /** Take changed values, show them, and ask for the answer. */
  changed(values, pad = this.picture.pad) {
    Object.assign(this.values, values);
    const object = this.text("touch.object");
    const range = (name) => [this.fields.fields.get(name).field].map(({ low, high }) => [low, high])[0];
    for (const [name, { field, input, slider, row }] of this.fields.fields) {
      const text = untyped(field, this.values[name]);
      if (document.activeElement !== input) this.fields.fill(field, input, text);
      if (slider && document.activeElement !== slider) slider.value = toPlace(field, Number(text));
      slider?.setAttribute("aria-valuetext", `${text} ${field.unit}`);
      row.hidden = !OWN[object].includes(name) && Object.values(OWN).some((names) => names.includes(name));
    }
    const [x, y] = PLACES[object].map((name) => ({ values: range(name) }));
    const design = PLACES[object].map((name) => Number(this.values[name]));
    const round = object === "plate" ? null : ["touch.radius_mm", "touch.depth_mm"].map((name) => Number(this.values[name]));
    const turn = object === "cylinder" ? Number(this.values["touch.turn_deg"]) : null;
    // While the object is moved the scale grows with the readings and does not shrink.
    if (!Object.keys(values).some((name) => PLACES[object].includes(name))) this.picture.top = 0;
    this.picture.show({ pad, square: AT.map(range), map: { x, y }, design, round, turn });
    this.line.send({ base: this.name, values: { ...this.values } });
  }

  problem(problems) {
    const without = this.fields?.wrong(problems) ?? problems.map((each) => each.message);
    this.problems.replaceChildren(...without.map((message) => element("li", {}, message)));
    this.results.classList.toggle("stale", problems.length > 0);
  }

  answered({ base }, status, content) {
    if (base !== this.name || !this.fields) return;
    this.begin.hidden = status !== 200 || Boolean(content.read);
    if (status !== 200) this.failed(new Failed(content.problems));
    else if (!content.read) this.tabulate();
    else {
      this.problem([]);
      this.report(`${base} at ${this.text("touch.pressure")} kPa. Move the object by the pointer, or by the arrow keys (with Shift by ten steps).`);
      this.picture.show({ answer: content });
      this.figures(content);
    }
  }

  /** Tabulate the cell by a job; one that another page began is waited for. */
  async tabulate() {
    if (this.job) return;
    const question = { base: this.name, values: { ...this.values } };
    this.problem([]);
    try {
      const known = await Job.known("pad");
      this.running(known?.running ? known : new Job("pad", { question }));
      this.report(`The cell is tabulated at ${this.text("touch.pressure")} kPa: two minutes of processor time and more for a thin wall, once, for the table is kept.`, true);
      const done = await this.job.done;
      this.running(null);
      if (done) this.changed({});
      else this.report("Cancelled: this cell has no table at this driving pressure.");
    } catch (error) {
      this.running(null);
      this.failed(error);
    }
  }

  /** What is read beside what is there. */
  figures({ contact, read }) {
    const [[x, y], [[across, skew], [, up]]] = [read.centre_mm[0], read.centre_covariance_mm2[0]];
    const centre = contact.force_N[0] ? contact.centre_mm[0] : [null, null];
    const { round, turn, design } = this.picture;
    const own = turn !== null ? [["Turn, °", turn, read.turn_deg[0], read.turn_uncertainty_deg[0]]] : round ? [] : ["x", "y"].map((each, k) => [`Slope along ${each}`, design[k], read.slope[0][k], read.slope_uncertainty[0][k]]);
    const rows = [
      ["Force, N", contact.force_N[0], read.force_N[0], read.force_uncertainty_N[0]],
      ["Centre x, mm", centre[0], x, Math.sqrt(across)],
      ["Centre y, mm", centre[1], y, Math.sqrt(up)],
      ["Curvature, 1/mm", round ? 1 / round[0] : 0, read.curvature_per_mm[0], read.curvature_uncertainty_per_mm[0]],
      ...own,
    ].map(([name, is, found, spread]) => [name, short(is, 3), short(found, 3), found === null ? "–" : `${short(Math.max(/^(Force|Curvature)/.test(name) ? 0 : -Infinity, found - HALF * spread), 3)} to ${short(found + HALF * spread, 3)}`]);
    const row = (tag, cells) => element("tr", {}, ...cells.map((each) => element(tag, {}, each)));
    this.table.replaceChildren(element("thead", {}, row("th", ["figure", "true", "read", "95 % interval"])), element("tbody", {}, ...rows.map((cells) => row("td", cells))));
    const beyond = contact.force_N[0] ? "A cell is pressed beyond its range: what it reads there is not predicted. " : "No cell is touched. ";
    this.words.textContent = `${contact.inside[0] ? "" : beyond}${KINDS[read.kind[0]]}`;
    this.words.dataset.kind = read.kind[0];
    this.point.say(`at ${this.picture.design.map((each) => short(each, 3)).join(", ")}: ${this.words.textContent}`, this.picture.design[0]);
  }
}

export function open(root, page) {
  return new PadPage(root, page);
}
