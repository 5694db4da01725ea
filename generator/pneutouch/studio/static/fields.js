// Fields of a form, made from what is declared: unit, bounds, help and names to choose from come with the studio's answer.
import { element } from "./dom.js";

const BARE = /^[A-Za-z][\w+-]*$/;
const RESERVED = ["true", "false", "inf", "nan", "none"];

export const asText = (value) => {
  if (value === null || value === undefined) return "";
  if (Array.isArray(value)) return value.some(Array.isArray) ? JSON.stringify(value) : value.join(", ");
  if (typeof value !== "object") return String(value);
  // A mix of resins, as a design file has it.
  const entries = Object.entries(value).filter(([, each]) => each !== null);
  return `{ ${entries.map(([key, each]) => `${key} = ${JSON.stringify(each)}`).join(", ")} }`;
};

/** What is typed after --set KEY= : text in quotes where it could be read as something else. */
export function typed(field, text) {
  if (Array.isArray(text)) return text.length || !field.optional ? JSON.stringify(text) : null;
  const plain = text.trim();
  if (plain === "" && field.optional) return null;
  if (field.kind === "numbers") return plain.startsWith("[") ? plain : `[${plain}]`;
  if (field.kind === "choice" && plain.startsWith("{")) return plain;
  if (field.kind === "text" || field.kind === "choice") {
    return BARE.test(plain) && !RESERVED.includes(plain) ? plain : JSON.stringify(plain);
  }
  return plain;
}

export function untyped(field, text) {
  if (text === null) return "";
  if (field.kind === "numbers") return text.replace(/^\[(?!\[)|(?<!\])\]$/g, "");
  if (!text.startsWith('"')) return text;
  try {
    return JSON.parse(text);
  } catch {
    return text;
  }
}

/** Names to choose any number of: a box for each. Its `value` is their list as a text. */
function boxes(field, linked, send) {
  const all = field.options.map((one) => element("input", { type: "checkbox", value: one.name, onchange: () => send(given(), true) }));
  const given = () => all.filter((box) => box.checked).map((box) => box.value);
  const labels = field.options.map((one, k) => element("label", {}, all[k], ` ${one.name}`));
  // The field in focus keeps it while a box is pressed: its help would go, and the box move from under the pointer.
  const held = (event) => event.preventDefault();
  const group = element("div", { ...linked, class: "boxes", role: "group", "aria-labelledby": `${linked.id}-label`, onmousedown: held }, ...labels);
  const list = (text) => (text ? JSON.parse(text) : []);
  Object.defineProperty(group, "value", {
    get: () => JSON.stringify(given()),
    set: (text) => all.forEach((box) => (box.checked = list(text).includes(box.value))),
  });
  return group;
}

const STEPS = 600;

/** Bounds span decades: a slider moves by shares of its value, or by powers of it where zero is allowed. */
const toValue = (field, place) => {
  const share = place / STEPS;
  const value = field.low > 0 ? field.low * (field.high / field.low) ** share : field.high * share ** 4;
  return Math.min(field.high, Math.max(field.low, Number(value.toPrecision(3))));
};
export const toPlace = (field, value) => {
  const share = field.low > 0 ? Math.log(value / field.low) / Math.log(field.high / field.low) : (value / field.high) ** 0.25;
  return Math.round(STEPS * Math.max(0, Math.min(1, share)));
};

export class Fields {
  /** `changed(name, text, settled)`: a field has a new text, null where it is left out; settled when a move ends. */
  constructor(groups, changed) {
    Object.assign(this, { groups, changed, fields: new Map(), folded: new Map() });
    for (const { fields } of groups) for (const field of fields) this.fields.set(field.name, { field });
  }

  /** Rows of the fields named in `main`, then the others by their tables, folded. */
  rows(main) {
    const first = main.map((name) => this.fields.get(name).field);
    const rest = this.groups.map(({ name, fields }) => this.more(name, fields.filter((field) => !first.includes(field))));
    return [...first.map((field) => this.row(field)), ...rest.filter(Boolean)];
  }

  more(name, fields) {
    if (!fields.length) return null;
    const title = (name.charAt(0).toUpperCase() + name.slice(1)).replaceAll("_", " ");
    const folded = element("details", {}, element("summary", {}, `${title}: more`), ...fields.map((field) => this.row(field)));
    this.folded.set(name, folded);
    return folded;
  }

  row(field) {
    const id = `field-${field.name.replace(".", "-")}`;
    const entry = this.fields.get(field.name);
    const linked = { id, "aria-describedby": `${id}-help ${id}-wrong` };
    const send = (text, settled) => this.changed(field.name, typed(field, text), settled);
    entry.input = this.input(field, linked, send);
    entry.wrong = element("p", { class: "wrong", id: `${id}-wrong` });
    const unit = field.unit ? element("small", {}, ` ${field.unit}`) : null;
    const named = field.kind === "names" ? { id: `${id}-label`, class: "label" } : { for: id };
    const label = element(field.kind === "names" ? "span" : "label", named, field.label, unit);
    const wide = ["choice", "text", "texts", "numbers", "names"].includes(field.kind);
    const out = field.optional
      ? element("button", { type: "button", class: "out", title: `Leave ${field.label} out`, "aria-label": `Leave ${field.label} out`, onclick: () => this.changed(field.name, null, true) }, "×")
      : null;
    const bounds = field.low !== null ? ` From ${field.low} to ${field.high}${field.unit ? ` ${field.unit}` : ""}.` : "";
    const parts = wide
      ? [element("div", { class: "row" }, label, out), entry.input]
      : [element("div", { class: "row" }, label, entry.input, out)];
    const slider = this.slider(field, entry);
    if (slider) parts.push((entry.slider = slider));
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
    if (field.kind === "names") return boxes(field, linked, send);
    if (field.kind === "texts") {
      const lines = (event) => event.target.value.split("\n").map((line) => line.trim()).filter(Boolean);
      const sent = (settled) => (event) => send(lines(event), settled);
      return element("textarea", { ...linked, rows: 2, spellcheck: "false", oninput: sent(false), onchange: sent(true) });
    }
    return element("input", {
      ...linked,
      type: "text",
      inputmode: field.kind === "number" || field.kind === "whole" ? "decimal" : null,
      oninput: (event) => send(event.target.value, false),
      onchange: (event) => send(event.target.value, true),
    });
  }

  /** True for a field that has a slider; none here. */
  slides() {
    return false;
  }

  slider(field, entry) {
    if (!this.slides(field)) return null;
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

  fill(field, input, text) {
    if (field.kind === "flag") {
      input.checked = text === "true";
      return;
    }
    if (field.kind === "choice" && ![...input.options].some((option) => option.value === text)) {
      input.append(element("option", { value: text }, text));
    }
    input.value = text;
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
        if (input.role !== "group") input.setAttribute("aria-invalid", "true");
        row.hidden = false;
        if (row.parentElement.tagName === "DETAILS") Object.assign(row.parentElement, { open: true, hidden: false });
      } else input.removeAttribute("aria-invalid");
    }
    return without;
  }
}
