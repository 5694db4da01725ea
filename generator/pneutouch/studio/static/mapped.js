// The picture of a map: shades and lines of a figure, hatched places without it, the present design. It draws alone.
import { contours, levels, rounds } from "./contours.js";
import { element, short } from "./dom.js";

/** Shades from dark to light that keep their order in gray (cividis). */
const SHADES = ["#00204d", "#00336f", "#39486b", "#575c6d", "#707173", "#8a8779", "#a69d75", "#c4b56c", "#e4cf5b", "#ffea46"];
const TONES = SHADES.map((each) => [1, 3, 5].map((at) => parseInt(each.slice(at, at + 2), 16)));
const HATCHES = [
  "M-2 2L2 -2M0 8L8 0M6 10L10 6",
  "M-2 6L2 10M0 0L8 8M6 -2L10 2",
  "M0 4H8",
  "M4 0V8",
  "M0 4H8M4 0V8",
  "M-2 2L2 -2M0 8L8 0M6 10L10 6M-2 6L2 10M0 0L8 8M6 -2L10 2",
];
const hatch = (k) => `url(#map-hatch-${k % HATCHES.length})`;
export const svg = (tag, attributes, ...children) => element(`svg:${tag}`, attributes, ...children);

export function written(words, attributes) {
  const made = svg("text", attributes);
  made.textContent = words;
  return made;
}

export const listed = (points) => points.map((each) => each.map((one) => one.toFixed(1)).join()).join(" ");

/** Red, green and blue of a share from 0 to 1. */
export function tone(share) {
  const at = Math.max(0, Math.min(0.999999, share)) * (TONES.length - 1);
  const k = Math.floor(at);
  return TONES[k].map((low, n) => low + (at - k) * (TONES[k + 1][n] - low));
}

/** The reasons of designs without a figure, with their numbers, greatest first. */
export function missing(map, figure) {
  const counts = new Map();
  map.figures[figure].forEach((column, i) =>
    column.forEach((value, j) => {
      const reason = value === null ? map.reasons[i][j] || "not known" : null;
      if (reason) counts.set(reason, (counts.get(reason) ?? 0) + 1);
    }),
  );
  return [...counts].sort(([, one], [, other]) => other - one);
}

/** Place of a value on an axis in steps of its grid. */
const step = (axis, value) => ((value - axis.values[0]) / (axis.values.at(-1) - axis.values[0])) * (axis.values.length - 1);

/** A figure at a place in steps of the grid; null where the nearest design has none. */
export function sampled(values, u, v) {
  const [i, j] = [Math.round(u), Math.round(v)];
  if ((values[i]?.[j] ?? null) === null) return null;
  let [sum, weights] = [0, 0];
  for (const a of [Math.floor(u), Math.floor(u) + 1]) {
    for (const b of [Math.floor(v), Math.floor(v) + 1]) {
      const weight = (1 - Math.abs(u - a)) * (1 - Math.abs(v - b));
      const value = values[a]?.[b] ?? null;
      if (value !== null) [sum, weights] = [sum + weight * value, weights + weight];
    }
  }
  return sum / weights;
}

/** The figure at values of both fields, or null; and why. */
export function at(map, figure, x, y) {
  const [u, v] = [step(map.x, x), step(map.y, y)];
  const reason = map.reasons[Math.round(u)]?.[Math.round(v)];
  const value = sampled(map.figures[figure], u, v);
  return { value, reason: value !== null ? "" : reason === undefined ? "outside the map" : reason || "not known" };
}

/** The hatches, to be referred to by what is drawn on the page. */
const patterns = () =>
  svg("defs", {}, ...HATCHES.map((d, k) => svg("pattern", { id: `map-hatch-${k}`, width: 8, height: 8, patternUnits: "userSpaceOnUse" }, svg("path", { d, class: "hatch" }))));

/** Sample of a hatch for a legend. */
export const swatch = (k) => svg("svg", { width: 30, height: 16, "aria-hidden": "true" }, svg("rect", { x: 0.5, y: 0.5, width: 29, height: 15, fill: hatch(k), class: "frame" }));

export class MapPicture {
  /** `mark`: the element of the present design, which this puts to its place. */
  constructor(mark) {
    Object.assign(this, { mark, map: null });
    this.canvas = element("canvas", { "aria-hidden": "true" });
    this.svg = svg("svg", { role: "group" });
    this.host = element("div", { class: "plot" }, this.canvas, this.svg);
    new ResizeObserver(() => this.map && ![0, this.width].includes(this.host.clientWidth) && this.draw()).observe(this.host);
  }

  /** Show a figure; `names` has the words of the axes, `windows` the lines of the target ({figure, levels, look}). */
  show(map, figure, names, windows, design) {
    Object.assign(this, { map, figure, names, windows, design });
    if (this.host.clientWidth) this.draw();
  }

  x(value) {
    return this.left + (step(this.map.x, value) / (this.map.x.values.length - 1)) * (this.right - this.left);
  }

  y(value) {
    return this.bottom - (step(this.map.y, value) / (this.map.y.values.length - 1)) * (this.bottom - this.top);
  }

  /** True for a place of the screen on the map. */
  holds({ clientX, clientY }) {
    const { left, top } = this.svg.getBoundingClientRect();
    const [x, y] = [clientX - left, clientY - top];
    return x >= this.left && x <= this.right && y >= this.top && y <= this.bottom;
  }

  /** Values of both fields at a place of the screen, within the map. */
  under({ clientX, clientY }) {
    const { left, top } = this.svg.getBoundingClientRect();
    const along = (axis, share) => axis.values[0] + Math.max(0, Math.min(1, share)) * (axis.values.at(-1) - axis.values[0]);
    const across = (clientX - left - this.left) / (this.right - this.left);
    return [along(this.map.x, across), along(this.map.y, (this.bottom - (clientY - top)) / (this.bottom - this.top))];
  }

  draw() {
    this.width = this.host.clientWidth;
    const height = Math.round(Math.max(330, Math.min(600, 0.68 * this.width)));
    const [left, beside] = this.width < 520 ? [50, 56] : [58, 74];
    Object.assign(this, { left, right: this.width - beside, top: 12, bottom: height - 46 });
    this.values = this.map.figures[this.figure];
    const known = this.values.flat().filter((value) => value !== null);
    [this.low, this.high] = known.length ? [Math.min(...known), Math.max(...known)] : [0, 1];
    this.levels = known.length ? levels(this.low, this.high) : [];
    this.svg.setAttribute("viewBox", `0 0 ${this.width} ${height}`);
    this.svg.setAttribute("height", height);
    const number = this.values.flat().length;
    const ends = known.length ? `${short(this.low, 3)} to ${short(this.high, 3)}` : "no value";
    const words = `${this.map.labels[this.figure]} over ${this.names.x} and ${this.names.y}: ${ends}; ${number - known.length} of ${number} designs have none`;
    this.svg.setAttribute("aria-label", words);
    this.shade();
    const bar = known.length ? this.bar() : [];
    const [lines, labels] = this.lines();
    const windows = this.windows.flatMap((one) => this.window(one));
    this.svg.replaceChildren(patterns(), ...this.places(), ...lines, ...windows, ...labels, ...this.axes(), ...bar, this.mark);
    this.put(this.design);
  }

  /** Put the present design to its values; at the edge, and marked so, where it is outside. */
  put([x, y]) {
    this.design = [x, y];
    if (!this.map || this.left === undefined) return;
    const within = (value, low, high) => Math.max(low, Math.min(high, value));
    const [a, b] = [within(this.x(x), this.left, this.right), within(this.y(y), this.top, this.bottom)];
    this.mark.setAttribute("transform", `translate(${a} ${b})`);
    this.mark.classList.toggle("outside", Math.abs(a - this.x(x)) + Math.abs(b - this.y(y)) > 0.5);
  }

  share(value) {
    const of = this.low > 0 && this.high > 3 * this.low ? Math.log : Number;
    return this.high > this.low ? (of(value) - of(this.low)) / (of(this.high) - of(this.low)) : 0.5;
  }

  /** Colour the places that have a value, pixel by pixel. */
  shade() {
    const [width, height] = [Math.round(this.right) - this.left, this.bottom - this.top];
    Object.assign(this.canvas, { width, height });
    Object.assign(this.canvas.style, { left: `${this.left}px`, top: `${this.top}px` });
    const drawn = this.canvas.getContext("2d");
    const image = drawn.createImageData(width, height);
    const [across, up] = [(this.values.length - 1) / width, (this.values[0].length - 1) / height];
    for (let k = 0, row = 0; row < height; row += 1) {
      for (let column = 0; column < width; column += 1, k += 4) {
        const value = sampled(this.values, (column + 0.5) * across, (height - row - 0.5) * up);
        if (value !== null) image.data.set([...tone(this.share(value)), 255], k);
      }
    }
    drawn.putImageData(image, 0, 0);
  }

  /** Pixels of a place in steps of the grid. */
  pixel([u, v]) {
    const [across, up] = [(this.right - this.left) / (this.values.length - 1), (this.bottom - this.top) / (this.values[0].length - 1)];
    return [this.left + u * across, this.bottom - v * up];
  }

  /** The hatched places of each reason, and the line around them. */
  places() {
    const [last, top] = [this.values.length - 1, this.values[0].length - 1];
    const of = (i, j) => (this.values[i][j] === null ? this.map.reasons[i][j] || "not known" : "");
    const corner = (i, j) => this.pixel([Math.max(0, Math.min(last, i - 0.5)), Math.max(0, Math.min(top, j - 0.5))]).map(Math.round).join(" ");
    const areas = new Map(missing(this.map, this.figure).map(([reason]) => [reason, ""]));
    let around = "";
    for (let j = 0; j <= top; j += 1) {
      for (let i = 0, from = 0; i <= last; i += 1) {
        const reason = of(i, j);
        if (i < last && of(i + 1, j) !== reason) around += `M${corner(i + 1, j)}L${corner(i + 1, j + 1)}`;
        if (j < top && of(i, j + 1) !== reason) around += `M${corner(i, j + 1)}L${corner(i + 1, j + 1)}`;
        if (i < last && of(i + 1, j) === reason) continue;
        if (reason) areas.set(reason, `${areas.get(reason)}M${corner(from, j)}L${corner(i + 1, j)}L${corner(i + 1, j + 1)}L${corner(from, j + 1)}Z`);
        from = i + 1;
      }
    }
    return [...[...areas.values()].map((d, k) => svg("path", { d, fill: hatch(k) })), svg("path", { d: around, class: "around" })];
  }

  /** Lines of all levels, and their labels. */
  lines() {
    const [lines, labels] = [[], []];
    this.taken = [];
    for (const level of this.levels) {
      const look = this.share(level) > 0.5 ? "dark" : "light";
      for (const line of contours(this.values, level)) {
        const points = line.map((each) => this.pixel(each));
        lines.push(svg("polyline", { points: listed(points), class: `contour ${look}` }));
        labels.push(this.label(points, short(level), look));
      }
    }
    return [lines, labels.filter(Boolean)];
  }

  /** The value on a line, along it, near its middle where there is space; null without any. */
  label(points, words, look) {
    for (const share of [0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8]) {
      const k = Math.round(share * (points.length - 1));
      const [before, after] = [points[Math.max(0, k - 3)], points[Math.min(points.length - 1, k + 3)]];
      const [x, y] = points[k];
      const half = 4 * words.length + 4;
      const inside = x > this.left + half && x < this.right - half && y > this.top + half && y < this.bottom - half;
      if (points.length < 5 || !inside || this.taken.some(([a, b]) => Math.hypot(a - x, b - y) < 34)) continue;
      this.taken.push([x, y]);
      const turn = (180 / Math.PI) * Math.atan2(after[1] - before[1], after[0] - before[0]);
      const upright = turn > 90 ? turn - 180 : turn < -90 ? turn + 180 : turn;
      return written(words, { transform: `translate(${x} ${y}) rotate(${upright})`, dy: 4, "text-anchor": "middle", class: `level ${look}` });
    }
    return null;
  }

  /** Lines of the target, over light and dark shades alike. */
  window({ figure, levels: ends, look }) {
    return ends.flatMap((end) =>
      contours(this.map.figures[figure], end).flatMap((line) => {
        const points = listed(line.map((each) => this.pixel(each)));
        return [svg("polyline", { points, class: "target under" }), svg("polyline", { points, class: `target ${look}` })];
      }),
    );
  }

  axes() {
    const { left, right, top, bottom } = this;
    const middle = (top + bottom) / 2;
    const ends = ({ values }) => [values[0], values.at(-1)];
    const across = rounds(...ends(this.map.x), Math.floor((right - left) / 44)).flatMap((value) => [
      svg("path", { d: `M${this.x(value)} ${bottom}v5`, class: "tick" }),
      written(short(value), { x: this.x(value), y: bottom + 18, "text-anchor": "middle" }),
    ]);
    const up = rounds(...ends(this.map.y), Math.floor((bottom - top) / 40)).flatMap((value) => [
      svg("path", { d: `M${left} ${this.y(value)}h-5`, class: "tick" }),
      written(short(value), { x: left - 8, y: this.y(value) + 4, "text-anchor": "end" }),
    ]);
    return [
      svg("rect", { x: left, y: top, width: right - left, height: bottom - top, class: "frame" }),
      ...across,
      ...up,
      written(this.names.x, { x: (left + right) / 2, y: bottom + 38, "text-anchor": "middle", class: "axis" }),
      written(this.names.y, { x: 13, y: middle, "text-anchor": "middle", class: "axis", transform: `rotate(-90 13 ${middle})` }),
    ];
  }

  /** The shades with the levels beside them. */
  bar() {
    const [x, height] = [this.right + 16, this.bottom - this.top];
    const stops = SHADES.map((each, k) => svg("stop", { offset: k / (SHADES.length - 1), "stop-color": each }));
    const shades = svg("linearGradient", { id: "map-shades", x1: 0, y1: 1, x2: 0, y2: 0 }, ...stops);
    const box = svg("rect", { x, y: this.top, width: 14, height, fill: "url(#map-shades)", class: "edge" });
    const shown = this.levels.length ? this.levels : [this.low];
    const marks = shown.flatMap((level) => {
      const place = this.bottom - this.share(level) * height;
      return [svg("path", { d: `M${x + 14} ${place}h4`, class: "tick" }), written(short(level), { x: x + 21, y: place + 4 })];
    });
    return [shades, box, ...marks];
  }
}
