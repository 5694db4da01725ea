// The present design on a map, or what touches a pad: a point that is dragged, put by a click, and moved by the arrow keys.
import { element } from "./dom.js";

const KEYS = { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
/** Least number of steps that the range of a field has for the point. */
const STEPS = 150;

/** A round step along an axis: 1, 2 or 5 times a power of ten. */
function step({ values }) {
  const most = (values.at(-1) - values[0]) / STEPS;
  const power = 10 ** Math.floor(Math.log10(most));
  return [5, 2, 1].find((each) => each * power <= most * (1 + 1e-9)) * power;
}

/** A value on the steps of an axis, within its ends. */
function rounded(axis, value) {
  const near = Number((Math.round(value / step(axis)) * step(axis)).toPrecision(12));
  return Math.max(axis.values[0], Math.min(axis.values.at(-1), near));
}

export class Point {
  /** `moved(values)` while it is dragged; `put(values, settled)` where it was dropped, or moved by a key; `name` is its own. */
  constructor(moved, put, name = "Present design on the map") {
    Object.assign(this, { moved, put, dragged: false });
    const drop = () => {
      if (this.dragged) this.put(this.picture.design, true);
      this.dragged = false;
    };
    const words = { role: "slider", tabindex: 0, "aria-label": `${name}, moved by the arrow keys`, class: "design" };
    const moves = { onpointerdown: (event) => this.take(event), onpointermove: (event) => this.drag(event), onpointerup: drop, onpointercancel: drop };
    this.mark = element(
      "svg:g",
      { ...words, ...moves, onkeydown: (event) => this.key(event), onkeyup: (event) => KEYS[event.key] && this.put(this.picture.design, true) },
      element("svg:circle", { r: 20, class: "reach" }),
      element("svg:path", { d: "M-15 0H-7M15 0H7M0 -15V-7M0 15V7", class: "cross" }),
      element("svg:circle", { r: 7, class: "spot" }),
    );
  }

  /** Stand on a picture; a click there puts it. */
  on(picture) {
    this.picture = picture;
    picture.svg.addEventListener("click", (event) => {
      if (this.mark.contains(event.target) || !picture.holds(event)) return;
      this.mark.focus();
      this.put(this.rounded(picture.under(event)), true);
    });
  }

  rounded(values) {
    const { x, y } = this.picture.map;
    return [x, y].map((axis, k) => rounded(axis, values[k]));
  }

  take(event) {
    event.preventDefault();
    this.mark.setPointerCapture(event.pointerId);
    this.mark.focus();
    this.dragged = true;
  }

  drag(event) {
    if (!this.dragged) return;
    const values = this.rounded(this.picture.under(event));
    this.picture.put(values);
    this.moved(values);
  }

  /** One step, with Shift ten. */
  key(event) {
    const way = KEYS[event.key];
    if (!way) return;
    event.preventDefault();
    const { x, y } = this.picture.map;
    const many = event.shiftKey ? 10 : 1;
    this.put(this.rounded([x, y].map((axis, k) => this.picture.design[k] + many * way[k] * step(axis))), false);
  }

  /** What a reader of the screen says of it. */
  say(words, value) {
    this.mark.setAttribute("aria-valuetext", words);
    this.mark.setAttribute("aria-valuenow", value);
  }
}
