// Files of the user: from a drop, with the folders that they lie in, or chosen; given to the studio one by one.
import { Failed, upload } from "./jobs.js";

const MOST = 500;

const hidden = (path) => path.split("/").some((part) => part.startsWith("."));

function entries(reader) {
  return new Promise((done, failed) => reader.readEntries(done, failed));
}

async function walked(entry, path, found) {
  if (found.length > MOST) return;
  if (entry.isFile) {
    found.push({ path: path + entry.name, file: await new Promise((done, failed) => entry.file(done, failed)) });
    return;
  }
  const reader = entry.createReader();
  for (let part = await entries(reader); part.length; part = await entries(reader)) {
    for (const one of part) await walked(one, `${path}${entry.name}/`, found);
  }
}

/** Files of a drop with their paths, folders unfolded; what is hidden is left out. */
export async function dropped(transfer) {
  const items = [...transfer.items].filter((item) => item.kind === "file");
  const roots = items.map((item) => item.webkitGetAsEntry?.()).filter(Boolean);
  // What a program dropped has no entry in a folder.
  const found = roots.length ? [] : items.map((item) => item.getAsFile()).map((file) => ({ path: file.name, file }));
  for (const entry of roots) await walked(entry, "", found);
  return found.filter(({ path }) => !hidden(path));
}

/** Files that were chosen, with the path below the folder that was chosen. */
export const chosen = (files) =>
  [...files].map((file) => ({ path: file.webkitRelativePath || file.name, file })).filter(({ path }) => !hidden(path));

/** Gives files to the studio; calls `moved(done, total)`. Returns those it has, {path, upload, bytes}, and the problems. */
export async function give(files, moved) {
  const [given, problems] = [[], []];
  if (files.length > MOST) problems.push(`More than ${MOST} files: give those of one campaign.`);
  else {
    for (const [place, { path, file }] of files.entries()) {
      moved(place, files.length);
      try {
        // The studio takes plain names alone; the path goes with the job, where it is checked.
        const ending = file.name.match(/\.[A-Za-z0-9]{1,8}$/)?.[0] ?? "";
        given.push({ path, upload: await upload(new File([file], `run-${place + 1}${ending}`)), bytes: file.size });
      } catch (error) {
        if (!(error instanceof Failed)) throw error;
        problems.push(...error.problems.map((one) => `${path}: ${one.message}`));
      }
    }
  }
  return { given, problems };
}
