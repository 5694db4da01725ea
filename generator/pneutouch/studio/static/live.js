// The area Live: a device at a serial port, its force as it comes, the last seconds as a chart, and what is recorded.
import * as charts from "./charts.js";
import { byId, colour, element, short } from "./dom.js";
import { LivePad } from "./livepad.js";
import { post, send, Stopped } from "./requests.js";

/** Seconds that the chart shows. */
const SHOWN = 30;
const HALF = 1.96;
const LINKS = {
  opening: "Opening the device.",
  waiting: "Waiting for the first sample.",
  reading: "Reading.",
  silent: "The device is silent.",
  foreign: "The device sends something else than lines of a pneutouch sketch.",
  unplugged: "The device was unplugged. It is opened again when it is back.",
  closed: "No device is open.",
  elsewhere: "Another page watches the device. Reload this one to watch it here.",
};
/** Statuses of a reading in words; with others there is a force. */
const WITHOUT = {
  TARING: "taking the zero: touch nothing",
  NOT_TARED: "no zero yet: tare",
  NOT_A_NUMBER: "the gauge does not answer",
  GAUGE_SATURATED: "the gauge is at the end of its range",
  CONDITIONS: "beyond the conditions of the table",
  DRIVING_PRESSURE: "this driving pressure is not in the table",
  BELOW_ZERO: "below the zero: leak or cooling; tare again",
  BEYOND_RANGE: "pressed beyond the range of the table",
  UNSTEADY_TARE: "something moved during the tare; tare again",
};

const field = (words, input, help) => element("div", { class: "field long" }, element("label", {}, words, input), element("p", { class: "help" }, help));
const text = (name, value, more = {}) => element("input", { type: "text", name, value, spellcheck: "false", autocomplete: "off", ...more });

const OF_PAGE = "the design of this page";
class LivePage {
  constructor(root, page) {
    Object.assign(this, { root, page, rows: [], state: null, problems: [], asked: false, number: 0 });
    root.replaceChildren(this.results(), this.form());
    this.take({ state: { link: "closed", said: [] } });
    this.known();
  }

  results() {
    this.status = element("p", { class: "status", role: "status", "aria-live": "polite" });
    this.list = element("ul", { class: "problems" });
    const tile = (words) => [element("b", {}, "–"), element("small", {}, words)];
    this.tiles = Object.fromEntries(["force", "interval", "pressure", "zero", "samples", "delay"].map((name) => [name, tile(name)]));
    const tiles = Object.entries(this.tiles).map(([name, parts]) => element("div", { class: `tile ${name}` }, ...parts));
    this.step = element("p", { class: "step", role: "status", hidden: true });
    this.said = element("ul", { class: "said" });
    const chart = (id, words) => element("section", { class: "card" }, element("h2", {}, words), element("div", { id, class: "chart" }));
    this.map = new LivePad();
    const events = element("section", { class: "card wide" }, element("h2", {}, "Events"), this.said);
    return element(
      "div",
      { tabindex: -1, class: "results" },
      this.status,
      element("div", { role: "alert" }, this.list),
      this.step,
      element("div", { class: "tiles" }, ...tiles),
      element("div", { class: "cards" }, this.map.card, chart("live-force", "Force, the last 30 s"), chart("live-pressure", "Pressure, the last 30 s"), events),
    );
  }

  form() {
    const button = (words, act, more = {}) => element("button", { type: "button", onclick: act, ...more }, words);
    const pads = this.page.pads().map((name) => element("option", { value: name }, `pad ${name}`));
    this.sensor = element("select", { name: "live.sensor" }, element("option", { value: "" }, OF_PAGE), ...pads);
    this.ports = element("p", { class: "muted" });
    this.inputs = {
      port: text("live.port", "simulated"),
      baud: text("live.baud", "115200", { inputmode: "numeric" }),
      folder: text("live.folder", "outputs/live"),
      plan: text("live.plan", ""),
    };
    this.buttons = {
      open: element("button", { type: "submit", class: "first" }, "Open"),
      close: button("Close", () => this.close()),
      tare: button("Tare", () => this.command({ do: "tare" })),
      record: button("Record", () => this.command({ do: "record", folder: this.inputs.folder.value })),
      plan: button("Record the next run", () => this.command({ do: "plan", folder: this.inputs.plan.value })),
      stop: button("Stop recording", () => this.command({ do: "stop" })),
    };
    const { port, baud, folder, plan } = this.inputs;
    const form = element(
      "form",
      { "aria-label": "Device" },
      field("Sensor", this.sensor, "A pad that was not tabulated before takes two minutes and more."),
      field("Port", port, "Serial port of the device, such as /dev/ttyACM0; or simulated, or simulated:20 for one 20 times as fast."),
      this.ports,
      field("Bits a second", baud, "As the sketch has them."),
      element("div", { class: "row" }, this.buttons.open, this.buttons.close, this.buttons.tare),
      field("Record into", folder, "A folder below the one where the studio was started; characterize reads it."),
      element("div", { class: "row" }, this.buttons.record, this.buttons.stop),
      field("Plan", plan, "Folder that pneutouch plan wrote, below the one where the studio was started. Its runs are recorded in order."),
      element("div", { class: "row" }, this.buttons.plan),
    );
    form.onsubmit = (event) => {
      event.preventDefault();
      this.open();
    };
    return form;
  }

  /** The ports of this machine; a device that another page opened is watched. */
  async known() {
    try {
      const answer = await (await send("/api/live/ports")).json();
      if (answer.problems) this.fault(answer.problems);
      const [first, ...more] = answer.ports ?? [];
      if (more.length && this.inputs.port.value === "simulated") this.inputs.port.value = first;
      this.ports.textContent = first ? `Found: ${[first, ...more].join(", ")}.` : "";
      if (answer.open) this.watch();
    } catch (error) {
      this.failed(error);
    }
  }

  async open() {
    const { port, baud } = this.inputs;
    this.fault([]);
    try {
      const { status, content } = await post("/api/live/open", { question: this.page.state(), pad: this.sensor.value || null, port: port.value.trim(), baud: baud.value.trim() });
      if (status !== 202) return this.fault(content.problems);
      Object.assign(this, { rows: [], file: null, touch: null });
      await this.map.open(this.sensor.value);
      this.take({ state: { link: "opening", said: [] } });
      this.watch();
    } catch (error) {
      this.failed(error);
    }
  }

  async command(words) {
    this.fault([]);
    try {
      const { status, content } = await post("/api/live/do", words);
      if (status !== 202) this.fault(content.problems);
    } catch (error) {
      this.failed(error);
    }
  }

  async close() {
    try {
      await post("/api/live/close", {});
    } catch (error) {
      this.failed(error);
    }
  }

  /** Read frames until the device ends, or another stream of this page begins. */
  async watch() {
    const number = ++this.number;
    try {
      const answer = await send("/api/live/frames");
      const stream = answer.body.pipeThrough(new TextDecoderStream()).getReader();
      let rest = "";
      for (;;) {
        const { value, done } = await stream.read();
        if (done || number !== this.number) break;
        const lines = (rest + value).split("\n");
        rest = lines.pop();
        for (const line of lines) if (line) this.take(JSON.parse(line));
      }
      if (number === this.number && !this.elsewhere) this.take({ state: { ...this.state, link: "closed", recording: null, step: "" } });
    } catch (error) {
      this.failed(error);
    }
  }

  /** Take a frame; it is painted with the next picture of the screen. */
  take({ points, made, state, file, fault, touch, elsewhere }) {
    this.elsewhere = Boolean(elsewhere);
    if (elsewhere) this.state = { ...this.state, link: "elsewhere" };
    if (touch?.kind) {
      this.touch = touch;
      // Of a pad the last sample of a frame is read.
      [points.at(-1)[1], points.at(-1)[2]] = [touch.force_N, touch.uncertainty_N];
    }
    if (fault) this.fault(fault.problems);
    if (state) this.state = state;
    if (file !== undefined) this.file = file;
    if (points) {
      // After a break all kept samples come again.
      if (this.rows.length && points[0][0] <= this.rows.at(-1)[0]) this.rows = [];
      this.rows.push(...points);
      const from = this.rows.findIndex(([time]) => time >= this.rows.at(-1)[0] - SHOWN);
      this.rows.splice(0, from);
      this.made = made;
    }
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => {
      this.asked = false;
      this.paint(Boolean(points));
    });
  }

  paint() {
    const { state, buttons } = this;
    const is_open = state.link !== "closed";
    const words = state.device ? ` The device is made for ${state.device}.` : "";
    const said = `${LINKS[state.link] ?? state.link}${is_open ? words : ""}`;
    if (this.status.textContent !== said) this.status.textContent = said;
    this.root.dataset.link = state.link;
    for (const [name, one] of Object.entries(buttons)) one.disabled = name === "open" ? false : !is_open || (name === "stop" ? !state.recording && !state.step : name !== "close" && name !== "tare" && Boolean(state.recording));
    const step = state.step ? `${state.step}: ${state.step_left_s.toFixed(1)} s` : "";
    const recorded = state.recording ? `Recording ${state.recording}, ${short(state.recorded_s, 4)} s.` : this.file ? `Recorded: ${this.file}` : "";
    this.step.hidden = !step && !recorded;
    this.step.replaceChildren(...[step && element("b", {}, step), step && recorded ? " " : "", recorded].filter(Boolean));
    this.said.replaceChildren(...[...state.said].reverse().map((each) => element("li", {}, each)));
    this.figures(state);
    if (this.rows.length && !document.hidden) this.draw();
  }

  figures(state) {
    const [, force, sigma, , ...pressures] = this.rows.at(-1) ?? [];
    const zeros = state.driving_pressures_kPa?.every((one) => one !== null) ? state.driving_pressures_kPa : [];
    const rises = this.touch && zeros.length === pressures.length ? pressures.map((each, k) => each - zeros[k]) : null;
    const put = (name, value, words) => this.tiles[name].forEach((part, k) => part.textContent !== [value, words][k] && (part.textContent = [value, words][k]));
    const known = force !== null && force !== undefined;
    put("force", known ? `${force.toFixed(2)} N` : "–", WITHOUT[state.status] ?? (state.status === "ABOVE_RATING" ? "above the rated pressure" : "force"));
    put("interval", known && sigma !== null ? `${Math.max(force - HALF * sigma, 0).toFixed(2)} to ${(force + HALF * sigma).toFixed(2)}` : "–", "95 % interval, N");
    if (rises) this.map.read(this.touch, rises);
    if (rises) put("pressure", short(Math.max(...rises), 3), "greatest pressure rise, kPa");
    else put("pressure", pressures.length ? pressures.map((one) => (one === null ? "–" : one.toFixed(2))).join(", ") : "–", "pressure, kPa");
    const [least, most] = [Math.min(...zeros), Math.max(...zeros)].map((one) => one.toFixed(2));
    put("zero", zeros.length ? (least === most ? least : `${least} to ${most}`) : "–", state.drift_kPa ? `without contact, kPa; ${(Math.round(1e3 * state.drift_kPa) / 1e3 + 0).toFixed(3)} since the tare` : "without contact, kPa");
    put("samples", state.rate_Hz ? `${short(state.rate_Hz, 3)} Hz` : "–", `${state.samples ?? 0} samples, ${state.lost ?? 0} lost, ${state.damaged ?? 0} damaged`);
    const delay = this.made ? Math.max(0, performance.timeOrigin + performance.now() - 1e3 * this.made) : null;
    if (delay !== null) put("delay", `${Math.round(delay)} ms`, "from sample to screen");
    document.body.dataset.delay = delay === null ? "" : delay.toFixed(1);
  }

  draw() {
    const { rows } = this;
    const column = (take) => rows.map(take);
    const times = column(([time]) => time);
    const end = (sign) => column(([, force, sigma]) => (force === null || sigma === null ? null : Math.max(force + sign * HALF * sigma, 0)));
    const beside = rows.some((row) => row[3] !== null);
    const edge = { width: 1, dash: [2, 3] };
    const lines = [charts.series("force", colour("accent"), { width: 2 }), charts.series("95 % interval", colour("accent"), edge), charts.series("lower end", colour("accent"), { ...edge, class: "unlisted" })];
    const data = [times, column((row) => row[1]), end(1), end(-1)];
    if (beside) {
      lines.push(charts.series("force sensor", colour("ink"), { width: 1.2, dash: [6, 4] }));
      data.push(column((row) => row[3]));
    }
    charts.show("live-force", "time, s", "force, N", lines, data, { bands: [{ series: [2, 3], fill: colour("band") }] });
    const cells = rows.at(-1).length - 4;
    const zeros = this.state.driving_pressures_kPa ?? [null];
    const pressures = Array.from({ length: cells }, (_, k) => charts.series(cells > 1 ? `cell ${k + 1}` : "pressure", charts.tone(k), { dash: charts.dashes(k) }));
    // The rises of a pad's cells are small beside their driving pressure.
    const read = pressures.map((_, k) => column((row) => (cells === 1 ? row[4] : row[4 + k] === null || zeros[k] === null ? null : row[4 + k] - zeros[k])));
    if (cells === 1) {
      pressures.push(charts.series("without contact", colour("ink"), { width: 1, dash: [6, 4] }));
      read.push(column(() => zeros[0]));
    }
    charts.show("live-pressure", "time, s", cells > 1 ? "pressure rise, kPa" : "pressure, kPa", pressures, [times, ...read]);
  }

  fault(problems) {
    const rest = problems.filter(({ fields, message }) => !this.mark(fields ?? [], message));
    this.list.replaceChildren(...rest.map(({ message }) => element("li", {}, message)));
    if (!problems.length) for (const input of Object.values(this.inputs)) this.marked(input, "");
  }

  /** True if a problem belongs to one of the fields, which then says so. */
  mark(names, message) {
    const input = Object.values(this.inputs).find((each) => names.includes(each.name));
    if (input) this.marked(input, message);
    return Boolean(input);
  }

  marked(input, message) {
    const row = input.closest(".field");
    row.classList.toggle("faulty", Boolean(message));
    row.querySelector(".wrong")?.remove();
    if (message) row.append(element("p", { class: "wrong", role: "alert" }, message));
  }

  failed(error) {
    this.status.textContent = error instanceof Stopped ? error.message : `The page has a fault: ${error.message}`;
    if (!(error instanceof Stopped)) throw error;
  }
}

export function open(root, page) {
  byId("area-live").dataset.link = "closed";
  return new LivePage(root, page);
}
