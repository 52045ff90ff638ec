// Puts the page together: one time for drawing, charts and slider.
"use strict";

const find = (id) => document.getElementById(id);
const data = JSON.parse(find("data").textContent);
const times = data.samples.t;
const last = Math.max(0, times.length - 1);
const clock = timeFormatter(times);
const mechanism = new Mechanism(find("drawing"), data);
const charts = times.length < 2 ? [] : [
  ...stripList(data).map((spec) => new Strip(spec, times, seekTime)),
  ...chartList(data).map((spec) => new Chart(spec, times, data.events, seekTime))];

const state = { index: 0, playing: false, turn: 0, speed: 1, zoom: 1 };

// --- time ------------------------------------------------------------------------------------------------------------

/// The sample nearest to t.
function indexAt(t) {
  let [low, high] = [0, last];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= t) low = middle;
    else high = middle;
  }
  return high > 0 && Math.abs(times[high] - t) < Math.abs(times[low] - t) ? high : low;
}

function seek(index) {
  state.index = index;
  const text = times.length > 0 ? clock(times[index]) : clock(0);
  const slider = find("time");
  slider.value = index;
  slider.setAttribute("aria-valuetext", text);
  find("clock").textContent = text;
  mechanism.show(index);
  followZoom();
  for (const chart of charts) chart.show(index);
}

function seekTime(t) {
  stop();
  seek(indexAt(t));
}

/// Nothing moves by itself: play is only ever started by the reader, so prefers-reduced-motion has nothing to stop; it
/// makes the play coarse instead, four pictures a second.
const calm = window.matchMedia("(prefers-reduced-motion: reduce)");

function play() {
  if (state.index === last) seek(0);
  const turn = ++state.turn;
  state.playing = true;
  find("play").textContent = "Pause";
  const [start, from] = [performance.now(), times[state.index]];
  let shown = start;
  const frame = (now) => {
    if (!state.playing || state.turn !== turn) return;
    const t = from + (Math.max(0, now - start) / 1000) * state.speed;
    if (t >= times[last]) {
      seek(last);
      stop();
      return;
    }
    if (!calm.matches || now - shown > 250) {
      seek(indexAt(t));
      shown = now;
    }
    requestAnimationFrame(frame);
  };
  requestAnimationFrame(frame);
}

function stop() {
  state.playing = false;
  find("play").textContent = "Play";
}

// --- the part of the run that the charts show ------------------------------------------------------------------------

function setWindow(low, high) {
  state.window = [low, high];
  for (const chart of charts) chart.restyle({ dateWindow: [low, high] });
}

/// Turns the page when the time leaves the window.
function followZoom() {
  if (charts.length === 0 || state.zoom === 1) return;
  const t = times[state.index];
  const [low, high] = state.window;
  if (t >= low && t <= high) return;
  const width = (times[last] - times[0]) / state.zoom;
  const begin = Math.min(times[last] - width, Math.max(times[0], t < low ? t - 0.9 * width : t - 0.1 * width));
  setWindow(begin, begin + width);
}

function zoom(factor) {
  state.zoom = factor;
  const width = (times[last] - times[0]) / factor;
  const begin = Math.min(times[last] - width, Math.max(times[0], times[state.index] - width / 2));
  setWindow(begin, begin + width);
  seek(state.index);
}

// --- controls --------------------------------------------------------------------------------------------------------

/// Speeds around the one that plays the run in some eight seconds; real time if that is between two and thirty.
function offerSpeeds() {
  const length = times[last] - times[0] || 1;
  const natural = length >= 2 && length <= 30 ? 1 : niceBelow(length / 8);
  for (const factor of [0.1, 0.25, 0.5, 1, 2, 5]) {
    const speed = natural * factor;
    const text = speed === 1 ? "real time" : `${format(speed, 2)} × real`;
    find("speed").append(new Option(text, speed, factor === 1, factor === 1));
  }
  state.speed = natural;
}

function writeKey() {
  const entries = mechanism.key().map(({ kind, d, width, label: text }) =>
    element("span", { class: "key-entry" }, shape("svg", { width, height: 16, "aria-hidden": "true" }, shape("path", { class: kind, d })), text));
  find("key").replaceChildren(...entries);
}

function redrawMechanism() {
  mechanism.draw();
  mechanism.show(state.index);
  writeKey();
}

function control() {
  find("play").addEventListener("click", () => (state.playing ? stop() : play()));
  find("time").max = last;
  find("time").addEventListener("input", (event) => {
    stop();
    seek(Number(event.target.value));
  });
  find("speed").addEventListener("change", (event) => {
    state.speed = Number(event.target.value);
    if (state.playing) play();
  });
  find("zoom").addEventListener("change", (event) => zoom(Number(event.target.value)));
  find("arrow-scale").addEventListener("change", (event) => {
    mechanism.arrowFactor = Number(event.target.value);
    redrawMechanism();
  });
  const showing = (id, shown) => {
    find(id).checked = shown;
    const apply = () => find("drawing").classList.toggle(id, find(id).checked);
    find(id).addEventListener("change", apply);
    apply();
  };
  showing("show-names", data.scene.bodies.length <= 8);
  showing("show-paths", true);
  if (times.length < 2) for (const id of ["transport", "speed", "zoom"]) (id === "transport" ? find(id) : find(id).parentNode).hidden = true;
}

// --- size, colours, paper --------------------------------------------------------------------------------------------

function fit() {
  for (const chart of charts) chart.resize();
  redrawMechanism();
  for (const chart of charts) chart.show(state.index);
}

function recolour() {
  for (const chart of charts) chart.restyle();
}

/// Paper: light, sharp, full width. 680 px are 180 mm.
function toPaper() {
  stop();
  document.documentElement.classList.add("printing");
  for (const chart of charts) {
    chart.restyle({ pixelRatio: 3 });
    chart.resize(680, chart.height);
  }
  redrawMechanism();
}

function fromPaper() {
  document.documentElement.classList.remove("printing");
  for (const chart of charts) {
    chart.plot.removeAttribute("style");
    chart.restyle({ pixelRatio: null });
  }
  fit();
}

// --- start -----------------------------------------------------------------------------------------------------------

/// What a test reads: everything that should be in the page is there and holds no NaN.
function inspect() {
  const drawing = find("drawing").innerHTML;
  if (data.scene.bodies.length > 0 && find("drawing").querySelectorAll("svg .body").length === 0) fail("the mechanism is not drawn");
  if (/NaN|Infinity|undefined/.test(drawing + find("tables").innerHTML)) fail("the mechanism or a table holds a value that is no number");
  for (const chart of charts) if (!chart.isDrawn()) fail(`the chart of ${chart.spec.id} is empty`);
  const root = document.documentElement;
  root.dataset.charts = charts.map((chart) => chart.spec.id).join(" ");
  root.dataset.ready ??= "ok";
}

function begin() {
  writeHeader(data);
  writeFigures(data);
  writeTables(data);
  find("charts").append(...charts.map((chart) => chart.node));
  document.querySelector(".plots").hidden = charts.length === 0;
  if (times.length > 1) offerSpeeds();
  control();
  for (const chart of charts) chart.draw();
  redrawMechanism();
  // Both ends, so that whatever can fail at some time fails here.
  seek(last);
  seek(0);
  let width = window.innerWidth;
  window.addEventListener("resize", () => {
    if (window.innerWidth !== width) fit();
    width = window.innerWidth;
  });
  window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", recolour);
  window.addEventListener("beforeprint", toPaper);
  window.addEventListener("afterprint", fromPaper);
  inspect();
}

begin();
