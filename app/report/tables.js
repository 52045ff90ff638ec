// What ran, in words and tables.
"use strict";

const UNIQUENESS = {
  certified: "certified: these contact forces are the only ones, proved for every load",
  single: "single: every other sign pattern is excluded",
  refuted: "refuted: a second set of contact forces is known",
  unproven: "unproven: neither proved nor refuted",
  motion_only: "motion_only: the motion is unique, the contact forces are a choice",
};

function duration(ns) {
  if (ns >= 1e6) return `${format(ns / 1e6, 3)} ms`;
  return ns >= 1e3 ? `${format(ns / 1e3, 3)} µs` : `${format(ns, 3)} ns`;
}

function writeHeader({ scene, run }) {
  const settings = scene.settings.length > 0 ? ` with ${scene.settings.join(", ")}` : "";
  document.getElementById("ran").textContent =
    `${count(run.steps)} step${run.steps === 1 ? "" : "s"} of ${format(run.dt)} s by ${run.method}${settings}, up to t = ${format(run.t, 6)} s`;
  const good = run.status === "ok";
  const verdict = document.getElementById("verdict");
  verdict.classList.add(good ? "good" : "bad");
  const short = run.t < run.duration * (1 - 1e-9);
  const message = good ? "Every step was made, and every check on it held." : run.message;
  verdict.append(element("strong", {}, good ? "ok" : `Refused: ${run.status}`), element("span", {}, message));
  if (!good) {
    const rest = short ? ` of the ${format(run.duration, 6)} s that were asked for` : "";
    verdict.append(element("span", { class: "aside" }, run.steps > 0
      ? `The last good step ended at t = ${format(run.t, 6)} s${rest}; drawing and charts go up to there.`
      : "No step was made; the drawing shows the start."));
  }
}

/// The five numbers to look at first.
function writeFigures({ run, energy }) {
  if (run.steps === 0) return;
  const figure = (name, value, unit) => element("div", {}, element("dt", {}, name), element("dd", {}, value, element("small", {}, ` ${unit}`)));
  const [time, timeUnit] = run.ns_per_step > 0 ? duration(run.ns_per_step).split(" ") : ["–", ""];
  document.getElementById("figures").append(
    figure("Largest drift", format(run.drift_position, 3), "m or rad"),
    figure("Energy miss", energy.in_play > 0 ? format(Math.abs(energy.miss) / energy.in_play, 3) : "–", "of that in play"),
    figure("Contact forces", run.uniqueness.replace("_", " "), ""),
    figure("Solves", String(run.solves_max), "at most"),
    figure("A step", time, timeUnit));
}

function table(title, rows, heads) {
  const body = element("tbody", {}, ...rows.map(([name, ...cells]) =>
    element("tr", {}, element("th", { scope: "row" }, name), ...cells.map((cell) => element("td", String(cell).length < 24 ? { class: "short" } : {}, cell)))));
  const node = element("table", {}, element("caption", {}, title));
  if (heads) node.append(element("thead", {}, element("tr", {}, ...heads.map((head) => element("th", { scope: "col" }, head)))));
  node.append(body);
  return node;
}

function peakRows({ scene, peaks }) {
  const contacts = scene.guides.flatMap((guide) => guide.contacts.map((_, k) => `λ ${guide.name}${guide.contacts.length > 1 ? `.${k}` : ""}`));
  const rows = [];
  const add = (kind, name, unit, peak) => peak && rows.push({ kind, size: Math.abs(peak[0] ?? 0), row: [name, `${format(peak[0], 6)} ${unit}`, `${format(peak[1], 5)} s`] });
  contacts.forEach((name, c) => add("lambda", name, "N", peaks.lambda[c]));
  scene.guides.forEach((guide, g) => add("friction", `friction ${guide.name}`, "N", peaks.friction[g]));
  scene.drives.forEach((drive, d) => add("drive", `drive ${drive.name}`, drive.unit, peaks.drive[d]));
  scene.pins.forEach((pin, p) => add("pin", `pin ${pin.name}`, "N", peaks.pin[p]));
  return rows;
}

function peakTable(data) {
  const heads = ["Largest", "value", "at t"];
  const rows = peakRows(data);
  if (rows.length <= 12) return [table("Peaks", rows.map(({ row }) => row), heads)];
  const kinds = ["lambda", "friction", "drive", "pin"];
  const top = kinds.flatMap((kind) => rows.filter((one) => one.kind === kind).sort((a, b) => b.size - a.size).slice(0, 3));
  const node = element("div", {}, table("Peaks, the three largest of each kind", top.map(({ row }) => row), heads));
  node.append(element("details", { class: "no-print" }, element("summary", {}, `All ${rows.length} peaks`), table("", rows.map(({ row }) => row), heads)));
  return [node];
}

function writeTables(data) {
  const { scene, run, energy } = data;
  const run_rows = [
    ["Scene", scene.name], ["Scene hash", scene.hash],
    ...(scene.settings.length > 0 ? [["Settings", scene.settings.join(", ")]] : []),
    ...(data.inputs.length > 0 ? [["Inputs", data.inputs.map(([name, value]) => `${name} = ${format(value)}`).join(", ")]] : []),
    ["Method", run.method], ["Step dt", `${format(run.dt, 9)} s`], ["Steps made", count(run.steps)],
    ["Time reached", `${format(run.t, 9)} s of ${format(run.duration, 9)} s`],
    ...(run.method === "moreau" ? [["θ", format(run.theta)]] : []),
    run.stabilise === "projection" ? ["Stabilised by", "projection"] : ["Baumgarte α, β", `${format(scene.alpha)} 1/s, ${format(scene.beta)} 1/s²`],
    ["Time a step", run.ns_per_step > 0 ? duration(run.ns_per_step) : "–"],
    ["slideway", data.version],
  ];
  const check_rows = [
    ["Status", run.status], ["Uniqueness", run.steps > 0 ? (UNIQUENESS[run.uniqueness] ?? run.uniqueness) : "–"],
    ["Largest drift", `${format(run.drift_position, 3)} m or rad`],
    ["Largest drift rate", `${format(run.drift_velocity, 3)} m/s or rad/s`],
    ["Largest residual", `${format(run.residual, 3)} × its rounding scale`],
    ["Solves per HLCP", `${run.solves_max} at most`],
    ["Unlocated events", count(run.unlocated_events)],
  ];
  const energy_rows = [
    ["Initial", `${format(energy.initial, 9)} J`], ["+ work of drives and loads", `${format(energy.work, 9)} J`],
    ["− dissipated by friction and dampers", `${format(energy.dissipated, 9)} J`],
    ["+ constraint work", `${format(energy.constraint_work, 9)} J`], ["Final", `${format(energy.final, 9)} J`],
    ["Miss", `${format(energy.miss, 3)} J`],
    ["Miss / energy in play", energy.in_play > 0 ? format(energy.miss / energy.in_play, 3) : "–"],
  ];
  const tables = document.getElementById("tables");
  tables.append(table("Run", run_rows), table("Checks", check_rows), table("Energy", energy_rows));
  if (peakRows(data).length > 0) tables.append(...peakTable(data));
}
