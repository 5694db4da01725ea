// What a build wrote: its files with what they are, and the datasheet in place.
import { written } from "./address.js";
import { element } from "./dom.js";

const UNITS = [[2 ** 20, "MB"], [2 ** 10, "kB"], [1, "bytes"]];

function size(bytes) {
  const [one, unit] = UNITS.find(([each]) => bytes >= each) ?? UNITS[2];
  return `${Number((bytes / one).toPrecision(3))} ${unit}`;
}

/** Words with names in backquotes. */
const spelt = (words) => words.split("`").map((part, k) => (k % 2 ? element("code", {}, part) : part));

export class Built {
  constructor(page) {
    this.page = page;
    this.files = element("section", { class: "card whole", id: "built", "aria-labelledby": "built-title", hidden: true });
    this.sheet = element("section", { class: "card whole", id: "built-sheet", "aria-labelledby": "sheet-title", hidden: true });
  }

  /** Show the files of a job that is done. */
  show(job, done, now) {
    const { name, groups, sheet, findings, left_out: without, question } = done.content;
    this.of = written(question);
    const bytes = new Map(done.files.map((each) => [each.name, each.bytes]));
    const file = (path) => element("li", {},
      element("a", { href: job.file(path), download: path.split("/").at(-1) }, path.slice(name.length + 1)), " ",
      element("small", {}, size(bytes.get(path))));
    const row = (group) => element("li", {}, element("ul", {}, ...group.files.map(file)), element("p", { class: "muted" }, ...spelt(group.words)));
    this.old = element("p", { class: "old", role: "status" });
    const notes = [...findings.map((each) => `${each.severity}: ${each.body}, ${each.rule}: ${each.message}`),
      ...Object.entries(without).map(([each, why]) => `note: ${each} is not written: ${why}`)];
    this.files.replaceChildren(
      element("h2", { id: "built-title" }, `Files of ${name}`),
      this.old,
      element("p", {}, element("a", { class: "primary", href: job.archive, download: `${name}.zip`, id: "archive" }, "Download all (zip)")),
      element("ul", { class: "groups" }, ...groups.map(row)),
      notes.length ? element("details", {}, element("summary", {}, `Findings: ${notes.length}`), element("ul", {}, ...notes.map((each) => element("li", {}, each)))) : "",
    );
    const address = job.file(sheet, true);
    this.sheet.replaceChildren(
      element("h2", { id: "sheet-title" }, `Datasheet of ${name}`),
      element("p", {}, element("a", { href: address, target: "_blank", rel: "noopener" }, "Open it in a tab of its own")),
      element("iframe", { src: address, title: `Datasheet of ${name}`, sandbox: "allow-scripts" }),
    );
    this.files.hidden = this.sheet.hidden = false;
    this.compare(now);
  }

  /** Whether the files are of the design that the page has now. */
  compare(now) {
    if (this.of) this.old.textContent = this.of === now ? "" : "The design was changed since: build it again for files of the one shown now.";
  }
}
