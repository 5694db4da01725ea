// The picture of a pad from the side of its domes with what touches it, and bars of what its cells read. It draws alone.
import { rounds } from "./contours.js";
import { element, short } from "./dom.js";
import { listed, svg, tone, written } from "./mapped.js";

/** Standard deviations of the half axes of an ellipse that holds 95 %. */
const AROUND = Math.sqrt(-2 * Math.log(0.05));
const HIGH = 190;
const shade = (share) => `rgb(${tone(share).map(Math.round).join()})`;
const circle = ([cx, cy], r, look, more = {}) => svg("circle", { cx, cy, r, class: look, ...more });
/** What stands out from light and from dark: a wide line below a narrow one. */
const twice = (tag, attributes, look = "") => ["under", look].map((each) => svg(tag, { ...attributes, class: `target ${each}` }));

export class PadPicture {
  /** `point`: what is moved over the picture. */
  constructor(point) {
    this.point = point;
    this.drawn = svg("g");
    this.svg = svg("svg", { role: "group", "aria-label": "The pad from the side of its domes" }, this.drawn, point.mark);
    this.host = element("div", { class: "plot" }, this.svg);
    this.bars = element("div", { class: "plot bars" });
    point.on(this);
    new ResizeObserver(() => this.draw()).observe(this.host);
  }

  /** Show a `pad` within `square` (ranges of x and y, mm), what is `round` (radius, depth), a ball or a cylinder with its axis at `turn` (degrees), or a plate, at `design` within `map`, and an `answer`. */
  show(given) {
    Object.assign(this, given);
    this.draw();
  }

  holds() {
    return true;
  }

  /** Values of the point at a place of the screen. */
  under({ clientX, clientY }) {
    const box = this.svg.getBoundingClientRect();
    const along = ({ values: [low, high] }, share) => low + Math.max(0, Math.min(1, share)) * (high - low);
    return [along(this.map.x, (clientX - box.left) / box.width), along(this.map.y, (box.bottom - clientY) / box.height)];
  }

  /** Place of values within ranges, pixels. */
  at(values, [x, y] = this.square) {
    const [u, v] = [x, y].map(([low, high], k) => (values[k] - low) / (high - low));
    return [u * this.size, (1 - v) * this.size];
  }

  put(design) {
    this.design = design;
    this.point.mark.setAttribute("transform", `translate(${this.at(design, [this.map.x.values, this.map.y.values])})`);
  }

  draw() {
    this.size = this.host.clientWidth;
    if (!this.pad || !this.size) return;
    this.scale = this.size / (this.square[0][1] - this.square[0][0]);
    this.svg.setAttribute("viewBox", `0 0 ${this.size} ${this.size}`);
    this.put(this.design);
    const rises = this.answer?.contact.pressure_rises_kPa[0] ?? this.pad.places_mm.map(() => 0);
    const greatest = Math.max(...rises, 0.1);
    this.top = Math.max(this.top ?? 0, rounds(0, 2 * greatest, 4).find((each) => each >= greatest));
    const cells = this.pad.places_mm.flatMap((place, k) => {
      const [share, [x, y]] = [rises[k] / this.top, this.at(place)];
      const number = { x, y: y + 4, "text-anchor": "middle", class: `level ${share > 0.5 ? "dark" : "light"}` };
      return [circle([x, y], this.pad.dome_radii_mm[k] * this.scale, "edge", { fill: shade(share) }), written(k + 1, number)];
    });
    const membrane = svg("polygon", { points: listed(this.pad.outline_mm.map((each) => this.at(each))), class: "membrane" });
    const length = [50, 20, 10, 5, 2].find((each) => each * this.scale < 0.3 * this.size);
    const ruler = [svg("path", { d: `M8 ${this.size - 8}h${length * this.scale}`, class: "around" }), written(`${length} mm`, { x: 8, y: this.size - 14 })];
    this.drawn.replaceChildren(membrane, ...cells, ...this.object(), ...(this.answer ? this.centres(this.answer) : []), ...ruler);
    this.chart(rises);
  }

  /** The ball or cylinder, and where it is lower than the tops; of a plate the way in which it rises. */
  object() {
    const [x, y] = this.at(this.design, [this.map.x.values, this.map.y.values]);
    if (!this.round) return twice("path", { d: `M${this.size / 2} ${this.size / 2}L${x} ${y}` });
    const [radius, depth] = this.round;
    const along = { d: `M${-2 * this.size} 0H${2 * this.size}` };
    const lines = (half, look) => [half, -half].flatMap((way) => twice("path", { ...along, transform: `translate(${x} ${y}) rotate(${-this.turn}) translate(0 ${way})` }, look));
    return [radius, Math.sqrt(Math.max(0, depth * (2 * radius - depth)))].flatMap((each, k) => (this.turn === null ? twice("circle", { cx: x, cy: y, r: each * this.scale }, k ? "least" : "") : lines(each * this.scale, k ? "least" : "")));
  }

  /** The true centre of the force as a cross; the one that is read as a dot, with the ellipse that holds 95 %. */
  centres({ contact, read }) {
    const [[middle], [found], [spread]] = [contact.centre_mm, read.centre_mm, read.centre_covariance_mm2];
    const cross = !contact.force_N[0] ? [] : twice("path", { d: "M-7 -7L7 7M-7 7L7 -7", transform: `translate(${this.at(middle)})` });
    if (found[0] === null) return cross;
    const [[a, b], [, d]] = spread;
    const away = Math.hypot(0.5 * (a - d), b);
    const [rx, ry] = [away, -away].map((each) => Math.max(2, AROUND * Math.sqrt(Math.max(0, 0.5 * (a + d) + each)) * this.scale));
    const turn = (-90 / Math.PI) * Math.atan2(2 * b, a - d);
    return [...twice("ellipse", { rx, ry, transform: `translate(${this.at(found)}) rotate(${turn})` }, "ends"), circle(this.at(found), 4, "read"), ...cross];
  }

  /** Bars of the cells over their numbers. */
  chart(rises) {
    const [width, left, bottom] = [this.bars.clientWidth, 64, HIGH - 36];
    if (!width) return;
    const [step, y] = [(width - left) / rises.length, (value) => bottom - (value / this.top) * (bottom - 16)];
    const ticks = rounds(0, this.top, 4).flatMap((each) => [svg("path", { d: `M${left - 5} ${y(each)}H${width}`, class: "tick" }), written(short(each), { x: left - 8, y: y(each) + 4, "text-anchor": "end" })]);
    const every = Math.ceil(22 / step);
    const bars = rises.flatMap((rise, k) => {
      const [x, share] = [left + (k + 0.5) * step, rise / this.top];
      const bar = svg("rect", { x: x - 0.36 * step, y: y(rise), width: 0.72 * step, height: bottom - y(rise), fill: shade(share), class: "edge" });
      return [bar, k % every ? null : written(k + 1, { x, y: bottom + 16, "text-anchor": "middle" }), step > 40 ? written(short(rise, 3), { x, y: y(rise) - 5, "text-anchor": "middle" }) : null].filter(Boolean);
    });
    const words = [written("cell", { x: (left + width) / 2, y: HIGH - 4, "text-anchor": "middle", class: "axis" }), written("pressure rise, kPa", { x: 12, y: bottom / 2 + 8, "text-anchor": "middle", class: "axis", transform: `rotate(-90 12 ${bottom / 2 + 8})` })];
    const said = rises.map((rise, k) => `cell ${k + 1} ${short(rise, 3)}`).join(", ");
    this.bars.replaceChildren(svg("svg", { viewBox: `0 0 ${width} ${HIGH}`, height: HIGH, role: "img", "aria-label": `Pressure rise, kPa: ${said}` }, ...ticks, ...bars, ...words));
  }
}
