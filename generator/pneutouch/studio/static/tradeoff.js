// The trade-off chart: fronts of the resins, the window of the target, and the candidates to choose from. It draws alone.
import { element, short } from "./dom.js";

const LEAST_HEIGHT = 400;
const EDGE = { left: 58, top: 14, bottom: 46 };
const LABEL = 19;
const DASHES = ["", "9 4", "2 3", "9 3 2 3", "16 4", "5 3", "9 3 2 3 2 3", "3 7"];
const SHAPES = [
  "M-4 0a4 4 0 1 0 8 0a4 4 0 1 0 -8 0Z",
  "M-3.6 -3.6H3.6V3.6H-3.6Z",
  "M0 -4.6L4.4 3.4H-4.4Z",
  "M0 -5L5 0L0 5L-5 0Z",
  "M-1.4 -4.4H1.4V-1.4H4.4V1.4H1.4V4.4H-1.4V1.4H-4.4V-1.4H-1.4Z",
  "M0 4.6L4.4 -3.4H-4.4Z",
  "M-4.6 -2L0 -4.8L4.6 -2V2L0 4.8L-4.6 2Z",
  "M0 -5L1.4 -1.4L5 0L1.4 1.4L0 5L-1.4 1.4L-5 0L-1.4 -1.4Z",
];
const STEPS = [[1], [1, 2, 5], [1, 1.5, 2, 3, 4, 5, 6, 8], [1, 1.2, 1.4, 1.6, 1.8, 2, 2.2, 2.5, 3, 3.5, 4, 4.5, 5, 6, 7, 8, 9]];

const tone = (k) => `tone-${1 + (k % 8)}`;
const svg = (tag, attributes, ...children) => element(`svg:${tag}`, attributes, ...children);

function ticks([low, high]) {
  for (const steps of STEPS) {
    const all = [];
    for (let power = Math.floor(Math.log10(low)); power <= Math.log10(high); power += 1) {
      all.push(...steps.map((step) => Number((step * 10 ** power).toPrecision(3))).filter((value) => value >= low && value <= high));
    }
    if (all.length >= 4) return all;
  }
  // Less than an octave: even steps.
  const step = [1, 2, 2.5, 5, 10].map((each) => each * 10 ** Math.floor(Math.log10((high - low) / 5))).find((each) => (high - low) / each <= 8);
  const all = [];
  for (let k = Math.ceil(low / step); k * step <= high; k += 1) all.push(Number((k * step).toPrecision(4)));
  return all;
}

const wide = (values, share) => [Math.min(...values) / share, Math.max(...values) * share];

export class TradeOff {
  /** `chosen(index, go)`: a candidate was chosen on the chart; `go` to its card. */
  constructor(chosen) {
    Object.assign(this, { chosen, near: true, picked: 0 });
    this.host = element("div", { class: "plot" });
    const views = [["Around the target", true], ["Whole fronts", false]];
    this.views = views.map(([words, near]) => element("button", { type: "button", "aria-pressed": String(near), onclick: () => this.look(near) }, words));
    this.tools = element("div", { class: "tools", role: "group", "aria-label": "Part of the chart" }, ...this.views);
    new ResizeObserver(() => this.host.clientWidth !== this.width && this.draw()).observe(this.host);
  }

  /** Line and mark of a front, for a legend. */
  sample(k) {
    const line = svg("line", { x1: 1, y1: 8, x2: 43, y2: 8, class: `front ${tone(k)}`, "stroke-dasharray": DASHES[k % 8] || null });
    const mark = svg("path", { d: SHAPES[k % 8], transform: "translate(22 8)", class: `shape ${tone(k)}` });
    return svg("svg", { width: 44, height: 16, "aria-hidden": "true" }, line, mark);
  }

  /** What the areas and the thick line are. */
  legend() {
    const { window_kPa_per_N: window, least_force_N: least, gauge_kPa: gauge } = this.chart;
    const sample = (shape, words) => element("span", {}, svg("svg", { width: 24, height: 14, "aria-hidden": "true" }, shape), words);
    const required = [window ? `${window.map((end) => short(end)).join(" to ")} kPa/N` : null, least === null ? null : `at least ${short(least)} N`];
    const words = required.filter(Boolean).join(", ");
    const target = words ? sample(svg("rect", { x: 1, y: 1, width: 22, height: 12, class: "window" }), `target: ${words}`) : "";
    const end = sample(svg("line", { x1: 0, y1: 7, x2: 24, y2: 7, class: "gauge" }), `end of the gauge's range: force × sensitivity = ${short(gauge)} kPa`);
    return element("p", { class: "key" }, target, end);
  }

  show(chart, cards) {
    Object.assign(this, { chart, cards, picked: 0, near: true });
    this.look(cards.length > 0);
  }

  look(near) {
    this.near = near;
    this.views.forEach((button, k) => button.setAttribute("aria-pressed", String(near === (k === 0))));
    this.views[0].disabled = !this.cards.length;
    this.draw();
  }

  /** Least and greatest sensitivity and force that are drawn. */
  limits() {
    const { fronts, window_kPa_per_N: window, least_force_N: least } = this.chart;
    const points = this.cards.map((card) => card.at);
    const x = [...points.map((at) => at.sensitivity_kPa_per_N), ...(window ?? [])];
    const y = [...points.map((at) => at.force_N), ...(least === null ? [] : [least])];
    if (this.near && x.length && y.length) return [wide(x, 1.12), wide(y, 1.25)];
    x.push(...fronts.flatMap((front) => [front.sensitivity_kPa_per_N[0], front.sensitivity_kPa_per_N.at(-1)]));
    y.push(...fronts.flatMap((front) => [front.force_N[0], front.force_N.at(-1)]));
    return x.length && y.length ? [wide(x, 1.2), wide(y, 1.4)] : [[0.1, 10], [0.1, 100]];
  }

  draw() {
    this.width = this.host.clientWidth;
    if (!this.chart || this.width < 200) return;
    const names = this.width > 520;
    const longest = Math.max(0, ...this.cards.map((card) => this.label(card, names).length));
    const right = this.width - 16 - 7.2 * longest - (longest ? 26 : 0);
    // The labels of all candidates stand beside the chart.
    const height = Math.max(LEAST_HEIGHT, EDGE.top + EDGE.bottom + LABEL * this.cards.length);
    this.area = { left: EDGE.left, right, top: EDGE.top, bottom: height - EDGE.bottom };
    const [x, y] = this.limits();
    const scale = ([low, high], from, to) => (value) => from + ((to - from) * Math.log(value / low)) / Math.log(high / low);
    this.x = scale(x, this.area.left, this.area.right);
    this.y = scale(y, this.area.bottom, this.area.top);
    const inside = svg("g", { "clip-path": "url(#plot-area)" }, this.window(x, y), this.gauge(x), ...this.fronts());
    const picture = svg(
      "svg",
      { width: this.width, height, role: "group", "aria-label": "Trade-off chart: force range in N over sensitivity in kPa/N, with the candidates to choose from" },
      svg("defs", {}, svg("clipPath", { id: "plot-area" }, svg("rect", this.box()))),
      svg("g", { "aria-hidden": "true" }, ...this.grid(x, y), inside, ...this.words()),
      this.marks(names),
    );
    this.host.replaceChildren(picture);
    this.choose(this.picked);
  }

  box() {
    const { left, right, top, bottom } = this.area;
    return { x: left, y: top, width: right - left, height: bottom - top };
  }

  grid(x, y) {
    const { left, right, top, bottom } = this.area;
    const text = (value, at) => {
      const made = svg("text", at);
      made.textContent = String(value);
      return made;
    };
    let free = -Infinity;
    const across = ticks(x).flatMap((value) => {
      const at = this.x(value);
      const shown = at - free > 34;
      if (shown) free = at;
      return [svg("line", { x1: at, x2: at, y1: top, y2: bottom, class: "grid" }), shown ? text(value, { x: at, y: bottom + 17, "text-anchor": "middle" }) : null];
    });
    const up = ticks(y).flatMap((value) => {
      const at = this.y(value);
      return [svg("line", { x1: left, x2: right, y1: at, y2: at, class: "grid" }), text(value, { x: left - 7, y: at + 4, "text-anchor": "end" })];
    });
    return [...across, ...up, svg("rect", { ...this.box(), class: "frame" })].filter(Boolean);
  }

  words() {
    const { left, right, top, bottom } = this.area;
    const middle = (top + bottom) / 2;
    const below = svg("text", { x: (left + right) / 2, y: bottom + 38, "text-anchor": "middle", class: "axis" });
    below.textContent = "sensitivity, kPa/N";
    const side = svg("text", { x: 14, y: middle, "text-anchor": "middle", class: "axis", transform: `rotate(-90 14 ${middle})` });
    side.textContent = "greatest force range, N";
    return [below, side];
  }

  /** The target's window: from its least to its greatest sensitivity, upwards of its force range. */
  window([low, high], [, most]) {
    const { window_kPa_per_N: window, least_force_N: least } = this.chart;
    if (!window && least === null) return "";
    const [from, to] = window ?? [low, high];
    const floor = least === null ? this.area.bottom : this.y(least);
    const top = this.y(most);
    return svg("rect", { x: this.x(from), y: top - 2, width: this.x(to) - this.x(from), height: floor - top + 2, class: "window" });
  }

  /** Where the cavity pressure reaches the end of the pressure sensor's range. */
  gauge([low, high]) {
    const { gauge_kPa: gauge } = this.chart;
    const line = svg("line", { x1: this.x(low), y1: this.y(gauge / low), x2: this.x(high), y2: this.y(gauge / high), class: "gauge" });
    return line;
  }

  fronts() {
    this.lines = [];
    return this.chart.fronts.map((front, k) => {
      const points = front.sensitivity_kPa_per_N.map((s, n) => [this.x(s), this.y(front.force_N[n])]);
      const path = points.map(([x, y], n) => `${n ? "L" : "M"}${x.toFixed(1)} ${y.toFixed(1)}`).join("");
      const line = svg("path", { d: path, class: `front ${tone(k)}`, "stroke-dasharray": DASHES[k % 8] || null });
      this.lines.push(line);
      return svg("g", {}, line, ...this.along(points).map(([x, y]) => svg("path", { d: SHAPES[k % 8], transform: `translate(${x} ${y})`, class: `shape ${tone(k)}` })));
    });
  }

  /** Places for the marks of a line: its visible start, and others at even distances. */
  along(points) {
    const { left, right, top, bottom } = this.area;
    const seen = points.filter(([x, y]) => x >= left && x <= right && y >= top && y <= bottom);
    const places = [];
    let last = null;
    for (const place of seen) {
      if (last && Math.hypot(place[0] - last[0], place[1] - last[1]) < 90) continue;
      places.push(place);
      last = place;
    }
    return places;
  }

  label(card, names) {
    return names && card.rank !== null ? `${card.label} ${card.resin}` : card.label;
  }

  /** The candidates: a dot each at its place, and its label at the right, as a group of radio buttons. */
  marks(names) {
    const { right, top, bottom } = this.area;
    const order = this.cards.map((card, index) => ({ card, index, x: this.x(card.at.sensitivity_kPa_per_N), y: this.y(card.at.force_N) }));
    order.sort((a, b) => a.y - b.y);
    let free = top + LABEL / 2;
    for (const [k, one] of order.entries()) {
      const left = order.length - 1 - k;
      one.at = Math.max(free, Math.min(one.y, bottom - LABEL * (left + 0.5)));
      free = one.at + LABEL;
    }
    this.order = order.map((one) => one.index);
    this.dots = [];
    const groups = order.map(({ card, index, x, y, at }) => {
      const called = `${card.label}: ${card.resin}, ${short(card.at.sensitivity_kPa_per_N)} kPa/N, ${short(card.at.force_N)} N`;
      const text = svg("text", { x: right + 20, y: at + 4 });
      text.textContent = this.label(card, names);
      const made = svg(
        "g",
        { role: "radio", tabindex: -1, "aria-label": called, "aria-checked": "false", class: `place ${card.kind}`, onclick: () => this.chosen(index, true), onkeydown: (event) => this.key(event, index) },
        svg("rect", { x: right + 12, y: at - LABEL / 2, width: this.width - right - 14, height: LABEL, rx: 5, class: "hit" }),
        svg("path", { d: `M${x} ${y}L${right + 4} ${at}H${right + 14}`, class: "leader" }),
        svg("circle", { cx: x, cy: y, r: card.kind === "runner-up" ? 4 : 5.5, class: "spot" }),
        text,
      );
      this.dots[index] = made;
      return made;
    });
    return svg("g", { role: "radiogroup", "aria-label": "Candidates on the chart" }, ...groups);
  }

  /** Arrow keys, Home and End choose; Enter and the space bar go to the card. */
  key(event, index) {
    if (event.key === "Enter" || event.key === " ") {
      event.preventDefault();
      this.chosen(index, true);
      return;
    }
    const now = this.order.indexOf(index);
    const last = this.order.length - 1;
    const step = { ArrowDown: now + 1, ArrowRight: now + 1, ArrowUp: now - 1, ArrowLeft: now - 1, Home: 0, End: last }[event.key];
    if (step === undefined) return;
    event.preventDefault();
    const next = this.order[(step + last + 1) % (last + 1)];
    this.chosen(next, false);
    this.dots[next].focus();
  }

  choose(index) {
    this.picked = index;
    if (!this.dots) return;
    const resin = this.cards[index]?.title.split(" (")[0];
    this.lines.forEach((line, k) => line.classList.toggle("first", this.chart.fronts[k].title === resin));
    this.dots.forEach((dot, k) => {
      dot.setAttribute("aria-checked", String(k === index));
      dot.setAttribute("tabindex", k === index ? "0" : "-1");
    });
  }
}
