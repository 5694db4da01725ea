// The design in the address: #paper-dome&membrane.wall_thickness_mm=1.4; a key alone with a "-" before it is left out.

export function written(state) {
  const parts = [encodeURIComponent(state.base)];
  for (const [name, text] of Object.entries(state.values)) {
    parts.push(text === null ? `-${name}` : `${name}=${encodeURIComponent(text)}`);
  }
  return `#${parts.join("&")}`;
}

export const same = (one, other) => written(one) === written(other);

let due = null;
let timer = null;

/** Put a state into the address, so that a link or a bookmark brings it back; after `wait` ms where no other one came by then. */
export function note(state, wait = 0) {
  forget();
  due = state;
  // The browser takes several milliseconds to change an address.
  if (wait) timer = setTimeout(flush, wait);
  else flush();
}

/** Put in what still waits. */
export function flush() {
  if (due) history.replaceState(null, "", written(due));
  forget();
}

/** Leave the address as it is. */
export function forget() {
  clearTimeout(timer);
  due = null;
}

export function read(hash) {
  const [base, ...parts] = hash.replace(/^#/, "").split("&");
  const values = {};
  try {
    for (const part of parts) {
      if (part.startsWith("-")) values[part.slice(1)] = null;
      else if (part.includes("=")) {
        const at = part.indexOf("=");
        values[decodeURIComponent(part.slice(0, at))] = decodeURIComponent(part.slice(at + 1));
      }
    }
    return base ? { base: decodeURIComponent(base), values } : null;
  } catch {
    return null;
  }
}

/** A word of a command, quoted where a shell would take it apart. */
export const quoted = (text) => (/^[\w.,@%+=:/-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`);

/** The changed values as options of the commands, to be typed in a shell. */
export function options(state, base = state.base) {
  const set = Object.entries(state.values).filter(([, text]) => text !== null);
  return [quoted(base), ...set.map(([name, text]) => `--set ${quoted(`${name}=${text}`)}`)].join(" ");
}
