// The model fitted to a sensor in hand, and the calibration saved in the user's folder.
import { element, short } from "./dom.js";
import { command } from "./measured.js";
import { row, scroll, table } from "./runs.js";

const percent = (share) => (100 * share).toFixed(1).replace("-", "−");

const check = (words, name, value, checked) =>
  element("label", { class: "check" }, element("input", { type: "checkbox", name, value, checked }), ` ${words}`);

export class Fitting {
  constructor(area) {
    this.area = area;
    this.root = element("section", { class: "card", hidden: true, "aria-labelledby": "fitting-title" });
  }

  hide() {
    this.root.hidden = true;
    this.root.replaceChildren();
    this.sensors = null;
  }

  enable(enabled) {
    for (const button of this.root.querySelectorAll("button")) button.disabled = !enabled;
  }

  show(content) {
    this.hide();
    if (!content.sensors.length) return;
    this.root.hidden = false;
    this.sensors = content.sensors;
    this.sensor = element("select", { id: "fitting-sensor", onchange: () => this.pressures() }, ...content.sensors.map((one) => element("option", { value: one.name }, one.name)));
    this.held = element("div", { class: "checks" });
    this.result = element("div");
    this.options = element(
      "form",
      { class: "plain", "aria-label": "Calibration" },
      element("label", {}, "Sensor ", this.sensor),
      element("fieldset", {}, element("legend", {}, "Fit"), element("div", { class: "checks" }, ...content.parameters.map((one) => check(one.name, "fit", one.name, one.usual)))),
      element("fieldset", {}, element("legend", {}, "Predict these by the others, kPa"), this.held),
      check("Count what is known before measuring", "priors", "priors", true),
      element("button", { type: "submit", class: "primary", id: "fitting-start" }, "Calibrate"),
    );
    this.options.onsubmit = (event) => {
      event.preventDefault();
      this.fit();
    };
    this.root.replaceChildren(
      element("h2", { id: "fitting-title" }, "Calibration"),
      element("p", { class: "muted" }, "Fits the model to the runs of one sensor, so that the design can be predicted as the sensor in hand."),
      this.options,
      this.result,
    );
    this.pressures();
  }

  pressures() {
    const { driving_pressures_kPa: pressures } = this.sensors.find((one) => one.name === this.sensor.value);
    const boxes = pressures.length > 1 ? pressures.map((one) => check(short(one), "held", String(one), false)) : [element("span", { class: "muted" }, "takes runs at two driving pressures")];
    this.held.replaceChildren(...boxes);
  }

  chosen(name) {
    return [...this.options.querySelectorAll(`[name=${name}]:checked`)].map((box) => box.value);
  }

  async fit(more = {}) {
    const request = more.request ?? { sensor: this.sensor.value, fit: this.chosen("fit"), hold_out_kPa: this.chosen("held").map(Number), priors: this.chosen("priors").length > 0 };
    if (!request.fit.length) {
      this.area.problems(["fit: choose at least one parameter"]);
      return;
    }
    const words = more.save ? "Fitting, to save the calibration." : "Fitting the model.";
    const answer = await this.area.run("calibrate", words, { ...request, save: more.save ?? null, replace: more.replace ?? false });
    if (!answer) {
      if (more.save) this.refused(this.area.failed);
      return;
    }
    this.shown(answer.content, answer.job, request);
    this.area.root.dataset.state = more.save ? "saved" : "calibrated";
    this.area.report(more.save ? `Saved: ${answer.content.saved}` : `The model is fitted to ${answer.content.document.sensor}.`);
    if (!more.save) this.result.scrollIntoView({ block: "nearest" });
  }

  shown(content, job, request) {
    const { document: fitted } = content;
    const chi = fitted.fit.chi_squared_per_degree;
    const head = `${fitted.sensor}, ${fitted.design}: curves ${fitted.runs}, injections ${fitted.injections}, values ${fitted.fit.points_used}${chi === null ? "" : `; chi-squared per degree of freedom ${short(chi, 3)}`}.`;
    this.result.replaceChildren(
      element("p", {}, head),
      scroll("Fitted parameters", table(["parameter", "fitted", "95 % interval", "designed"], fitted.estimates.map(estimate), { id: "fitted" })),
      element("div", { class: "pair" }, this.correlation(fitted.correlation), this.heldOut(fitted.held_out), this.response(fitted.response)),
      ...fitted.warnings.map((warning) => element("div", { class: "finding warning" }, element("p", {}, warning))),
      ...fitted.notes.map((note) => element("div", { class: "finding note" }, element("p", {}, note))),
      ...fitted.failures.map(([file, why]) => element("div", { class: "finding error" }, element("p", {}, element("b", {}, "not used"), ` ${file}`), element("p", { class: "reason" }, why))),
      element("img", { src: job.file(content.chart, true), alt: "Residuals: measured less fitted over the indentation, a panel for force and for pressure rise", class: "chart-image", loading: "lazy" }),
      element("p", { class: "links" }, element("a", { href: job.archive, download: true }, "all files of the fit, zip")),
      command(content),
      fitted.calibration ? this.saving(content, fitted, request) : "",
    );
  }

  correlation({ parameters, matrix }) {
    const rows = parameters.map((name, k) => row([name, ...matrix[k].map((one) => (one === null ? "–" : one.toFixed(2)))]));
    return element("div", {}, element("h3", {}, "Correlation"), scroll("Correlation of the fitted parameters", table(["", ...parameters], rows)));
  }

  heldOut(rows) {
    if (!rows.length) return "";
    const head = ["kPa", "predicted, kPa/N", "measured, kPa/N", "apart, %", "force rms, %", "pressure rms, %"];
    const lines = rows.map((one) =>
      row([short(one.driving_pressure_kPa), short(one.sensitivity_predicted_kPa_per_N), short(one.sensitivity_measured_kPa_per_N), `${one.sensitivity_error > 0 ? "+" : ""}${percent(one.sensitivity_error)}`, percent(one.force_rms_share), percent(one.pressure_rms_share)]),
    );
    return element("div", {}, element("h3", {}, "Held out, and predicted by the others"), scroll("Held out", table(head, lines, { id: "held-out" })));
  }

  response(rows) {
    if (!rows.length) return "";
    const head = ["kPa", "force times", "pressure rise times", "error left in the sensitivity, %"];
    const lines = rows.map((one) => row([short(one.driving_pressure_kPa), short(one.force_factor), short(one.pressure_factor), percent(one.sensitivity_error_relative)]));
    return element("div", {}, element("h3", {}, "Correction of the fitted model"), scroll("Correction", table(head, lines)));
  }

  /** A name to save the calibration by; one that is there is replaced only where the box is ticked. */
  saving(content, fitted, request) {
    if (content.saved) {
      const { opens } = content;
      const use = opens && element("button", { type: "button", id: "fitting-use", onclick: () => this.use(opens) }, "Use it: show the design as this sensor");
      return element("div", { class: "row saved" }, element("p", {}, `Saved: ${content.saved}. It is used as `, element("code", {}, `${fitted.design}@${fitted.calibration}`), "."), use);
    }
    this.name = element("input", { type: "text", id: "fitting-name", value: fitted.calibration, spellcheck: "false", "aria-describedby": "fitting-wrong" });
    this.wrong = element("p", { class: "bad", id: "fitting-wrong" });
    this.replace = element("input", { type: "checkbox", id: "fitting-replace" });
    const form = element(
      "form",
      { class: "plain", "aria-label": "Save the calibration" },
      element("label", {}, "Save calibration as ", this.name),
      element("label", { class: "check", hidden: true }, this.replace, " Replace the one of this name"),
      element("button", { type: "submit", id: "fitting-save" }, "Save"),
      this.wrong,
    );
    form.onsubmit = (event) => {
      event.preventDefault();
      this.fit({ request, save: this.name.value, replace: this.replace.checked });
    };
    return form;
  }

  /** Why a calibration was not saved, at its name; one that is there may be replaced. */
  refused(problems) {
    if (!problems.length) return;
    this.wrong.textContent = problems.join("; ");
    this.name.setAttribute("aria-invalid", "true");
    this.replace.parentElement.hidden = false;
    this.name.focus();
  }

  use(state) {
    this.area.page.go(state);
    this.area.page.show("design");
  }
}

function estimate(one) {
  const [low, high] = one.interval_95 ?? [];
  const interval = one.interval_95 ? `${short(low)} to ${short(high)}` : one.on_bound ? "on its bound, no interval" : "no interval";
  return row([element("span", {}, one.parameter, element("small", {}, ` ${one.key}`)), short(one.value), interval, short(one.designed)]);
}
