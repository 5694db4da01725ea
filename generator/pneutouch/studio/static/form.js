// The form, made from the declared fields: unit, bounds, help and names to choose from come with the studio's answer.
import { byId, element, short } from "./dom.js";

const MAIN = [
  "membrane.inner_radius_mm",
  "membrane.wall_thickness_mm",
  "membrane.material",
  "pneumatics.driving_pressures_kPa",
  "pneumatics.dead_volume_mL",
  "indentation.depth_mm",
  "contact.object",
  "contact.friction",
];
const STEPS = 600;
const BARE = /^[A-Za-z][\w+-]*$/;
const RESERVED = ["true", "false", "inf", "nan", "none"];

/** Bounds span decades: a slider moves by shares of its value, or by powers of it where zero is allowed. */
const toValue = (field, place) => {
  const share = place / STEPS;
  const value = field.low > 0 ? field.low * (field.high / field.low) ** share : field.high * share ** 4;
  return Math.min(field.high, Math.max(field.low, Number(value.toPrecision(3))));
};
const toPlace = (field, value) => {
  const share = field.low > 0 ? Math.log(value / field.low) / Math.log(field.high / field.low) : (value / field.high) ** 0.25;
  return Math.round(STEPS * Math.max(0, Math.min(1, share)));
};

const asText = (value) => {
  if (value === null || value === undefined) return "";
  if (Array.isArray(value)) return value.some(Array.isArray) ? JSON.stringify(value) : value.join(", ");
  if (typeof value !== "object") return String(value);
  // A mix of resins, as a design file has it.
  const entries = Object.entries(value).filter(([, each]) => each !== null);
  return `{ ${entries.map(([key, each]) => `${key} = ${JSON.stringify(each)}`).join(", ")} }`;
};

/** What is typed after --set KEY= : text in quotes where it could be read as something else. */
function typed(field, text) {
  const plain = text.trim();
  if (plain === "" && field.optional) return null;
  if (field.kind === "numbers") return plain.startsWith("[") ? plain : `[${plain}]`;
  if (field.kind === "choice" && plain.startsWith("{")) return plain;
  if (field.kind === "text" || field.kind === "choice") {
    return BARE.test(plain) && !RESERVED.includes(plain) ? plain : JSON.stringify(plain);
  }
  return plain;
}

function untyped(field, text) {
  if (text === null) return "";
  if (field.kind === "numbers") return text.replace(/^\[(?!\[)|(?<!\])\]$/g, "");
  if (!text.startsWith('"')) return text;
  try {
    return JSON.parse(text);
  } catch {
    return text;
  }
}

export class Form {
  /** `changed(name, text, settled)`: a field has a new text, null where it is left out; settled when a move ends. */
  constructor(declared, changed) {
    Object.assign(this, { changed, fields: new Map(), sizes: declared.sizes });
    const groups = declared.groups.map((group) => [group.name, group.fields]);
    for (const [, fields] of groups) for (const field of fields) this.fields.set(field.name, { field });
    const object = this.fields.get("contact.object").field;
    const measures = new Set(Object.values(declared.sizes).flat());
    const main = MAIN.map((name) => this.fields.get(name).field);
    const place = main.indexOf(object) + 1;
    main.splice(place, 0, ...[...measures].map((name) => this.fields.get(name)?.field).filter(Boolean));
    const rest = groups.map(([name, fields]) => this.more(name, fields.filter((field) => !main.includes(field))));
    byId("form").replaceChildren(...main.map((field) => this.row(field)), ...rest.filter(Boolean));
    byId("form").addEventListener("submit", (event) => event.preventDefault());
  }

  more(name, fields) {
    if (!fields.length) return null;
    const title = name.charAt(0).toUpperCase() + name.slice(1);
    return element("details", {}, element("summary", {}, `${title}: more`), ...fields.map((field) => this.row(field)));
  }

  row(field) {
    const id = `field-${field.name.replace(".", "-")}`;
    const entry = this.fields.get(field.name);
    const linked = { id, "aria-describedby": `${id}-help ${id}-wrong` };
    const send = (text, settled) => this.changed(field.name, typed(field, text), settled);
    entry.input = this.input(field, linked, send);
    entry.wrong = element("p", { class: "wrong", id: `${id}-wrong` });
    const unit = field.unit ? element("small", {}, ` ${field.unit}`) : null;
    const label = element("label", { for: id }, field.label, unit);
    const wide = field.kind === "choice" || field.kind === "text" || field.kind === "numbers";
    const out = field.optional
      ? element("button", { type: "button", class: "out", title: `Leave ${field.label} out`, "aria-label": `Leave ${field.label} out`, onclick: () => this.changed(field.name, null, true) }, "×")
      : null;
    const bounds = field.low !== null ? ` From ${field.low} to ${field.high}${field.unit ? ` ${field.unit}` : ""}.` : "";
    const parts = wide
      ? [element("div", { class: "row" }, label, out), entry.input]
      : [element("div", { class: "row" }, label, entry.input, out)];
    if (this.slides(field)) parts.push((entry.slider = this.slider(field, entry)));
    const help = element("p", { class: "help", id: `${id}-help` }, `${field.help}${bounds}`);
    entry.row = element("div", { class: `field${wide ? " long" : ""}` }, ...parts, entry.wrong, help);
    return entry.row;
  }

  input(field, linked, send) {
    if (field.kind === "choice") {
      const options = field.options.map((one) =>
        element("option", { value: one.name }, one.title && one.title !== one.name ? `${one.name} – ${one.title}` : one.name),
      );
      if (field.optional) options.unshift(element("option", { value: "" }, "as usual"));
      return element("select", { ...linked, onchange: (event) => send(event.target.value, true) }, ...options);
    }
    if (field.kind === "flag") {
      return element("input", { ...linked, type: "checkbox", onchange: (event) => send(String(event.target.checked), true) });
    }
    return element("input", {
      ...linked,
      type: "text",
      inputmode: field.kind === "number" || field.kind === "whole" ? "decimal" : null,
      oninput: (event) => send(event.target.value, false),
      onchange: (event) => send(event.target.value, true),
    });
  }

  slides(field) {
    const pressures = field.name === "pneumatics.driving_pressures_kPa";
    return MAIN.includes(field.name) && field.low !== null && (field.kind === "number" || pressures);
  }

  slider(field, entry) {
    const moved = (event, settled) => {
      const value = toValue(field, Number(event.target.value));
      const others = field.kind === "numbers" ? entry.input.value.split(",").map(Number).filter(Number.isFinite) : [];
      // Of several driving pressures the slider moves the highest; those above it go.
      const kept = others.sort((a, b) => a - b).slice(0, -1).filter((each) => each < value);
      entry.input.value = [...kept, value].join(", ");
      this.changed(field.name, typed(field, entry.input.value), settled);
    };
    return element("input", {
      type: "range",
      min: 0,
      max: STEPS,
      "aria-label": field.kind === "numbers" ? `Highest of the ${field.label.toLowerCase()}, ${field.unit}` : `${field.label}, ${field.unit}`,
      oninput: (event) => moved(event, false),
      onchange: (event) => moved(event, true),
    });
  }

  /** Show the values of `state` over those of the last `answer`; the field that is being typed in is left alone. */
  show(state, answer) {
    for (const [name, { field, input, slider, row }] of this.fields) {
      const [table, key] = name.split(".");
      const given = name in state.values;
      const known = answer?.values[table]?.[key];
      const text = given ? untyped(field, state.values[name]) : asText(known);
      row.classList.toggle("changed", given);
      if (field.kind === "flag") input.checked = text === "true";
      else if (document.activeElement !== input || field.kind === "choice") this.fill(field, input, text);
      if (slider && document.activeElement !== slider) {
        const number = Number(text.split(",").pop()) || Number(input.placeholder) || field.low;
        slider.value = toPlace(field, number);
      }
      if (slider) slider.setAttribute("aria-valuetext", `${text || input.placeholder || "left out"} ${field.unit}`);
    }
    const object = this.fields.get("contact.object").input.value;
    for (const [kind, names] of Object.entries(this.sizes)) {
      for (const name of names) if (this.fields.has(name)) this.fields.get(name).row.hidden = kind !== object;
    }
  }

  fill(field, input, text) {
    if (field.kind === "choice" && ![...input.options].some((option) => option.value === text)) {
      input.append(element("option", { value: text }, text));
    }
    input.value = text;
  }

  /** What stands in place of values that are left out. */
  usual(answer) {
    this.fields.get("indentation.depth_mm").input.placeholder = short(answer.depth_mm);
    const dead = answer.prediction ? short(answer.prediction.dead_volume_mL) : "";
    this.fields.get("pneumatics.dead_volume_mL").input.placeholder = dead;
  }

  /** Show problems at their fields; returns those that have none. */
  wrong(problems) {
    const at = new Map();
    const without = [];
    for (const { message, fields } of problems) {
      const known = fields.filter((name) => this.fields.has(name));
      if (!known.length) without.push(message);
      for (const name of known) at.set(name, message);
    }
    for (const [name, { input, wrong, row }] of this.fields) {
      wrong.textContent = at.get(name) ?? "";
      row.classList.toggle("faulty", at.has(name));
      if (at.has(name)) {
        input.setAttribute("aria-invalid", "true");
        row.hidden = false;
        if (row.parentElement.tagName === "DETAILS") row.parentElement.open = true;
      } else input.removeAttribute("aria-invalid");
    }
    return without;
  }
}
