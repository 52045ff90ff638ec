// Puts the page of a verification together: tables, and a chart of the error of each quantity over the run.
"use strict";

const find = (id) => document.getElementById(id);
const data = JSON.parse(find("data").textContent);
const { document: found, curves } = data;
const times = curves.t;
const clock = timeFormatter(times);

/// Error and bound on a log scale. Below a hundredth of the largest value's rounding an error is a chance crossing of zero.
class ErrorChart extends Chart {
  decades() {
    const known = this.spec.series.flatMap(({ values }) => values.filter((x) => x > 0));
    const [low, high] = [known.reduce((a, b) => Math.min(a, b)), known.reduce((a, b) => Math.max(a, b))];
    return [Math.min(Math.max(low, 1e-18 * this.spec.scale), high) / 2, 2 * high];
  }
}

/// Quantities of the last group that have a curve.
function curvesOf({ checks }) {
  return checks.map((check, k) => ({ check, values: times.map((_, i) => curves.errors[k][i] ?? null) }))
    .filter(({ values }) => values.some((x) => x !== null));
}

function chartOf({ check, values }, k) {
  const { quantity, unit, bound, held } = check;
  const series = [{ name: "error", values, colour: held ? "--s0" : "--bad", dash: 0 }];
  if (bound > 0) series.push({ name: "bound", values: times.map(() => bound), colour: "--ink", dash: 1 });
  const spec = { id: `error-${k}`, title: quantity, axis: `error, ${unit.replace(", ", " or ")}`, scale: check.scale, log: true, series };
  const chart = new ErrorChart(spec, times, found.oracle.events.map(({ t }) => [t]), seekTime);
  if (!held) chart.node.querySelector("h3").append(flag());
  return chart;
}

const compared = found.groups.length > 0 && times.length > 1 ? curvesOf(found.groups[found.groups.length - 1]) : [];
const drawable = ({ values }) => values.some((x) => x > 0);
const charts = compared.filter(drawable).map(chartOf);

// --- time ------------------------------------------------------------------------------------------------------------

function seek(index) {
  const slider = find("time");
  slider.value = index;
  slider.setAttribute("aria-valuetext", clock(times[index]));
  find("clock").textContent = clock(times[index]);
  for (const chart of charts) chart.show(index);
}

function seekTime(t) {
  seek(times.reduce((best, time, i) => (Math.abs(time - t) < Math.abs(times[best] - t) ? i : best), 0));
}

function writeReading() {
  const { events } = found.oracle;
  const lines = events.length === 0 || events.length > 100 ? "" : " Thin upright lines are the oracle’s events; forces, which jump there, are left out beside them.";
  find("reading").textContent = `Largest error of each kind at samples of the run, on a log scale; the dashed line is its bound.${lines} Press or drag in a chart to move the time.`;
  const zero = compared.filter((one) => !drawable(one)).map(({ check }) => check.quantity);
  find("zeros").textContent = `Zero at every sample: ${zero.join(", ")}.`;
  find("zeros").hidden = zero.length === 0;
  find("over-time").hidden = compared.length === 0;
  find("time").max = Math.max(0, times.length - 1);
  find("time").addEventListener("input", (event) => seek(Number(event.target.value)));
}

// --- size, colours, paper --------------------------------------------------------------------------------------------

function fit() {
  for (const chart of charts) chart.resize();
  seek(Number(find("time").value));
}

/// Paper: light, sharp, two charts side by side. 330 px are 87 mm.
function toPaper() {
  document.documentElement.classList.add("printing");
  for (const chart of charts) {
    chart.restyle({ pixelRatio: 3 });
    chart.resize(330, 165);
  }
}

function fromPaper() {
  document.documentElement.classList.remove("printing");
  for (const chart of charts) {
    chart.plot.removeAttribute("style");
    chart.restyle({ pixelRatio: null });
  }
  fit();
}

function listen() {
  let width = window.innerWidth;
  window.addEventListener("resize", () => {
    if (window.innerWidth !== width) fit();
    width = window.innerWidth;
  });
  window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => charts.forEach((chart) => chart.restyle()));
  window.addEventListener("beforeprint", toPaper);
  window.addEventListener("afterprint", fromPaper);
}

// --- start -----------------------------------------------------------------------------------------------------------

/// What a test reads: everything that should be in the page is there and holds no NaN.
function inspect() {
  if (/NaN|Infinity|undefined/.test(document.querySelector("header").innerHTML + document.querySelector("main").innerHTML)) fail("the page holds a value that is no number");
  for (const chart of charts) if (!chart.isDrawn()) fail(`the chart of ${chart.spec.title} is empty`);
  const root = document.documentElement;
  root.dataset.charts = charts.map((chart) => chart.spec.title).join(", ");
  root.dataset.ready ??= "ok";
}

function begin() {
  const settings = found.settings ? ` with ${found.settings.join(", ")}` : "";
  find("ran").textContent = `${count(found.steps)} step${found.steps === 1 ? "" : "s"} of ${format(found.dt)} s by ${found.method}${settings}, beside the oracle`;
  find("version").textContent = `slideway ${found.version}, scene ${found.hash}.`;
  writeVerdict(data);
  writeFigures(data);
  writeGroups(found);
  writeUnchecked(found);
  writeEvents(found);
  writeReading();
  find("charts").append(...charts.map((chart) => chart.node));
  for (const chart of charts) chart.draw();
  if (charts.length > 0) seek(times.length - 1);
  find("time").parentNode.hidden = charts.length === 0;
  listen();
  inspect();
}

begin();
