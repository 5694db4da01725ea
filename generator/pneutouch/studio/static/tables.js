// Figures, findings and what the print takes, as text.
import { byId, element, interval, rated, short } from "./dom.js";

const cell = (tag, words, scope) => element(tag, { scope }, words);

function table(head, rows) {
  return element(
    "table",
    {},
    element("thead", {}, element("tr", {}, ...head.map((words) => cell("th", words, "col")))),
    element("tbody", {}, ...rows.map(([first, ...rest]) => element("tr", {}, cell("th", first, "row"), ...rest.map((words, k) => element("td", { "data-head": head[k + 1] }, words))))),
  );
}

const figure = (state, key) => {
  const known = state.uncertainty?.figures?.[key];
  const value = short(state[key] ?? known?.value);
  return known ? `${value} (${interval(known)})` : value;
};

function tile(words, value, unit, more = "") {
  return element("div", { class: "tile" }, element("small", {}, words), element("b", {}, value, element("small", {}, ` ${unit}`)), element("small", {}, more));
}

/** How far a port at the side stands out. */
const sideways = ({ size_mm: [wide], diameter_mm: across }) => (wide > across + 0.01 ? `, ${short(wide, 3)} mm with its port` : "");

export function showTiles(answer, solved) {
  const { prediction } = answer;
  const within = prediction.states.filter((one) => one.driving_pressure_kPa <= prediction.rating.rated_pressure_kPa);
  const state = within.at(-1) ?? prediction.states[0];
  const membrane = solved?.jobs.flatMap((job) => job.items).find((item) => item.name === "membrane");
  const size = answer.drawing ?? solved?.drawing;
  const sensitivity = state.uncertainty?.figures?.sensitivity_kPa_per_N;
  byId("tiles").replaceChildren(
    tile(`Sensitivity at ${short(state.driving_pressure_kPa)} kPa`, short(state.sensitivity_kPa_per_N, 3), "kPa/N", [interval(sensitivity), drawn(prediction, state)].filter(Boolean).join("; ")),
    tile("Rated pressure", rated(prediction.rating), "kPa", `limit: ${prediction.rating.limit}`),
    tile("Limit point", short(prediction.limits.limit_point_kPa, 3), "kPa", prediction.limit_point ? `apex at ${short(prediction.limit_point.apex_height_outer_mm, 3)} mm outside` : ""),
    tile("Size", size ? short(size.diameter_mm, 3) : "–", "mm across", size ? `${short(size.size_mm[2], 3)} mm high${sideways(size)}` : ""),
    tile("Membrane", membrane ? short(membrane.mass_g, 3) : "–", "g", answer.drawing?.bodies[0].material ?? ""),
  );
}

/** A state's sensitivity with the gas as drawn, beside that of a dead volume of zero. */
function drawn(prediction, { driving_pressure_kPa }) {
  const state = prediction.as_drawn?.find((one) => one.driving_pressure_kPa === driving_pressure_kPa);
  return state ? `with the ${volume(prediction)} as drawn ${short(state.sensitivity_kPa_per_N, 3)}` : "";
}

const volume = (prediction) => `${short(prediction.dead_volume_as_drawn_mL, 3)} mL`;

const COLUMNS = [
  ["sensitivity_kPa_per_N", "sensitivity, kPa/N"],
  ["stiffness_N_per_mm", "stiffness, N/mm"],
  ["force_at_range_end_N", "force at range end, N"],
  ["range_end_mm", "range end, mm"],
  ["apex_height_outer_mm", "apex, outer surface, mm"],
];

export function showFigures(prediction) {
  const rows = prediction.states.map((state) => [
    `${short(state.driving_pressure_kPa)} kPa${state.driving_pressure_kPa > prediction.rating.rated_pressure_kPa ? " *" : ""}`,
    ...COLUMNS.map(([key]) => figure(state, key)),
    short(state.r_squared, 3),
  ]);
  const events = prediction.states.flatMap((state) => state.events.map((event) => `${short(state.driving_pressure_kPa)} kPa: ${event.kind ?? event.event ?? ""} ${event.indentation_mm ? `at ${short(event.indentation_mm, 3)} mm` : ""}`));
  byId("figures").replaceChildren(
    table(["driving pressure", ...COLUMNS.map(([, words]) => words), "R²"], rows),
    element("p", { class: "muted" }, `In parentheses: interval with coverage factor 2. *: above the rated pressure. ${prediction.error_estimate.summary?.join(" ") ?? ""}`),
    events.length ? element("p", { class: "muted" }, `Events: ${events.join("; ")}`) : "",
    ...asDrawn(prediction),
    ...byFilling(prediction),
  );
}

/** The states given by their gas or height, which go on beyond the limit point. */
function byFilling(prediction) {
  if (!prediction.filled?.length) return [];
  const columns = [...COLUMNS.slice(0, 2), COLUMNS[3], COLUMNS[4]];
  const rows = prediction.filled.map((state) => [
    `${short(state.held.injected_volume_mL)} mL`,
    `${short(state.driving_pressure_kPa)}`,
    `${[state.held.stable_regulated ? "regulator" : null, state.held.stable_sealed ? "syringe" : null].filter(Boolean).join(" or ") || "nothing"}${state.held.stable_regulated ? "" : ", beyond the limit point"}`,
    ...columns.map(([key]) => figure(state, key)),
  ]);
  const head = ["injected, at ambient pressure", "pressure, kPa", "held by", ...columns.map(([, words]) => words)];
  return [element("h3", {}, "By injected gas or height"), table(head, rows)];
}

/** The figures with the gas as drawn, if the design states a dead volume of zero behind a tube. */
function asDrawn(prediction) {
  if (!prediction.as_drawn?.length) return [];
  const columns = [...COLUMNS.slice(0, 2), COLUMNS[3]];
  const rows = prediction.as_drawn.map((state) => [
    `${short(state.driving_pressure_kPa)} kPa`,
    ...columns.map(([key]) => short(state[key])),
    short(state.force_range_N?.[1]),
  ]);
  const head = ["driving pressure", ...columns.map(([, words]) => words), COLUMNS[2][1]];
  return [element("h3", {}, `With the ${volume(prediction)} that connector and tube hold as drawn (${prediction.as_drawn_model})`), table(head, rows)];
}

export function showFindings(check, shownIn3d) {
  if (!check) {
    byId("findings").replaceChildren(element("p", { class: "muted" }, "The rules are checked a moment after a change."));
    return;
  }
  const sound = check.findings.some((one) => one.severity === "warning") ? "It can be built; read the warnings." : "No rule is broken.";
  const verdict = check.passed ? sound : "A rule is broken: this design would not be built.";
  byId("findings").replaceChildren(
    element("p", {}, verdict),
    ...check.findings.map((one) =>
      element(
        "div",
        { class: `finding ${one.severity}` },
        element("p", {}, element("b", {}, one.severity), ` ${one.body}, ${one.rule}: ${one.message}`),
        one.fix ? element("p", { class: "muted" }, one.fix) : null,
      ),
    ),
    shownIn3d && check.findings.some((one) => one.where_mm) ? element("p", { class: "muted" }, "Dots in the view mark the places.") : "",
  );
}

export function showPrint(jobs) {
  if (!jobs) {
    byId("print").replaceChildren(element("p", { class: "muted" }, "Estimated a moment after a change."));
    return;
  }
  const rows = jobs.map((job) => [
    job.job,
    job.printer,
    job.items.map((item) => short(item.mass_g, 3)).join(" + "),
    short(job.support_mL, 3),
    job.time_min === null ? "–" : short(job.time_min, 3),
  ]);
  byId("print").replaceChildren(table(["job", "printer", "mass, g", "support, mL", "time, min"], rows));
}

const flat = (values) =>
  Object.fromEntries(Object.entries(values).flatMap(([name, fields]) => (fields && typeof fields === "object" ? Object.entries(fields).map(([key, value]) => [`${name}.${key}`, value]) : [[name, fields]])));
const words = (value) => (value === null || value === undefined ? "left out" : typeof value === "object" ? JSON.stringify(value) : String(value));

/** The pinned design next to this one: fields that differ, then the figures. */
export function showComparison(pinned, answer) {
  byId("compared").hidden = !pinned;
  if (!pinned) return;
  const [before, now] = [flat(pinned.values), flat(answer.values)];
  const keys = [...new Set([...Object.keys(before), ...Object.keys(now)])];
  const rows = keys.filter((key) => words(before[key]) !== words(now[key])).map((key) => [key, words(before[key]), words(now[key])]);
  if (pinned.prediction && answer.prediction) {
    const at = (prediction) => new Map(prediction.states.map((state) => [state.driving_pressure_kPa, state]));
    const [old, fresh] = [at(pinned.prediction), at(answer.prediction)];
    for (const [pressure, state] of fresh) {
      const other = old.get(pressure);
      if (!other) continue;
      for (const [key, label] of COLUMNS.slice(0, 4)) rows.push([`${label}, at ${short(pressure)} kPa`, figure(other, key), figure(state, key)]);
    }
    rows.push(["rated pressure, kPa", rated(pinned.prediction.rating), rated(answer.prediction.rating)]);
  }
  byId("comparison").replaceChildren(table(["field or figure", `pinned: ${pinned.name}`, `now: ${answer.name}`], rows));
}
