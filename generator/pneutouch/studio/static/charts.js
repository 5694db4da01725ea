// Charts of what the studio answered; nothing is computed here.
import uPlot from "/vendor/uPlot.esm.js";
import { byId, colour, rated, short } from "./dom.js";

const HEIGHT = 270;
const drawn = new Map();

/** Hosts of charts outside the window, and what they show once they are inside or the moves pause. */
const outside = new Set();
const waiting = new Map();
const seen = new IntersectionObserver((entries) => {
  for (const { target, isIntersecting } of entries) {
    if (!isIntersecting) outside.add(target);
    else {
      outside.delete(target);
      bring(target);
    }
  }
});

function bring(host) {
  const show = waiting.get(host);
  waiting.delete(host);
  if (host.isConnected) show?.();
}

/** Draw the charts that waited outside the window. */
export function complete() {
  for (const host of [...waiting.keys()]) bring(host);
}

export const series = (label, stroke, more = {}) => ({
  label,
  stroke,
  width: 2,
  spanGaps: true,
  points: { show: false },
  value: reading,
  ...more,
});

/** Dashes by number: curves differ without their colours too. */
const DASHES = [[], [10, 4], [3, 3], [12, 3, 3, 3], [6, 2], [2, 6], [14, 3, 3, 3, 3, 3], [7, 7]];
export const dashes = (number) => DASHES[number % DASHES.length];

/** A piece of the line as background of its entry in the legend. */
function piece(chart, number) {
  const { stroke, dash } = chart.series[number];
  const ink = stroke(chart, number);
  if (!dash?.length) return ink;
  let at = 0;
  const stops = dash.map((length, k) => `${k % 2 ? "transparent" : ink} ${at}px ${(at += length)}px`);
  return `repeating-linear-gradient(90deg, ${stops.join(", ")})`;
}

/** What the legend reads under the pointer. */
const read = (value) => (value === null || value === undefined ? "" : short(value));

const axis = (label, more = {}) => ({
  label,
  stroke: colour("muted"),
  labelSize: 18,
  labelGap: 0,
  size: 34,
  gap: 4,
  labelFont: "13px system-ui, sans-serif",
  font: "12px system-ui, sans-serif",
  grid: { stroke: colour("fine"), width: 1 },
  ticks: { stroke: colour("line"), width: 1 },
  ...more,
});

/** Vertical lines with words: a limit, a rating. */
function markers(host) {
  return (chart) => {
    const { ctx, bbox } = chart;
    const scale = window.devicePixelRatio || 1;
    ctx.save();
    ctx.font = `${12 * scale}px system-ui, sans-serif`;
    for (const [row, mark] of (drawn.get(host).marks || []).entries()) {
      const x = chart.valToPos(mark.at, "x", true);
      if (!(x >= bbox.left && x <= bbox.left + bbox.width)) continue;
      ctx.strokeStyle = ctx.fillStyle = colour(mark.colour);
      ctx.lineWidth = 1.5 * scale;
      ctx.setLineDash([5 * scale, 4 * scale]);
      ctx.beginPath();
      ctx.moveTo(x, bbox.top);
      ctx.lineTo(x, bbox.top + bbox.height);
      ctx.stroke();
      const right = x > bbox.left + 0.6 * bbox.width;
      ctx.textAlign = right ? "right" : "left";
      ctx.fillText(mark.words, x + (right ? -5 : 5) * scale, bbox.top + (14 + 16 * row) * scale);
    }
    ctx.restore();
  };
}

/** Both ends of the interval, whose lines follow one another: one entry of the legend. */
const ends = (chart, high, at) => (at === null || high === null || high === undefined ? "" : `${read(chart.data[3][at])} to ${read(high)}`);

// What a chart keeps of its options stands here: a function made inside `show` would keep the chart before, and that the one before it.
const reading = (_, value) => read(value);
const upwards = (_, low, high) => [Math.min(0, low ?? 0), (high ?? 1) * 1.06 || 1];

export function show(id, across, up, lines, data, { bands = [], marks = [], points = null, legend = true } = {}) {
  const host = byId(id);
  const key = JSON.stringify([lines.map((one) => [one.label, one.stroke, one.dash]), bands.length]);
  const known = drawn.get(host);
  if (known && known.key === key) {
    const draw = () => {
      known.marks = marks;
      known.chart.setData(data);
    };
    if (outside.has(host)) waiting.set(host, draw);
    else draw();
    return;
  }
  waiting.delete(host);
  if (known) known.chart.destroy();
  const entry = { key, marks };
  drawn.set(host, entry);
  const options = {
    width: host.clientWidth || 300,
    height: HEIGHT,
    series: [{ label: across, value: reading }, ...lines],
    bands,
    scales: { x: { time: false }, y: { range: upwards } },
    axes: [axis(across), axis(up, { size: 48 })],
    cursor: { drag: { x: false, y: false } },
    hooks: { draw: [markers(host)] },
    legend: { show: legend, live: true, markers: { width: 0, fill: piece } },
    // Points between pixels: rounded to them, a slow curve would have steps.
    pxAlign: 0,
  };
  if (points) options.series[points].points = { show: true, size: 8 };
  entry.chart = new uPlot(options, data, host);
  seen.observe(host);
  const { canvas } = entry.chart.ctx;
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", `${up} over ${across}: ${lines.map((one) => one.label).join(", ")}`);
}

export const tone = (number) => colour(`series-${1 + (number % 8)}`);

/** The curve of a resin whose sensitivities are not known yet: its line stays, so that the chart is not made again. */
export const withoutPoints = (resin) => ({ ...resin, sensitivity_kPa_per_N: resin.sensitivity_kPa_per_N.map(() => null) });

/** Sensitivity over driving pressure: this design with its band, its states, every resin, and a pinned design. */
export function drawSensitivity(answer, pinned) {
  const states = answer.prediction.states.filter((state) => state.sensitivity_kPa_per_N !== null);
  const tables = [];
  const lines = [];
  const add = (pressures, values, one) => {
    tables.push([pressures, values]);
    lines.push(one);
  };
  const own = answer.curves.design;
  const bands = [];
  if (own) {
    add(own.driving_pressure_kPa, own.sensitivity_kPa_per_N, series("this design", colour("accent"), { width: 3 }));
    // The intervals come a moment later: the lines stay, so that the chart is not made again.
    const nothing = own.driving_pressure_kPa.map(() => null);
    const edge = { width: 1, dash: [2, 3] };
    if (own.low_kPa_per_N || answer.pending) {
      add(own.driving_pressure_kPa, own.high_kPa_per_N ?? nothing, series("interval, k = 2", colour("accent"), { ...edge, value: (chart, high, _, at) => ends(chart, high, at) }));
      add(own.driving_pressure_kPa, own.low_kPa_per_N ?? nothing, series("interval, lower end", colour("accent"), { ...edge, class: "unlisted" }));
      bands.push({ series: [2, 3], fill: colour("band") });
    }
  }
  const marked = lines.length + 1;
  add(
    states.map((state) => state.driving_pressure_kPa),
    states.map((state) => state.sensitivity_kPa_per_N),
    series("at its driving pressures", colour("ink"), { width: 0 }),
  );
  const filled = (answer.prediction.filled ?? []).filter((state) => state.sensitivity_kPa_per_N !== null);
  const upTo = (beyond) => filled.filter((state) => state.held.stable_regulated !== beyond).sort((a, b) => a.driving_pressure_kPa - b.driving_pressure_kPa);
  for (const [beyond, words] of [[false, "by injected gas"], [true, "by injected gas, beyond the limit"]]) {
    const some = upTo(beyond);
    if (some.length) add(some.map((state) => state.driving_pressure_kPa), some.map((state) => state.sensitivity_kPa_per_N), series(words, colour("ink"), { width: 1, dash: beyond ? [2, 4] : [6, 3], points: { show: true, size: 6 } }));
  }
  const material = answer.drawing.bodies.find((body) => body.role === "membrane").material;
  // The design's own resin is drawn already.
  answer.curves.resins.filter((resin) => !own || !material.startsWith(resin.title)).forEach((resin, k) => {
    add(resin.driving_pressure_kPa, resin.sensitivity_kPa_per_N, series(resin.title, tone(k % 7 + 1), { width: 1.3, dash: dashes(k + 1) }));
  });
  if (pinned && pinned.curves && pinned.curves.design) {
    const { driving_pressure_kPa: pressures, sensitivity_kPa_per_N: values } = pinned.curves.design;
    add(pressures, values, series("pinned", colour("ink"), { dash: [6, 4] }));
  }
  const limit = { at: answer.prediction.rating.rated_pressure_kPa, words: "rated", colour: "warning" };
  show("sensitivity", "driving pressure, kPa", "sensitivity, kPa/N", lines, uPlot.join(tables), {
    bands,
    marks: [limit],
    points: marked,
  });
}

/** A curve of every state over the indentation; those of a pinned design thin. */
export function drawStates(id, key, words, answer, pinned) {
  const lines = [];
  const tables = [];
  const add = (states, width, prefix) =>
    states.forEach((state, k) => {
      tables.push([state.curve.indentation_mm, state.curve[key]]);
      lines.push(series(`${prefix}${short(state.driving_pressure_kPa)} kPa`, tone(k), { dash: dashes(k), width }));
    });
  add(answer.prediction.states, 2, "");
  if (pinned && pinned.prediction) add(pinned.prediction.states, 1, "pinned ");
  show(id, "indentation, mm", words, lines, uPlot.join(tables));
}

/** Apex height over driving pressure, with the limit and the rated pressure. */
export function drawInflation(answer) {
  const { inflation, limits, rating } = answer.prediction;
  const rising = [];
  let highest = -Infinity;
  inflation.driving_pressure_kPa.forEach((pressure, k) => {
    if (pressure > highest) rising.push(k);
    highest = Math.max(highest, pressure);
  });
  const pick = (name, at = rising) => at.map((k) => inflation[name][k]);
  // Beyond the limit point the pressure falls: from its end back to the limit it is a line of its own.
  const falling = inflation.driving_pressure_kPa.map((_, k) => k).slice(rising.at(-1) + 1).reverse();
  const marks = [{ at: rating.rated_pressure_kPa, words: `rated ${rated(rating)} kPa`, colour: "warning" }];
  if (limits.limit_point_kPa !== null) {
    marks.push({ at: limits.limit_point_kPa, words: `limit point ${short(limits.limit_point_kPa, 3)} kPa`, colour: "error" });
  }
  const lines = [series("apex, outer surface", tone(0)), series("apex, inner surface", tone(1), { dash: dashes(1) })];
  const tables = [[pick("driving_pressure_kPa"), pick("apex_height_outer_mm"), pick("apex_height_inner_mm")]];
  if (falling.length && answer.prediction.filled?.length) {
    lines.push(series("outer, beyond the limit", tone(0), { dash: [4, 4] }), series("by injected gas or height", colour("ink"), { width: 0 }));
    tables.push([pick("driving_pressure_kPa", falling), pick("apex_height_outer_mm", falling)]);
    const filled = [...answer.prediction.filled].sort((one, other) => one.driving_pressure_kPa - other.driving_pressure_kPa);
    tables.push([filled.map((state) => state.driving_pressure_kPa), filled.map((state) => state.apex_height_outer_mm)]);
  }
  show("inflation", "driving pressure, kPa", "apex height, mm", lines, tables.length > 1 ? uPlot.join(tables) : tables[0], { marks });
}

export function resized() {
  for (const [host, { chart }] of drawn) {
    if (!host.isConnected) {
      chart.destroy();
      seen.unobserve(host);
      for (const kept of [outside, waiting, drawn]) kept.delete(host);
      continue;
    }
    const width = host.clientWidth;
    if (width && width !== chart.width) chart.setSize({ width, height: HEIGHT });
  }
}

/** Forget every chart: the colours of the page changed. */
export function forget() {
  for (const { chart } of drawn.values()) chart.destroy();
  waiting.clear();
  drawn.clear();
}
