// Figures of a campaign next to the predicted ones, the curves that were measured, and the measured sheet.
import uPlot from "/vendor/uPlot.esm.js";
import { forget, resized, series, show, tone } from "./charts.js";
import { colour, element, interval, short } from "./dom.js";
import { row, scroll, table } from "./runs.js";

const AGREES = { true: ["good", "yes"], false: ["bad", "no"] };

const range = (one) => (one.low === null || one.low === undefined ? "–" : interval(one, 4));

function figureRow(figure) {
  const { predicted } = figure;
  const [kind, word] = AGREES[String(figure.agrees)] ?? ["", ""];
  return row([
    element("span", {}, figure.name, element("small", {}, ` ${figure.unit}`)),
    short(figure.value),
    range(figure),
    predicted ? short(predicted.value) : "",
    predicted ? range(predicted) : "",
    element("span", { class: kind }, word),
    figure.published === undefined ? "" : short(figure.published),
  ], { "data-key": figure.key });
}

const HEAD = ["figure", "measured", "95 % interval", "predicted", "95 % band", "agrees", "paper"];

const CHARTS = [
  ["rise", "Pressure rise over force", "force_N", "rise_kPa", "contact force, N", "pressure rise, kPa"],
  ["force", "Contact force over indentation", "indentation_mm", "force_N", "indentation, mm", "contact force, N"],
];

export class Measured {
  constructor() {
    this.root = element("div", { class: "measured", hidden: true });
    this.sheet = element("section", { class: "card", hidden: true, "aria-labelledby": "sheet-title" });
    this.groups = [];
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
      forget();
      this.draw();
    });
    new ResizeObserver(() => resized()).observe(this.root);
  }

  hide() {
    this.root.hidden = this.sheet.hidden = true;
    this.root.replaceChildren();
    this.sheet.replaceChildren();
    this.groups = [];
    resized();
  }

  show(content, job) {
    this.groups = content.groups;
    this.root.hidden = this.sheet.hidden = false;
    const tiles = content.tiles.map(([name, value, unit, condition]) =>
      element("div", { class: "tile" }, element("small", {}, name), element("b", {}, value, element("small", {}, ` ${unit}`)), element("small", {}, condition)),
    );
    this.root.replaceChildren(
      content.simulated ? element("p", { class: "simulated" }, element("b", {}, "SIMULATED DATA"), " A program made these runs. No sensor was measured.") : "",
      element("div", { class: "tiles" }, ...tiles),
      ...content.groups.map((group, place) => this.group(group, place)),
      this.others(content.document),
    );
    this.draw();
    this.showSheet(content, job);
  }

  group(group, place) {
    const title = `measured-title-${place}`;
    const agreeing = group.compared ? `${group.agreeing} of ${group.compared} figures agree with the prediction: interval and band share a value.` : "";
    const why = group.why_not_predicted ? `Not predicted: ${group.why_not_predicted}` : "";
    const charts = group.curves.runs.length
      ? CHARTS.map(([key, words]) => element("div", {}, element("h3", {}, words), element("div", { class: "chart", id: `measured-${key}-${place}` })))
      : [];
    return element(
      "section",
      { class: "card", "aria-labelledby": title },
      element("h2", { id: title }, group.title, element("small", {}, ` ${group.sensors.join(", ")}`)),
      element("p", { class: "muted" }, [agreeing, why].filter(Boolean).join(" ")),
      scroll(`Figures, ${group.title}`, table(HEAD, group.figures.map(figureRow), { class: "figures" })),
      charts.length ? this.key(group) : "",
      element("div", { class: "pair" }, ...charts),
    );
  }

  /** What the lines and points of a group's charts are. */
  key(group) {
    const entry = (kind, words, place = null) => {
      const mark = element("span", { class: `mark ${kind}` });
      if (place !== null) mark.style.setProperty("--tone", `var(--series-${1 + ((place + 1) % 7)})`);
      return element("span", {}, mark, words);
    };
    const sensors = [...new Set(group.curves.runs.map((run) => run.sensor))];
    const line = group.curves.predicted ? [entry("line", "predicted, with its 95 % band")] : [];
    return element("p", { class: "key" }, ...line, ...sensors.map((sensor, place) => entry("dot", sensor, place)));
  }

  draw() {
    for (const [place, { curves }] of this.groups.entries()) {
      if (!curves.runs.length) continue;
      for (const [key, , x, y, across, up] of CHARTS) this.chart(`measured-${key}-${place}`, curves, x, y, across, up);
    }
  }

  chart(id, { runs, predicted }, x, y, across, up) {
    const [lines, tables, bands] = [[], [], []];
    const add = (values, one) => {
      tables.push(values);
      lines.push(one);
    };
    if (predicted) {
      add([predicted[x], predicted[y]], series("predicted", colour("accent")));
      if (predicted[`low_${y}`]) {
        const edge = { width: 1, dash: [2, 3] };
        add([predicted[x], predicted[`high_${y}`]], series("band to", colour("accent"), edge));
        add([predicted[x], predicted[`low_${y}`]], series("from", colour("accent"), edge));
        bands.push({ series: [2, 3], fill: colour("band") });
      }
    }
    const sensors = [...new Set(runs.map((run) => run.sensor))];
    for (const run of runs) {
      const stroke = tone(sensors.indexOf(run.sensor) + 1);
      add([run[x], run[y]], series(`${run.sensor}, run ${run.run}`, stroke, { width: 0, points: { show: true, size: 6, stroke, fill: colour("card"), width: 1.5 } }));
    }
    show(id, across, up, lines, uPlot.join(tables), { bands, legend: false });
  }

  /** What is no figure of a group: verdicts, ageing, leaks and volumes. */
  others({ injections, ageing }) {
    const rows = [
      ...injections.map((one) => row([one.sensor, one.figure, `${short(one.value)}${one.standard_error === null ? "" : ` ± ${short(one.standard_error, 2)}`}`, one.unit])),
      ...ageing.map((one) => row([one.resin, `sensitivity lost, ${short(one.driving_pressure_kPa)} kPa, ${one.age}`, short(one.sensitivity_change_percent, 3), "%"])),
    ];
    if (!rows.length) return "";
    return element(
      "section",
      { class: "card", "aria-labelledby": "measured-others" },
      element("h2", { id: "measured-others" }, "Injections, leaks, ageing"),
      scroll("Injections, leaks, ageing", table(["sensor", "figure", "value ± standard error", "unit"], rows, { class: "words" })),
    );
  }

  showSheet(content, job) {
    const link = (words, href) => element("a", { href, download: true }, words);
    const folder = content.sheet.slice(0, content.sheet.lastIndexOf("/") + 1);
    const one = (name) => link(name, job.file(folder + name));
    this.sheet.replaceChildren(
      element("h2", { id: "sheet-title" }, "Measured sheet"),
      element("p", { class: "links" }, ...["measured-datasheet.html", "measured-datasheet.pdf", "figures.json", "points.csv", "segments.csv"].map(one), link("all files, zip", job.archive)),
      command(content),
      element("iframe", { title: "Measured sheet", src: job.file(content.sheet, true), class: "sheet", loading: "lazy" }),
    );
  }
}

/** The command that does the same. */
export function command({ command: words, before }) {
  return element("p", { class: "muted same" }, "The same by command: ", element("code", {}, words), before ? `; ${before}` : "");
}
