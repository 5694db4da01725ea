// What a search returned: its designs as cards, on the trade-off chart and as a table.
import { element } from "./dom.js";
import { TradeOff } from "./tradeoff.js";

const TITLES = {
  best: "Best of its resin",
  process: "Best of its process",
  shape: "Best of its shape",
  "runner-up": "Runner-up of its resin",
  nearest: "Nearest to the target",
  changed: "Fits with one change",
  dropped: "Fits without one requirement",
};

const cells = (tag, texts, head = []) => texts.map((text, k) => element(tag, tag === "th" ? { scope: "col" } : { "data-head": head[k + 1] }, text));

function table(caption, head, rows) {
  return element(
    "div",
    { class: "scroll", tabindex: 0, role: "region", "aria-label": caption },
    element(
      "table",
      {},
      element("caption", { class: "muted" }, caption),
      element("thead", {}, element("tr", {}, ...cells("th", head))),
      element("tbody", {}, ...rows.map(([first, ...rest]) => element("tr", {}, element("th", { scope: "row" }, first), ...cells("td", rest, head)))),
    ),
  );
}

export class Candidates {
  /** `use(card)`: a design was chosen to go on with. */
  constructor(host, use) {
    Object.assign(this, { host, use });
    this.chart = new TradeOff((index, go) => this.choose(index, go));
  }

  show(content) {
    this.content = content;
    const { cards, notes, remarks, chart } = content;
    this.items = cards.map((card, index) => this.card(card, index));
    const first = this.items.filter((_, index) => cards[index].kind !== "runner-up");
    const others = this.items.filter((_, index) => cards[index].kind === "runner-up");
    const list = (items) => element("ul", { class: "candidates" }, ...items);
    this.others = others.length ? element("details", {}, element("summary", {}, `Runners-up: ${others.length} more designs`), list(others)) : null;
    const parts = [
      notes.length ? element("p", { class: "muted" }, notes.join("; ")) : null,
      chart ? this.drawn(content) : null,
      cards.length ? element("h2", { class: "apart" }, "Candidates") : null,
      cards.length ? list(first) : null,
      this.others,
      cards.length > 1 ? this.compared(cards) : null,
      content.table ? element("section", { class: "card" }, table(content.table.caption, content.table.head, content.table.rows)) : null,
      remarks.length ? element("ul", { class: "remarks muted" }, ...remarks.map((words) => element("li", {}, words))) : null,
    ];
    this.host.replaceChildren(...parts.filter(Boolean));
    this.choose(0, false);
  }

  drawn({ chart, cards }) {
    this.chart.show(chart, cards);
    const titles = chart.fronts.map((front, k) => [this.chart.sample(k), front]);
    const head = ["line", "resin", "from kPa/N", "with N", "to kPa/N", "with N"];
    const figures = ({ sensitivity_kPa_per_N: s, force_N: f }) => [s[0], f[0], s.at(-1), f.at(-1)].map((value) => String(Number(value.toPrecision(3))));
    const rows = titles.map(([sample, front]) =>
      element("tr", {}, element("td", {}, sample), element("th", { scope: "row" }, front.title), ...cells("td", figures(front))),
    );
    const caption = "Lines: the greatest force range of each resin, from its least to its greatest sensitivity";
    return element(
      "section",
      { class: "card", "aria-labelledby": "tradeoff-title" },
      element("h2", { id: "tradeoff-title" }, "Trade-off: force range over sensitivity ", element("small", {}, `at ${chart.driving_pressure_kPa} kPa`)),
      this.chart.tools,
      element(
        "div",
        { class: "tradeoff" },
        element("div", {}, this.chart.host, this.chart.legend()),
        element(
          "div",
          { class: "scroll", tabindex: 0, role: "region", "aria-label": caption },
          element("table", { class: "fronts" }, element("caption", { class: "muted" }, caption), element("thead", {}, element("tr", {}, ...cells("th", head))), element("tbody", {}, ...rows)),
        ),
      ),
      chart.caption ? element("p", { class: "muted" }, chart.caption) : null,
    );
  }

  card(card, index) {
    const title = card.rank === null ? card.title : `${card.rank}  ${card.title}`;
    const row = ([what, value, more]) => element("div", {}, element("dt", {}, what), element("dd", {}, value, more ? element("small", {}, ` ${more}`) : null));
    const judged = card.passes ? "Passes check, the prediction by the solid included." : "`check` judges it when it is used.";
    return element(
      "li",
      { class: `card candidate ${card.kind}`, id: `candidate-${index}`, onclick: () => this.choose(index, false), onfocusin: () => this.choose(index, false) },
      element("p", { class: "kind" }, TITLES[card.kind]),
      element("h3", { id: `candidate-${index}-title` }, title),
      card.note ? element("p", { class: "note" }, card.note) : null,
      element("dl", {}, ...card.rows.map(row)),
      element("p", { class: "muted" }, judged),
      element(
        "button",
        { type: "button", class: "first", "aria-describedby": `candidate-${index}-title`, onclick: () => this.use(card) },
        "Use this design",
      ),
      card.command ? element("details", {}, element("summary", {}, "Save it by a command"), element("code", {}, card.command)) : null,
    );
  }

  /** Every candidate with its figures in one table. */
  compared(cards) {
    const keys = cards[0].rows.map(([what]) => what);
    const rows = cards.map((card) => {
      const figures = new Map(card.rows.map(([what, value]) => [what, value]));
      return [`${card.label} ${card.resin}`, ...keys.map((key) => figures.get(key) ?? "–")];
    });
    const label = "Candidates as a table";
    return element("details", {}, element("summary", {}, label), table(label, ["candidate", ...keys], rows));
  }

  /** Mark a candidate on the chart and among the cards; `go` moves the focus to its card. */
  choose(index, go) {
    if (!this.items.length) return;
    this.items.forEach((item, k) => item.classList.toggle("chosen", k === index));
    this.chart.choose(index);
    if (!go) return;
    if (this.others?.contains(this.items[index])) this.others.open = true;
    this.items[index].querySelector("button").focus({ preventScroll: true });
    this.items[index].scrollIntoView({ block: "nearest" });
  }
}
