"use strict";
// Tables: a click on a heading sorts by the first number of a cell, or by its words.
const number = text => {
  const found = text.replace(/−/g, "-").replace(/[\s\u00a0\u202f](?=\d{3})/g, "").match(/-?\d+(\.\d+)?(e-?\d+)?/i);
  return found ? parseFloat(found[0]) : NaN;
};
const looksLikeNumber = text => /^[^\p{L}]*[\d∞]/u.test(text);
for (const table of document.querySelectorAll("table")) {
  const body = table.tBodies[0];
  if (!body || body.rows.length < 2) continue;
  [...table.tHead.rows[0].cells].forEach((head, column) => {
    if (!head.textContent.trim()) return;
    const button = document.createElement("button");
    button.type = "button";
    button.append(...head.childNodes);
    head.append(button);
    button.addEventListener("click", () => {
      const up = head.getAttribute("aria-sort") !== "ascending";
      for (const other of table.tHead.rows[0].cells) other.removeAttribute("aria-sort");
      head.setAttribute("aria-sort", up ? "ascending" : "descending");
      const text = row => (row.cells[column] ? row.cells[column].textContent.trim() : "");
      const rows = [...body.rows];
      const told = rows.map(text).filter(cell => !/^[–—-]?$/.test(cell));
      const numeric = told.length > 0 && told.every(looksLikeNumber);
      const isMissing = cell => (numeric ? Number.isNaN(number(cell)) : /^[–—-]?$/.test(cell));
      rows.sort((one, other) => {
        const [a, b] = [text(one), text(other)];
        // What is missing stays last, whichever way it is sorted.
        if (isMissing(a) || isMissing(b)) return isMissing(a) - isMissing(b);
        const order = numeric ? number(a) - number(b) : a.localeCompare(b, "en");
        return up ? order : -order;
      });
      body.append(...rows);
    });
  });
}
