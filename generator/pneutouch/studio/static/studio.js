// The page: a state, its history and its address; questions to the studio, and what shows the answers.
import * as address from "./address.js";
import { Areas } from "./areas.js";
import { Line, send, Stopped, unlock } from "./requests.js";
import * as charts from "./charts.js";
import { byId, copied, element, mark } from "./dom.js";
import { Following } from "./following.js";
import { Form } from "./form.js";
import { listenForFiles } from "./opening.js";
import { Pressed } from "./pressed.js";
import { Owed } from "./owed.js";
import { drawSection } from "./section.js";
import * as tables from "./tables.js";
import { CHANGED, Versions } from "./versions.js";
import { View } from "./view.js";

/** Milliseconds after the last move at which the atlas completes its answer, and at which the solid begins. */
const [PAUSED, SETTLED] = [80, 250];
const KEPT = 500;
const page = { state: null, past: [], future: [], quick: null, solved: null, pinned: null, from: null, outdated: false };
const parts = {};
const owed = new Owed();
const files = new Versions();

/** By the id of an area, the module that fills it when it is first shown. */
const MODULES = { target: "./target.js", map: "./map.js", pads: "./pads.js", live: "./live.js", files: "./files.js", measure: "./measure.js" };

/** What the areas are given: the design as it is now and its form, a function that opens another one, and the line of messages. */
const desk = {
  state: () => files.of(page.state),
  answer: () => current(),
  go: (state, settled) => go(state, settled),
  field: (name) => parts.form.fields.get(name),
  report: (words, busy = false) => report(words, busy),
  show: (name) => parts.areas.show(name),
  words: (base) => parts.words.get(base) ?? base,
  version: () => parts.version, pads: () => parts.pads,
  saved: (name) => saved(name),
};

function report(words, busy = false) {
  byId("status").textContent = words;
  byId("status").classList.toggle("busy", busy);
}

function buttons() {
  byId("undo").disabled = !page.past.length;
  byId("redo").disabled = !page.future.length;
  byId("reset").disabled = !Object.keys(page.state.values).length && !page.outdated;
  Object.assign(byId("pin"), { textContent: page.pinned ? "Unpin" : "Pin", disabled: !page.pinned && !page.quick });
}

/** The form as the state has it. */
function show() {
  parts.form.show(page.state, files.plain[page.state.base] ?? page.quick);
}

/** Request the answers to the state as it is now: what is quick, and after its answer to the last move the solid. */
function update(settled = true) {
  show();
  buttons();
  report("Computing.", true);
  byId("base").value = page.state.base;
  mark(byId("base"), Object.keys(page.state.values).length > 0);
  address.note(page.state, settled ? 0 : SETTLED);
  document.dispatchEvent(new Event("design"));
  clearTimeout(parts.soon);
  clearTimeout(parts.later);
  parts.quick.send(files.of(page.state));
}

/** Go to another state; `settled` states can be come back to. */
function go(state, settled = true) {
  page.from ??= page.state;
  if (state.version || state.base !== page.state.base) files.read(state.base, state.version);
  page.state = state;
  if (settled) {
    if (!address.same(page.from, state)) {
      page.past = [...page.past.slice(1 - KEPT), page.from];
      page.future = [];
    }
    page.from = null;
  }
  update(settled);
}

/** A design of this name was written: it is among the designs, and the page goes on with it. */
function saved(name) {
  if (!parts.words.has(name)) byId("base").append(element("option", { value: name }, name));
  parts.words.set(name, name);
  fresh(name);
}

/** Open a design as its file is now. */
function fresh(base) {
  files.read(base);
  go({ base, values: {} });
}

function step(from, to) {
  if (!page[from].length) return;
  page[to].push(page.state);
  page.state = page[from].pop();
  page.from = null;
  update();
}

function changed(name, text, settled) {
  const following = (field, value) => parts.following.of(field, value, page.state, page.quick);
  go({ base: page.state.base, values: { ...page.state.values, [name]: text, ...following(name, text) } }, settled);
}

function problems(list) {
  const without = parts.form.wrong(list);
  byId("problems").replaceChildren(...without.map((message) => element("li", {}, message)));
  byId("area-design").classList.toggle("stale", list.length > 0);
}

/** Draw the prediction: that of the quick answer, with its intervals once they are there, or the solid's in its place. */
function predicted(answer) {
  charts.drawSensitivity(answer, page.pinned);
  charts.drawStates("force", "contact_force_N", "contact force, N", answer, page.pinned);
  charts.drawStates("rise", "pressure_rise_kPa", "pressure rise, kPa", answer, page.pinned);
  charts.drawInflation(answer);
  tables.showTiles(answer, page.solved);
  tables.showFigures(answer.prediction);
  tables.showComparison(page.pinned, answer);
}

function current() {
  return page.solved ? { ...page.quick, ...page.solved } : page.quick;
}

function redraw() {
  draw();
  charts.complete();
}

/** Draw the answer; charts outside the window wait until they are inside, or until the rest of the answer is there. */
function draw() {
  const answer = current();
  if (!answer) return;
  drawSection(answer.drawing, page.pinned?.drawing, parts.pressed.now);
  if (answer.prediction) predicted(answer);
  else tables.showComparison(page.pinned, answer);
}

function quickly(question, status, content) {
  owed.send = null;
  page.outdated = status === CHANGED;
  if (status !== 200) {
    if (!address.same(question, page.state)) return;
    problems(content.problems);
    buttons();
    report(`${content.problems[0].message}. Shown below is the last design that can work.`);
    if (!page.outdated && page.quick?.base !== question.base) files.fetch(question.base, () => page.state.base === question.base && show());
    return;
  }
  problems([]);
  question = files.answered(question, content);
  parts.pressed.show(null);
  if (content.curves) content.curves.resins = (page.quick?.curves?.resins ?? []).map(charts.withoutPoints);
  page.quick = { ...content, base: question.base, pending: true };
  page.solved = null;
  parts.form.usual(content);
  show();
  byId("area-design").classList.toggle("stale", !content.prediction);
  draw();
  tables.showFindings(null);
  tables.showPrint(null);
  parts.view.mark([]);
  const why = content.outside ? `Not in the atlas: ${content.outside}. ` : "Answered by the atlas. ";
  report(`${why}The solid is computing.`, true);
  buttons();
  if (parts.view.renderer && !parts.view.drawnBySoftware) parts.shapes.send(question);
  if (address.same(question, page.state)) {
    parts.soon = setTimeout(() => complete(question, content), PAUSED);
    parts.later = setTimeout(() => parts.solved.send(question), SETTLED);
  }
  requestAnimationFrame(() => (document.body.dataset.painted = String(1 + Number(document.body.dataset.painted ?? 0))));
}

/** After the last move: the rest of the atlas's answer, and the view where it would hold up the moves. */
function complete(question, content) {
  if (parts.view.drawnBySoftware) parts.shapes.send(question);
  if (content.prediction) parts.intervals.send(question);
}

/** What the atlas adds to its quick answer: intervals, and the other resins. */
function completed(question, status, content) {
  if (status !== 200 || !address.same(question, page.state) || page.solved) return;
  page.quick = { ...page.quick, ...content, pending: false };
  redraw();
}

function solved(question, status, content) {
  if (!address.same(question, page.state)) return;
  if (status !== 200) {
    problems(content.problems);
    report(status === CHANGED ? content.problems[0].message : "The solid has no answer to this design.");
    return;
  }
  if (!page.quick) return;
  page.solved = { ...content, pending: false };
  byId("area-design").classList.remove("stale");
  predicted(current());
  charts.complete();
  parts.pressed.show(content);
  tables.showFindings(content.check, parts.view.renderer);
  tables.showPrint(content.jobs);
  parts.view.mark(content.check.findings);
  report(`Answered by the model ${content.prediction.model}.`);
  document.body.dataset.solved = address.written(question);
}

/** Another page of this studio took the solid: the page that has the focus requests it again. */
function replaced(question) {
  if (!address.same(question, page.state)) return;
  owed.send = () => parts.solved.send(files.of(page.state));
  if (document.hasFocus()) parts.later = setTimeout(() => owed.settle(), 4 * SETTLED);
  else report("Another page of this studio took the solid; it answers again when you come back to this page.");
}

function failed(question, error) {
  owed.send = error instanceof Stopped ? () => update() : null;
  report(error instanceof Stopped ? error.message : `The page has a fault: ${error.message}`);
  byId("area-design").classList.add("stale");
  if (!(error instanceof Stopped)) throw error;
}

function pin() {
  page.pinned = page.pinned ? null : current();
  buttons();
  redraw();
}

async function copy() {
  const words = address.options(page.state, desk.words(page.state.base));
  report((await copied(words)) ? `Copied: ${words}` : words);
}

function listen() {
  byId("undo").onclick = () => step("past", "future");
  byId("redo").onclick = () => step("future", "past");
  byId("reset").onclick = () => fresh(page.state.base);
  byId("pin").onclick = pin;
  byId("copy").onclick = copy;
  byId("base").onchange = (event) => fresh(event.target.value);
  byId("cut").onchange = (event) => parts.view.set({ open: event.target.checked });
  byId("explode").oninput = (event) => parts.view.set({ apart: event.target.value / 100 });
  document.addEventListener("keydown", (event) => {
    if (!(event.ctrlKey || event.metaKey) || event.target.type === "text") return;
    if (event.key.toLowerCase() === "z") step(...(event.shiftKey ? ["future", "past"] : ["past", "future"]));
    else if (event.key.toLowerCase() === "y") step("future", "past");
    else return;
    event.preventDefault();
  });
  window.addEventListener("pagehide", () => address.flush());
  window.addEventListener("hashchange", () => {
    address.forget();
    const state = address.read(location.hash);
    if (state && !address.same(state, page.state)) go(state);
  });
  new ResizeObserver(() => {
    charts.resized();
    if (page.quick) drawSection(page.quick.drawing, page.pinned?.drawing, parts.pressed.now);
  }).observe(byId("results"));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
    charts.forget();
    redraw();
  });
}

async function start() {
  await unlock();
  const declared = await (await send("/api/form")).json();
  byId("base").replaceChildren(...declared.designs.map((one) => element("option", { value: one.name, title: one.title }, one.name)));
  const words = new Map(declared.designs.map((one) => [one.name, one.words]));
  Object.assign(parts, { words, version: declared.version, pads: declared.pads });
  byId("view-tools").hidden = !(parts.view = new View(byId("view"))).renderer;
  parts.pressed = new Pressed((pressed) => {
    if (page.quick) drawSection(page.quick.drawing, page.pinned?.drawing, pressed);
    parts.view.press(pressed);
  });
  parts.form = new Form(declared, changed);
  parts.following = new Following(parts.form, declared.printers);
  parts.quick = new Line("/api/quick", quickly, failed);
  parts.intervals = new Line("/api/intervals", completed, failed);
  parts.solved = new Line("/api/solved", solved, failed, replaced);
  parts.shapes = new Line("/api/view", (_, status, content) => status === 200 && parts.view.show(content.bodies), failed);
  page.state = address.read(location.hash) ?? { base: declared.first, values: {} };
  byId("base").value = page.state.base;
  listen();
  parts.areas = new Areas(desk, MODULES);
  listenForFiles(desk);
  if (location.pathname !== "/") parts.areas.show({ "/pad": "pads" }[location.pathname] ?? "live");
  update();
}

start().catch((error) => report(`The page cannot start: ${error.message}`));
