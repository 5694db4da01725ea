// The area Target: what a sensor has to do, the designs that do it, and one of them made the design of the page.
import { Candidates } from "./candidates.js";
import { element } from "./dom.js";
import { Fields, untyped } from "./fields.js";
import { Job, JobPage } from "./jobs.js";
import { send } from "./requests.js";

const MAIN = [
  "target.sensitivity_kPa_per_N",
  "target.tolerance_percent",
  "target.driving_pressure_kPa",
  "target.force_range_N",
  "target.max_diameter_mm",
  "target.fits",
  "setting.processes",
  "setting.shapes",
  "setting.profile",
  "setting.base",
];
/** What stands in place of a value that is left out. */
const LEFT_OUT = { "target.fits": "finger:20", "setting.profile": "that of the base", "setting.base": "the default design, port push-in-4" };

class Target extends JobPage {
  constructor(root, page, declared) {
    super("The target cannot be searched for.");
    Object.assign(this, { root, page, values: {}, example: declared.example });
    this.fields = new Fields(declared.groups, (name, text) => this.changed(name, text));
    this.status = element("p", { class: "status", role: "status", "aria-live": "polite" });
    this.progress = element("progress", { max: 1, value: 0, "aria-label": "Progress of the search" });
    this.problems = element("ul", { class: "problems" });
    this.results = element("div", { class: "selection" });
    this.candidates = new Candidates(this.results, (card) => this.use(card));
    this.stop = element("button", { type: "button", onclick: () => this.cancel() }, "Cancel");
    this.under = element("div", { class: "under", hidden: true }, this.progress, this.stop);
    const alert = element("div", { role: "alert" }, this.problems);
    root.replaceChildren(this.form(), element("div", { tabindex: -1 }, this.status, this.under, alert, this.results));
    this.show();
    page.target = () => this.wanted();
    // A design that was saved meanwhile may be a base as well.
    document.addEventListener("design", () => this.known(page.state().base));
    this.report("Give a sensitivity, a force range or a stiffness, then find designs. What is left out is free.");
  }

  form() {
    this.begin = element("button", { type: "submit", class: "first" }, "Find designs");
    const others = [
      element("button", { type: "button", onclick: () => this.take({ ...this.example }) }, "Example"),
      element("button", { type: "button", onclick: () => this.take({}) }, "Clear"),
    ];
    const search = (event) => {
      event.preventDefault();
      this.search();
    };
    return element(
      "form",
      { "aria-label": "Target", autocomplete: "off", novalidate: true, onsubmit: search },
      ...this.fields.rows(MAIN),
      // A field keeps the focus while a button is pressed: its help would go, and the button move from under the pointer.
      element("div", { class: "submit", onmousedown: (event) => event.preventDefault() }, this.begin, ...others),
    );
  }

  changed(name, text) {
    const { field, input } = this.fields.fields.get(name);
    const usual = text === null || text === "" || text === String(field.default) || text === "[]";
    if (usual) delete this.values[name];
    else this.values[name] = text;
    if (text === null) this.fields.fill(field, input, "");
  }

  take(values) {
    this.values = values;
    this.show();
    this.fields.wrong([]);
  }

  show() {
    for (const [name, { field, input }] of this.fields.fields) {
      const text = this.values[name] ?? null;
      this.fields.fill(field, input, untyped(field, text));
      if (field.kind === "choice") input.options[0].textContent = LEFT_OUT[name];
      else input.placeholder = LEFT_OUT[name] ?? field.default ?? (field.optional ? "free" : "");
    }
  }

  /** Numbers of the target as it is typed now, for a map; 0 or none where one is left out. */
  wanted() {
    const number = (key) => Number(this.values[`target.${key}`] ?? this.fields.fields.get(`target.${key}`).field.default);
    return { sensitivity: number("sensitivity_kPa_per_N"), tolerance: number("tolerance_percent"), force: number("force_range_N") };
  }

  known(base) {
    const { input } = this.fields.fields.get("setting.base");
    if (![...input.options].some((option) => option.value === base)) input.append(element("option", { value: base }, base));
  }

  async search() {
    if (this.job) return;
    this.problem([]);
    this.progress.removeAttribute("value");
    this.report("The search begins.", true);
    this.running(new Job("select", { base: this.page.state().base, values: this.values }, (progress) => this.moved(progress, ({ done, total, what }) => `Step ${done + 1} of ${total}: ${what}.`)));
    try {
      const done = await this.job.done;
      if (done) this.answered(done.content);
      else this.report("The search was cancelled.");
    } catch (error) {
      this.failed(error);
    } finally {
      this.running(null);
    }
  }

  answered(content) {
    this.candidates.show(content);
    this.report(`${content.headline.charAt(0).toUpperCase()}${content.headline.slice(1)}.`);
  }

  problem(problems) {
    const without = this.fields.wrong(problems);
    this.problems.replaceChildren(...without.map((message) => element("li", {}, message)));
  }

  use(card) {
    this.page.go(card.state);
    this.page.show("design");
    document.getElementById("tab-design").focus();
  }
}

export async function open(root, page) {
  const declared = await (await send("/api/form/target")).json();
  const target = new Target(root, page, declared);
  root.dataset.ready = "1";
  return target;
}
