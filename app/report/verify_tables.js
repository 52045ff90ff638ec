// What was verified, in words and tables.
"use strict";

const DIGITS = 16; // where a bar ends: all that a double has
const PIXELS_A_DIGIT = 8;
const FOLDED = 20; // more events than this are folded

const counts = (check) => check.scale === undefined;
const spaced = (word) => word.replaceAll("_", " ");
const seconds = (t) => `${format(t, 6)} s`;
const allChecks = ({ groups }) => groups.flatMap((group) => group.checks.map((check) => ({ group, check })));
const flag = () => element("span", { class: "flag" }, "FAILS");

/// "over the run, positions: error 2×10⁻⁹ is above its bound, 10⁻⁹ m, rad, at t = 0.3 s".
function complaint({ group, check }) {
  const where = `${group.title.charAt(0).toLowerCase()}${group.title.slice(1)}, ${check.quantity}`;
  if (counts(check)) return `${where}: ${count(check.error)} ${check.unit}, first at t = ${seconds(check.t)}`;
  if (check.error === null) return `${where}: the error is not a number`;
  return `${where}: error ${format(check.error, 3)} is above its bound, ${format(check.bound, 3)} ${check.unit}, at t = ${seconds(check.t)}`;
}

function writeVerdict({ document: found, duration }) {
  const checks = allChecks(found);
  const failing = checks.filter(({ check }) => !check.held);
  const box = document.getElementById("verdict");
  const say = (text, ...kind) => box.append(element("span", kind.length > 0 ? { class: kind.join(" ") } : {}, text));
  box.classList.add(found.verified ? "good" : "bad");
  box.append(element("strong", {}, found.verified ? "Verified" : "NOT VERIFIED"));
  if (found.status !== "ok") say(`Refused by the kernel: ${found.message}`);
  if (failing.length > 0) say(`${failing.length} of ${checks.length} checks ${failing.length === 1 ? "fails" : "fail"}. First, ${complaint(failing[0])}.`);
  if (found.verified) say(`All ${checks.length} checks are within their bounds.`);
  if (found.status !== "ok" && found.steps > 0) say(`What follows is about the run up to there, ${seconds(found.t)} of ${seconds(duration)}.`, "aside");
  if (found.oracle.end) say(`The oracle’s trajectory ends at ${found.oracle.end}.`, "aside");
  if (found.not_checked.length > 0) say("Not everything could be checked: see below.", "aside");
}

function writeFigures({ document: { method, dt, steps, t, oracle } }) {
  const figure = (name, value, unit) => element("div", {}, element("dt", {}, name), element("dd", {}, value, element("small", {}, ` ${unit}`)));
  const figures = document.getElementById("figures");
  figures.append(figure("Method", method, ""), figure("Step dt", format(dt, 4), "s"), figure("Steps", count(steps), ""), figure("Duration", format(t, 5), "s"));
  if (oracle.steps === 0) return;
  figures.append(
    figure("Oracle", oracle.digits.toFixed(0), "digits shared by two of its runs"),
    figure("Its steps", count(oracle.steps), ""),
    figure("Its events", count(oracle.events.length), ""));
}

/// From zero to DIGITS, with a mark at those needed.
function bar(digits, needed) {
  const x = (n) => PIXELS_A_DIGIT * Math.min(DIGITS, Math.max(0, n));
  const drawing = shape("svg", { viewBox: `-1 0 ${x(DIGITS) + 2} 14`, "aria-hidden": "true" }, shape("rect", { class: "track", x: 0, y: 4, width: x(DIGITS), height: 6 }));
  if (digits !== null) drawing.append(shape("rect", { class: "shared", x: 0, y: 4, width: x(digits).toFixed(1), height: 6 }));
  drawing.append(shape("rect", { class: "mark", x: (x(needed) - 1).toFixed(1), y: 0, width: 2, height: 14 }));
  return drawing;
}

function scaleOfBars() {
  const label = (n, anchor) => shape("text", { x: n * PIXELS_A_DIGIT, y: 9, "text-anchor": anchor }, `${n}`);
  return shape("svg", { viewBox: `-1 0 ${DIGITS * PIXELS_A_DIGIT + 2} 11`, "aria-hidden": "true" }, label(0, "start"), label(DIGITS / 2, "middle"), label(DIGITS, "end"));
}

/// Roles are written out: on a narrow screen rows are no table rows to CSS, which would take them from a screen reader.
function cell(kind, content, name) {
  return element("td", { role: "cell", class: kind, ...(name ? { "data-name": name } : {}) }, content);
}

function row(check) {
  const node = element("tr", { role: "row", class: check.held ? "holds" : "fails" },
    element("th", { role: "rowheader", scope: "row" }, check.quantity, ...(check.held ? [] : [flag()])));
  if (counts(check)) {
    const several = cell("count", `${count(check.error)} ${check.unit}`);
    several.colSpan = 6;
    node.append(several, check.held ? cell("at", "") : cell("at", seconds(check.t), "first at t ="));
    return node;
  }
  const digits = check.error === null ? null : check.digits;
  node.append(
    cell("digits", digits === null ? "–" : digits.toFixed(1)), cell("bar", bar(digits, check.digits_needed)),
    cell("needed", check.digits_needed.toFixed(1), "needed"), cell("error", format(check.error, 3), "error"),
    cell("bound", format(check.bound, 3), "bound"), cell("unit", check.unit), cell("at", seconds(check.t), "at t ="));
  return node;
}

function groupTable({ title, explanation, checks }) {
  const head = (content, kind) => element("th", { role: "columnheader", scope: "col", class: kind }, content);
  const heads = [head("", "quantity"), head("digits", "digits"), head(scaleOfBars(), "bar"), head("needed", "needed"), head("error", "error"), head("bound", "bound"), head("unit", "unit"), head("worst at t", "at")];
  return element("div", { class: "group" }, element("table", { role: "table" },
    element("caption", {}, title, element("span", {}, explanation)),
    element("thead", { role: "rowgroup" }, element("tr", { role: "row" }, ...heads)),
    element("tbody", { role: "rowgroup" }, ...checks.map(row))));
}

function writeGroups({ groups }) {
  const filled = groups.filter(({ checks }) => checks.length > 0);
  document.getElementById("groups").append(...filled.map(groupTable));
  document.getElementById("checked").hidden = filled.length === 0;
}

function writeUnchecked({ not_checked: sentences }) {
  document.getElementById("not-checked").append(...sentences.map((sentence) => element("li", {}, sentence)));
  document.getElementById("unchecked").hidden = sentences.length === 0;
}

function writeEvents({ oracle: { events } }) {
  const line = ({ t, guide, contact, kind }) => element("tr", {}, ...[`${t.toFixed(9)} s`, spaced(kind), guide, contact === null ? "" : `${contact}`].map((text) => element("td", {}, text)));
  const table = element("table", {},
    element("thead", {}, element("tr", {}, ...["t", "event", "guide", "contact"].map((head) => element("th", { scope: "col" }, head)))),
    element("tbody", {}, ...events.map(line)));
  const folded = () => element("details", {}, element("summary", {}, `${count(events.length)} events`), table);
  document.getElementById("events").append(events.length > FOLDED ? folded() : table);
  document.getElementById("happened").hidden = events.length === 0;
}
