// The section with its dimensions, drawn from the loops that the studio sends. Lengths are mm; z points up.
import { byId, element, short } from "./dom.js";

const path = (loop) => {
  let text = "";
  for (let k = 0; k < loop.length; k += 2) text += `${k ? "L" : "M"}${loop[k]} ${-loop[k + 1]}`;
  return `${text}Z`;
};

const outline = (bodies) => bodies.map((body) => body.loops.map(path).join("")).join("");

function line(points, look = "thin") {
  return element("svg:polyline", { points: points.map(([x, z]) => `${x},${-z}`).join(" "), class: look });
}

function label(x, z, words, size, anchor = "middle") {
  const text = element("svg:text", { x, y: -z + 0.35 * size, "font-size": size, "text-anchor": anchor });
  text.textContent = words;
  return text;
}

/** A straight dimension between two points, with ticks across its ends. */
function dimension([x0, z0], [x1, z1], tick) {
  const flat = z0 === z1;
  const across = (x, z) => line(flat ? [[x, z - tick], [x, z + tick]] : [[x - tick, z], [x + tick, z]]);
  return [line([[x0, z0], [x1, z1]]), across(x0, z0), across(x1, z1)];
}

function dimensions(drawing, size, tick) {
  const { inner_radius_mm: inner, wall_thickness_mm: wall, low_mm: low, high_mm: high } = drawing;
  const half = drawing.diameter_mm / 2;
  const [r, z] = drawing.inner_at_mm;
  // A hemisphere's radius leads to its face from the middle; the inner radius of another shape is that of its rim.
  const sphere = Math.abs(Math.hypot(r, z) - inner) < 1e-3 * inner;
  const place = [half + 2.5 * size, high];
  const below = low - 1.6 * size;
  const side = -half - 1.6 * size;
  return [
    ...dimension([-half, below], [half, below], tick),
    label(0, below - 1.1 * size, `⌀ ${short(2 * half)}`, size),
    ...dimension([side, low], [side, high], tick),
    label(side - 0.6 * size, 0.5 * (low + high), short(high - low), size, "end"),
    sphere ? line([[0, 0], [-r, z]]) : line([[-r, z], [-0.8 * inner, high + 0.5 * size]]),
    sphere
      ? label(-0.5 * r + 0.4 * size, 0.5 * z - 0.2 * size, `R0 ${short(inner)}`, size, "start")
      : label(-0.8 * inner, high + 0.8 * size, `inside, base R0 ${short(inner)}`, size, "end"),
    line([drawing.wall_at_mm, [place[0] - 0.4 * size, place[1]]]),
    label(place[0], place[1], `t0 ${short(wall)}`, size, "start"),
    line([[0, low - size], [0, high + size]], "thin axis"),
  ];
}

/** The membrane below the base plane, which stays where it is. */
function flange(drawing) {
  const [across] = drawing.size_mm;
  const below = element("svg:clipPath", { id: "below" }, element("svg:rect", { x: -across, y: 0, width: 2 * across, height: across }));
  const bodies = drawing.bodies.filter((body) => body.role === "membrane");
  return [below, element("svg:path", { d: outline(bodies), class: "outline membrane", "clip-path": "url(#below)" })];
}

/** The pressed wall and what presses it over the section; a plate is drawn as its lower face. */
function pressedWall(pressed, half) {
  if (!pressed) return [];
  const wall = pressed.walls[pressed.at];
  const mirrored = wall.map((value, k) => (k % 2 ? value : -value));
  const section = pressed.objects[pressed.at];
  const top = Math.max(...wall.filter((_, k) => k % 2));
  const object = section
    ? [section, section.map((value, k) => (k % 2 ? value : -value))].map((points) => element("svg:polyline", { points: pairs(points), class: "object" }))
    : [line([[-1.1 * half, top], [1.1 * half, top]], "object")];
  return [element("svg:path", { d: path(wall) + path(mirrored), class: "pressed" }), ...object];
}

const pairs = (points) => {
  let text = "";
  for (let k = 0; k < points.length; k += 2) text += `${points[k]},${-points[k + 1]} `;
  return text;
};

/** Width of the section's place in pixels, kept: reading it in the middle of changes costs a layout. */
let width = 0;
const measured = new ResizeObserver(([entry]) => (width = entry.contentRect.width));

export function drawSection(drawing, pinned, pressed) {
  if (!width) {
    width = byId("section").clientWidth;
    measured.observe(byId("section"));
  }
  const half = drawing.diameter_mm / 2;
  // A port at the side stands out to the right.
  const out = Math.max(0, drawing.size_mm[0] - drawing.diameter_mm);
  const usual = 0.068 * Math.max(half, 0.6 * (drawing.high_mm - drawing.low_mm));
  // On a narrow screen letters of about 11 pixels, as far as there is space for them.
  const size = Math.max(usual, Math.min((22 * half) / Math.max(1, width - 176), 0.13 * half));
  const low = drawing.low_mm - 4 * size;
  const box = [-half - 7 * size, -drawing.high_mm - 2 * size, 2 * half + Math.max(16 * size, out + 2 * size), drawing.high_mm - low + 2 * size];
  const words = drawing.bodies.map((body) => `${body.name} of ${body.material}`).join(", ");
  const svg = element(
    "svg:svg",
    { viewBox: box.join(" "), role: "img", "aria-label": `Section through ${words}, ${drawing.size_mm.map((v) => short(v)).join(" by ")} mm` },
    ...drawing.bodies.map((body) =>
      // Pressed, the wall as printed is an outline behind the pressed one.
      element("svg:path", { d: outline([body]), class: `outline ${body.role !== "membrane" ? "rigid" : pressed ? "resting" : "membrane"}` }),
    ),
    ...(pressed ? flange(drawing) : []),
    ...pressedWall(pressed, half),
    pinned ? element("svg:path", { d: outline(pinned.bodies), class: "pinned" }) : null,
    ...dimensions(drawing, size, 0.35 * size),
  );
  byId("section").replaceChildren(svg);
}
