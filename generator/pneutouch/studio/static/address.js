// The design in the address: #paper-dome&membrane.wall_thickness_mm=1.4; a key alone with a "-" before it is left out.

export function written(state) {
  const parts = [encodeURIComponent(state.base)];
  for (const [name, text] of Object.entries(state.values)) {
    parts.push(text === null ? `-${name}` : `${name}=${encodeURIComponent(text)}`);
  }
  return `#${parts.join("&")}`;
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
