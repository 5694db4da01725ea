// The form of a design: what matters first, with sliders; values of the page's state over those of the design file.
import { byId, element, short } from "./dom.js";
import { asText, Fields, toPlace, untyped } from "./fields.js";

const MAIN = [
  "membrane.shape",
  "membrane.inner_radius_mm",
  "membrane.wall_thickness_mm",
  "membrane.material",
  "pneumatics.driving_pressures_kPa",
  "pneumatics.dead_volume_mL",
  "indentation.depth_mm",
  "contact.object",
  "contact.friction",
];

export class Form extends Fields {
  constructor(declared, changed) {
    super(declared.groups, changed);
    Object.assign(this, { sizes: declared.sizes, shapes: declared.shapes, castings: declared.castings });
    this.ofShapes = [...new Set(Object.values(declared.shapes).flatMap(Object.keys))];
    const measures = [...new Set(Object.values(declared.sizes).flat())].filter((name) => this.fields.has(name));
    const main = [...MAIN];
    main.splice(main.indexOf("contact.object") + 1, 0, ...measures);
    main.splice(main.indexOf("membrane.wall_thickness_mm") + 1, 0, ...this.ofShapes);
    byId("form").replaceChildren(...this.rows(main));
    byId("form").addEventListener("submit", (event) => event.preventDefault());
    fold();
  }

  slides(field) {
    const pressures = field.name === "pneumatics.driving_pressures_kPa";
    const main = MAIN.includes(field.name) || this.ofShapes.includes(field.name);
    return main && field.low !== null && (field.kind === "number" || pressures);
  }

  /** Show the values of `state` over those of the last `answer`; the field that is being typed in is left alone. */
  show(state, answer) {
    for (const [name, { field, input, slider, row }] of this.fields) {
      const [table, key] = name.split(".");
      const given = name in state.values;
      // A table that the design leaves out is as declared.
      const known = answer && !answer.values[table] ? field.default : answer?.values[table]?.[key];
      const text = given ? untyped(field, state.values[name]) : asText(known);
      row.classList.toggle("changed", given);
      if (document.activeElement !== input || ["choice", "flag"].includes(field.kind)) this.fill(field, input, text);
      if (slider && document.activeElement !== slider) {
        const number = Number(text.split(",").pop()) || Number(input.placeholder) || field.low;
        slider.value = toPlace(field, number);
      }
      if (slider) slider.setAttribute("aria-valuetext", `${text || input.placeholder || "left out"} ${field.unit}`);
    }
    const own = Object.keys(this.shapes[this.fields.get("membrane.shape").input.value] ?? {});
    for (const name of this.ofShapes) this.fields.get(name).row.hidden = !own.includes(name) && !state.values[name];
    const object = this.fields.get("contact.object").input.value;
    for (const [kind, names] of Object.entries(this.sizes)) {
      for (const name of names) if (this.fields.has(name)) this.fields.get(name).row.hidden = kind !== object;
    }
    // A printed membrane has no mould; what is changed there all the same stays in sight.
    const cast = this.castings.includes(this.fields.get("print.profile").input.value);
    this.folded.get("mould").hidden = !cast && !Object.keys(state.values).some((name) => name.startsWith("mould."));
    document.dispatchEvent(new Event("form"));
  }

  /** What stands in place of values that are left out. */
  usual(answer) {
    this.fields.get("indentation.depth_mm").input.placeholder = short(answer.depth_mm);
    for (const name of this.ofShapes) this.fields.get(name).input.placeholder = answer.sizes[name] ? short(answer.sizes[name]) : "";
    const dead = answer.prediction ? short(answer.prediction.dead_volume_mL) : "";
    this.fields.get("pneumatics.dead_volume_mL").input.placeholder = dead;
  }
}

/** On a narrow screen the figures come first, and the form opens below them. */
function fold() {
  const beside = matchMedia("(min-width: 900px)");
  const set = () => (byId("change").open = beside.matches);
  beside.addEventListener("change", set);
  set();
}
