// Files that become the design of the page: dropped anywhere on it, or chosen.
import { byId, element } from "./dom.js";
import { Job, upload } from "./jobs.js";

/** Endings of the files that are opened. */
export const ENDINGS = ".3mf,.toml,.json";

/** A message below the head of the page, whatever area is shown; it stays until it is closed or the next one. */
export function notify(words, more = [], wrong = false) {
  const close = element("button", { type: "button", "aria-label": "Close this message", onclick: () => byId("notice").replaceChildren() }, "×");
  const lines = more.map((each) => element("li", {}, each));
  const text = element("div", {}, element("p", {}, words), lines.length ? element("ul", {}, ...lines) : null);
  byId("notice").replaceChildren(element("div", { class: wrong ? "wrong" : "" }, text, close));
}

const changes = (count) => (count === 1 ? "1 changed field" : `${count} changed fields`);

/** Open a file of the user's: what it holds becomes the design. Resolves to its name, or null where it is refused. */
export async function openFile(file, page) {
  notify(`Reading ${file.name}.`);
  let done;
  try {
    done = await new Job("open", { uploads: [await upload(file)] }).done;
  } catch (error) {
    const [first, ...rest] = error.problems?.map((each) => each.message) ?? [error.message];
    notify(first, rest, true);
    return null;
  }
  const { name, question, notes } = done.content;
  page.go(question);
  const count = Object.keys(question.values).length;
  notify(`Opened ${file.name}: ${question.base}${count ? ` with ${changes(count)}` : ", without changes"}. Undo brings the design before it back.`, notes);
  document.dispatchEvent(new CustomEvent("opened", { detail: { name, base: question.base } }));
  return name;
}

/** Open what is dropped on the page. The area Measure takes its own files. */
export function listenForFiles(page) {
  const ours = (event) => event.dataTransfer?.types.includes("Files") && document.body.dataset.area !== "measure";
  let inside = 0;
  const mark = (on) => (byId("drop").hidden = !on);
  const over = (event, step) => {
    if (!ours(event)) return;
    event.preventDefault();
    inside = Math.max(0, inside + step);
    mark(inside > 0);
  };
  document.addEventListener("dragenter", (event) => over(event, 1));
  document.addEventListener("dragleave", (event) => over(event, -1));
  document.addEventListener("dragover", (event) => over(event, 0));
  document.addEventListener("drop", (event) => {
    inside = 0;
    mark(false);
    if (!event.dataTransfer?.types.includes("Files")) return;
    // A browser would leave the page for the file.
    const taken = event.defaultPrevented;
    event.preventDefault();
    if (taken || !ours(event)) return;
    const files = [...event.dataTransfer.files];
    if (files.length === 1) openFile(files[0], page);
    else notify("One file is opened at a time.", [], true);
  });
}
