// The map of a pad that is read live: what its cells read, and where the force is.
import { element } from "./dom.js";
import { Point } from "./point.js";
import { post } from "./requests.js";
import { PadPicture } from "./touched.js";

const KINDS = { none: "no contact", either: "a touch", outside: "no object explains the readings" };

export class LivePad extends PadPicture {
  constructor() {
    super(new Point(() => {}, () => {}, "Force on the pad"));
    this.point.mark.remove();
    this.words = element("p", { class: "place" });
    this.card = element("section", { class: "card", hidden: true }, element("h2", {}, "The pad from the side of its domes"), this.host, this.words);
  }

  /** Show the map of a pad by its name; none without one. */
  async open(name) {
    this.card.hidden = !name;
    if (!name) return;
    const { content } = await post("/api/pad", { base: name, values: {} });
    const range = (key) => content.groups[0].fields.filter((one) => one.name === key).map(({ low, high }) => [low, high])[0];
    const square = ["touch.x_mm", "touch.y_mm"].map(range);
    this.top = 0;
    this.words.textContent = "";
    this.show({ pad: content, square, map: { x: { values: square[0] }, y: { values: square[1] } }, design: [0, 0], round: null, turn: null, answer: null });
  }

  put() {}

  object() {
    return [];
  }

  /** Show a touch and the pressure rises of the cells, kPa. */
  read(touch, rises) {
    const { kind, x_mm: x, y_mm: y, xx_mm2: a, xy_mm2: b, yy_mm2: d } = touch;
    const known = x !== null && x !== undefined;
    const read = { centre_mm: [known ? [x, y] : [null, null]], centre_covariance_mm2: [[[a, b], [b, d]]] };
    this.show({ answer: { contact: { pressure_rises_kPa: [rises], force_N: [0], centre_mm: [[null, null]] }, read } });
    const at = known ? ` at ${x.toFixed(1)}, ${y.toFixed(1)} mm` : "";
    this.words.textContent = `Read: ${KINDS[kind] ?? `a ${kind}`}${at}. Dot and dashed ellipse: the centre of the force, with its 95 % region.`;
    this.words.dataset.kind = kind;
  }
}
