// The wall as it is pressed: which driving pressure and how deep, chosen from the states that the solid solved.
import { byId, element, short } from "./dom.js";

export class Pressed {
  /** `changed` is called with what is to be drawn, or null for the sensor as printed. */
  constructor(changed) {
    Object.assign(this, { states: [], share: 0, changed });
    byId("press-state").onchange = () => this.choose();
    byId("press-depth").oninput = () => {
      this.share = byId("press-depth").value / Math.max(1, byId("press-depth").max);
      this.draw();
    };
  }

  /** Walls and curves of an answer; null while there are none. The choice made before is kept where it can be. */
  show(answer) {
    const before = this.states[byId("press-state").selectedIndex]?.driving_pressure_kPa;
    this.states = (answer?.walls ?? []).filter((one) => one !== null);
    this.curves = answer?.prediction.states.map((state) => state.curve);
    byId("press-tools").hidden = !this.states.length;
    if (this.states.length) {
      byId("press-state").replaceChildren(
        ...this.states.map((one) => element("option", {}, `at ${short(one.driving_pressure_kPa)} kPa`)),
      );
      byId("press-state").selectedIndex = Math.max(0, this.states.findIndex((one) => one.driving_pressure_kPa === before));
    }
    this.choose();
  }

  choose() {
    const state = this.states[byId("press-state").selectedIndex];
    if (state) {
      byId("press-depth").max = state.walls.length - 1;
      byId("press-depth").value = Math.round(this.share * (state.walls.length - 1));
    }
    this.draw();
  }

  /** What the section and the view draw now; null for the sensor as printed. */
  get now() {
    const number = byId("press-state").selectedIndex;
    const state = this.states[number];
    const at = Number(byId("press-depth").value);
    return state && this.share > 0 ? { ...state, at, curve: this.curves[number] } : null;
  }

  draw() {
    const { now } = this;
    const words = now ? `${short(now.indentation_mm[now.at], 3)} mm, ${short(now.curve.contact_force_N[now.at], 3)} N` : "as printed";
    byId("press-out").textContent = words;
    byId("press-depth").setAttribute("aria-valuetext", words);
    this.changed(now);
  }
}
