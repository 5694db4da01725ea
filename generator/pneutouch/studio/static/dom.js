// Elements made without markup in strings, and numbers as they are shown.

export function element(tag, attributes = {}, ...children) {
  const made = tag.startsWith("svg:")
    ? document.createElementNS("http://www.w3.org/2000/svg", tag.slice(4))
    : document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (name.startsWith("on")) made.addEventListener(name.slice(2), value);
    else made.setAttribute(name, value === true ? "" : value);
  }
  made.append(...children.filter((child) => child !== null && child !== undefined));
  return made;
}

export const byId = (id) => document.getElementById(id);

/** The chosen option says so where it differs from what it names. */
export function mark(select, changed) {
  for (const option of select.options) option.textContent = option.selected && changed ? `${option.value}, changed` : option.value;
}

/** Put words into the clipboard; false where the browser does not let the page. */
export async function copied(words) {
  try {
    await navigator.clipboard.writeText(words);
    return true;
  } catch {
    return false;
  }
}

/** A number to `digits` significant digits, without a power of ten and without trailing zeros. */
export function short(value, digits = 4) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  return String(Number(value.toPrecision(digits)));
}

/** A rated pressure as the commands print it: never rounded up. */
export const rated = (rating) => (Math.floor(10 * rating.rated_pressure_kPa + 1e-9) / 10).toFixed(1);

export function interval(figure, digits = 3) {
  return figure ? `${short(figure.low, digits)} to ${short(figure.high, digits)}` : "";
}

export const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
