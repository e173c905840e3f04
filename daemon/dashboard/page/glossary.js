// SPDX-License-Identifier: Apache-2.0
// What the page's words mean: the lines of docs/glossary.md, which comes with the page, as tooltips.

const waiting = new Set();  // elements that were explained before the glossary came
let lines = null;           // meanings by term, in lower case

const plain = (text) => text.replace(/\[([^\]]+)\]\([^)]*\)/g, "$1").replace(/[`*]/g, "").replace(/ \(note \d+\)/g, "").trim();

/// Meanings by term, of all tables whose second column is one. "inlier, outlier" are two terms of one line.
export function lines_of(markdown) {
  const found = new Map();
  let is_read = false;
  for (const line of markdown.split("\n")) {
    const cells = line.startsWith("| ") ? line.slice(2).split(" | ").map(plain) : [];
    if (!cells.length) { is_read = is_read && line.startsWith("|"); continue; }
    if (cells[1]?.replace(/ \|$/, "") === "meaning") { is_read = true; continue; }
    if (!is_read) continue;
    const meaning = cells[1].replace(/ \|$/, "");
    for (const term of [cells[0], ...cells[0].split(", ")]) if (!found.has(term.toLowerCase())) found.set(term.toLowerCase(), meaning);
  }
  return found;
}

function put({ element, term, detail }) {
  const meaning = lines?.get(term.toLowerCase());
  const text = [detail, meaning ? meaning[0].toUpperCase() + meaning.slice(1) + (meaning.endsWith(".") ? "" : ".") : ""].filter(Boolean).join(" ");
  if (element.title !== text) element.title = text;
}

/// Gives the element its line of the glossary: of `term`, by default of its own words. `detail` stands before it.
export function explain(element, term = element.dataset.term ?? element.textContent, detail = "") {
  const one = { element, term, detail };
  if (lines) return put(one);
  for (const other of waiting) if (other.element === element) waiting.delete(other);
  waiting.add(one);
}

fetch("/page/glossary.md").then((answer) => answer.text()).then((text) => {
  lines = lines_of(text);
  for (const one of waiting) put(one);
  waiting.clear();
}, () => {});
