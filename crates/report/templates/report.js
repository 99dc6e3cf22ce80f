"use strict";
// Tables: a click on a heading sorts by the first number of a cell, or by its words.
const raised = "⁰¹²³⁴⁵⁶⁷⁸⁹";
const number = text => {
  const plain = text.replace(/×10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)/, (_, power) =>
    "e" + [...power].map(c => (c === "⁻" ? "-" : raised.indexOf(c))).join(""));
  const found = plain.replace(/−/g, "-").replace(/[\s\u00a0\u202f](?=\d{3})/g, "").match(/-?\d+(\.\d+)?(e-?\d+)?/i);
  return found ? parseFloat(found[0]) : NaN;
};
const looksLikeNumber = text => /^[^\p{L}]*[\d∞]/u.test(text);
for (const table of document.querySelectorAll("table")) {
  const body = table.tBodies[0];
  if (!body || body.rows.length < 2) continue;
  // A row that takes its name from the one above has to stay below it.
  if ([...body.rows].some(row => !row.cells[0].textContent.trim())) continue;
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
// Folded parts: open where a link leads into one, all of them on paper, and the contents where there is room beside.
for (const contents of document.querySelectorAll("nav details")) contents.open = matchMedia("(min-width: 80rem)").matches;
const reveal = () => {
  const target = document.getElementById(decodeURI(location.hash).slice(1));
  const part = target && target.closest("main details");
  if (!part) return;
  part.open = true;
  target.scrollIntoView();
};
addEventListener("hashchange", reveal);
reveal();
let unfolded = [];
addEventListener("beforeprint", () => {
  unfolded = [...document.querySelectorAll("main details:not([open])")];
  for (const part of unfolded) part.open = true;
});
addEventListener("afterprint", () => {
  for (const part of unfolded) part.open = false;
});
// What is wider than the screen says so.
const widths = new ResizeObserver(seen => {
  for (const { target } of seen) target.classList.toggle("wide", target.scrollWidth > target.clientWidth + 1);
});
for (const box of document.querySelectorAll(".table, .plot")) widths.observe(box);
// Figures: a switch for every name of the key, the values under the pointer or the arrow keys, zoom by buttons.
const digits = (value, step) => {
  const decimals = Math.min(9, Math.max(0, 1 - Math.floor(Math.log10(Math.abs(step) || 1))));
  return value.toFixed(decimals).replace("-", "−");
};
const axis = told => {
  const [kind, lo, hi, ...rest] = told.split("|");
  const [from, to] = [Number(lo), Number(hi)];
  return (fraction, upward) => {
    if (kind === "names") {
      const place = upward ? 1 - fraction : fraction;
      return rest[Math.round(from + place * (to - from))] || "";
    }
    if (kind === "linear") return digits(from + fraction * (to - from), (to - from) / 300);
    const start = Number(rest[0]);
    if (fraction < start) return "0";
    const value = from * (to / from) ** ((fraction - start) / (1 - start));
    return value.toPrecision(3).replace(/e([+-]?\d+)/, " × 10^$1");
  };
};
// Corners of lines, centres of dots, middles of filled markers, in units of the view box.
const corners = element => {
  const found = [];
  if (element.tagName === "path") {
    for (const piece of element.getAttribute("d").split("M").slice(1)) {
      const [start, steps] = piece.split(/[lh]/);
      let [x, y] = start.split(" ").map(Number);
      found.push([x, y]);
      const moves = steps.split(" ").map(Number);
      for (let k = 0; k + 1 < moves.length; k += 2) found.push([(x += moves[k]), (y += moves[k + 1])]);
    }
  } else if (element.tagName === "polygon") {
    const pairs = element.getAttribute("points").trim().split(" ").map(pair => pair.split(",").map(Number));
    if (pairs.length <= 10) found.push([0, 1].map(k => pairs.reduce((sum, pair) => sum + pair[k], 0) / pairs.length));
  }
  return found;
};
for (const svg of document.querySelectorAll(".plot svg")) {
  const box = svg.parentElement;
  const panels = [...svg.querySelectorAll("[data-panel]")].map(told => {
    const [left, top, width, height] = told.dataset.panel.split(" ").map(Number);
    const { xTitle, yTitle } = told.dataset;
    return { left, top, width, height, xTitle, yTitle, x: axis(told.dataset.x), y: axis(told.dataset.y) };
  });
  const groups = [...svg.querySelectorAll("[data-series]")];
  const names = [...new Set(groups.map(group => group.dataset.series))];
  const keys = document.createElement("div");
  keys.className = "keys";
  keys.setAttribute("role", "group");
  keys.setAttribute("aria-label", "Parts of the figure");
  const button = (label, act) => {
    const made = document.createElement("button");
    made.type = "button";
    made.textContent = label;
    made.addEventListener("click", () => act(made));
    keys.append(made);
    return made;
  };
  let points = null;
  if (names.length > 1) {
    for (const name of names) {
      const own = groups.filter(group => group.dataset.series === name);
      const made = button(name, self => {
        const shown = self.getAttribute("aria-pressed") !== "true";
        self.setAttribute("aria-pressed", shown);
        for (const group of own) group.classList.toggle("hidden", !shown);
        points = null;
      });
      made.setAttribute("aria-pressed", "true");
      const inks = own.flatMap(group => [...group.children].flatMap(one => ["stroke", "fill"].map(k => one.getAttribute(k))));
      const swatch = document.createElement("i");
      swatch.style.background = inks.find(ink => /^#/.test(ink) && ink !== "#FFFFFF") || "none";
      made.prepend(swatch);
    }
  }
  // Zoom about the point that was read last, or about the middle; the page scrolls as ever.
  const whole = svg.getAttribute("viewBox").split(" ").map(Number);
  let view = whole;
  let read = null;
  const zoom = (factor, at) => {
    const [x, y] = at || (read ? read.place : [whole[2] / 2, whole[3] / 2]);
    const width = Math.min(whole[2], view[2] * factor);
    const height = (width / whole[2]) * whole[3];
    const keep = (value, size, all) => Math.min(Math.max(value, 0), all - size);
    view = [keep(x - width / 2, width, whole[2]), keep(y - height / 2, height, whole[3]), width, height];
    svg.setAttribute("viewBox", view.join(" "));
    back.disabled = view[2] >= whole[2];
  };
  button("Zoom in", () => zoom(0.5));
  const back = button("Whole figure", () => zoom(1e9));
  back.disabled = true;
  box.after(keys);
  const place = event => {
    const frame = svg.getBoundingClientRect();
    return [
      view[0] + ((event.clientX - frame.left) / frame.width) * view[2],
      view[1] + ((event.clientY - frame.top) / frame.height) * view[3],
    ];
  };
  svg.addEventListener("dblclick", event => zoom(view[2] < whole[2] ? 1e9 : 0.4, place(event)));
  if (!panels.length || !groups.length) continue;
  const value = document.createElement("p");
  value.className = "value";
  value.setAttribute("role", "status");
  value.textContent = "Point at a curve, or use the arrow keys on the figure, to read its values.";
  keys.before(value);
  const cross = document.createElementNS(svg.namespaceURI, "circle");
  cross.setAttribute("r", whole[2] / 130);
  for (const [name, set] of [["fill", "none"], ["stroke", "#111"], ["stroke-width", whole[2] / 700]]) {
    cross.setAttribute(name, set);
  }
  const inside = (panel, [x, y]) =>
    x >= panel.left - 2 && x <= panel.left + panel.width + 2 && y >= panel.top - 2 && y <= panel.top + panel.height + 2;
  const all = () => {
    if (points) return points;
    points = [];
    for (const group of groups.filter(group => !group.matches(".hidden, [data-interval]"))) {
      for (const at of [...group.children].flatMap(corners)) {
        const panel = panels.find(panel => inside(panel, at));
        if (panel) points.push({ place: at, panel, name: group.dataset.series });
      }
    }
    return points;
  };
  const tell = point => {
    read = point;
    const { panel, place: [x, y], name } = point;
    const across = panel.x((x - panel.left) / panel.width, false);
    const up = panel.y(1 - (y - panel.top) / panel.height, true);
    const said = (title, text) => {
      const unit = title.match(/\[(.*)\]\s*$/);
      const words = title.replace(/\s*\[.*\]\s*$/, "");
      return `${words}${words ? " " : ""}${text}${unit && unit[1] !== "1" ? " " + unit[1] : ""}`;
    };
    value.textContent = `${name}: ${said(panel.xTitle, across)}, ${said(panel.yTitle, up)}`;
    cross.setAttribute("cx", x);
    cross.setAttribute("cy", y);
    svg.append(cross);
  };
  const nearest = (candidates, cost) => {
    let best = null;
    let least = Infinity;
    for (const one of candidates) {
      const now = cost(one);
      if (now < least) [best, least] = [one, now];
    }
    return best;
  };
  // Where keys begin to read: at the left end of what has most places to go to.
  const begin = () => {
    const places = new Map();
    for (const one of all()) places.set(one.name, (places.get(one.name) || new Set()).add(Math.round(one.place[0])));
    const [name] = [...places].reduce((most, own) => own[1].size > most[1].size ? own : most, [undefined, new Set()]);
    return nearest(all().filter(one => one.name === name), one => one.place[0]);
  };
  svg.addEventListener("pointermove", event => {
    const at = place(event);
    const panel = panels.find(panel => inside(panel, at));
    if (!panel) return;
    const own = all().filter(one => one.panel === panel);
    const best = nearest(own, one => Math.hypot(one.place[0] - at[0], one.place[1] - at[1]));
    if (best) tell(best);
  });
  box.addEventListener("keydown", event => {
    const step = { ArrowLeft: -1, ArrowRight: 1, ArrowUp: 0, ArrowDown: 0 }[event.key];
    if (step === undefined || event.target !== box || event.ctrlKey || event.altKey || event.metaKey) return;
    if (!read && step === 0) return;
    event.preventDefault();
    const start = read && all().some(one => one.name === read.name) ? read : begin();
    if (!start) return;
    if (!read || start !== read) return tell(start);
    if (step) {
      const own = all().filter(one => one.panel === start.panel && one.name === start.name);
      const ahead = own.filter(one => step * (one.place[0] - start.place[0]) > whole[2] / 1000);
      const next = nearest(ahead, one => Math.abs(one.place[0] - start.place[0]));
      if (next) tell(next);
      return;
    }
    const shown = [...new Set(all().map(one => one.name))];
    const turn = event.key === "ArrowDown" ? 1 : shown.length - 1;
    const name = shown[(shown.indexOf(start.name) + turn) % shown.length];
    const others = all().filter(one => one.name === name);
    const here = others.filter(one => one.panel === start.panel);
    const next = nearest(here.length ? here : others, one => Math.abs(one.place[0] - start.place[0]));
    if (next) tell(next);
  });
}
