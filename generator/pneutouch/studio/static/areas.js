// The areas of the page as tabs: one is shown; what an area needs is loaded when it is first shown.
import { byId, element } from "./dom.js";

export class Areas {
  /** `modules` has by the id of an area the path of its module, whose `open(root, page)` fills it once. */
  constructor(page, modules) {
    Object.assign(this, { page, modules, opened: new Set() });
    this.areas = [...document.querySelectorAll(".area")];
    this.tabs = this.areas.map((area) => this.tab(area));
    byId("areas").replaceChildren(...this.tabs);
    byId("areas").hidden = this.areas.length < 2;
    // The address holds the design: the link to the results moves the focus alone.
    document.querySelector(".skip").addEventListener("click", (event) => this.skip(event));
    byId("areas").addEventListener("keydown", (event) => this.key(event));
    this.show("design");
  }

  tab(area) {
    const name = area.id.replace("area-", "");
    area.setAttribute("role", "tabpanel");
    area.setAttribute("aria-labelledby", `tab-${name}`);
    const words = { type: "button", role: "tab", id: `tab-${name}`, "aria-controls": area.id };
    return element("button", { ...words, onclick: () => this.show(name) }, area.dataset.title);
  }

  async show(name) {
    for (const [index, area] of this.areas.entries()) {
      const shown = area.id === `area-${name}`;
      area.hidden = !shown;
      this.tabs[index].setAttribute("aria-selected", String(shown));
      this.tabs[index].tabIndex = shown ? 0 : -1;
    }
    document.body.dataset.area = name;
    if (this.modules[name] && !this.opened.has(name)) {
      this.opened.add(name);
      (await import(this.modules[name])).open(byId(`area-${name}`), this.page);
    }
  }

  skip(event) {
    event.preventDefault();
    const shown = this.areas.find((area) => !area.hidden);
    const place = shown.querySelector("[tabindex='-1']:not([role])") ?? shown;
    place.tabIndex = -1;
    place.focus();
  }

  /** Arrow keys, Home and End move between tabs. */
  key(event) {
    const now = this.tabs.indexOf(document.activeElement);
    const last = this.tabs.length - 1;
    const next = { ArrowRight: now < last ? now + 1 : 0, ArrowLeft: now > 0 ? now - 1 : last, Home: 0, End: last }[event.key];
    if (now < 0 || next === undefined) return;
    event.preventDefault();
    this.tabs[next].focus();
    this.tabs[next].click();
  }
}
