// Quantities over time, drawn by dygraphs. A chart has a legend of its own, whose entries are buttons with the value at
// the cursor.
"use strict";

const SERIES_COLOURS = 8; // --s0 .. --s7 in report.css
const MANY = 8; // from more curves than this, only the largest LEADERS are coloured
const LEADERS = 6;
const DASHES = [null, [7, 3], [2, 3], [9, 3, 2, 3]];

/// What there is to plot: [{id, title, axis, series: [{name, values, colour, dash}], log}]. Nothing that is not in the scene.
function chartList({ scene, samples }) {
  const { guides, drives, pins } = scene;
  const one = guides.length === 1;
  const colour = (g, alone) => (one ? alone : `--s${g % SERIES_COLOURS}`);
  const dash = (g) => Math.floor(g / SERIES_COLOURS) % DASHES.length;
  const perGuide = (columns, alone) =>
    guides.map((guide, g) => ({ name: guide.name, values: columns[g], colour: colour(g, alone), dash: dash(g) }));
  const perContact = guides.flatMap((guide, g) => guide.contacts.map((_, k) => ({
    name: guide.contacts.length > 1 ? `${guide.name}.${k}` : guide.name, colour: colour(g, "--contact"), dash: 2 * dash(g) + k })));
  perContact.forEach((series, c) => (series.values = samples.lambda[c]));
  const perDrive = (unit) => drives.flatMap((drive, d) => (drive.unit !== unit ? [] :
    [{ name: drive.name, values: samples.drive[d], colour: drives.length > 1 ? `--s${d % SERIES_COLOURS}` : "--drive", dash: dash(d) }]));
  const magnitude = (values) => values.map((x) => (x === null ? null : Math.abs(x)));
  const single = (name, values, tint) => [{ name, values, colour: tint, dash: 0 }];

  const list = [
    { id: "slip", title: "Sliding speed", axis: "sliding speed, m/s", series: perGuide(samples.slip, "--ink") },
    { id: "lambda", title: "Contact forces", axis: "contact force λ, N", series: perContact },
    { id: "friction", title: "Friction", axis: "friction, N", series: perGuide(samples.friction, "--friction") },
    { id: "torque", title: "Drive torque", axis: "drive torque, N m", series: perDrive("N m") },
    { id: "force", title: "Drive force", axis: "drive force, N", series: perDrive("N") },
    { id: "pin", title: "Pin forces, magnitude", axis: "pin force, N",
      series: pins.map((pin, p) => ({ name: pin.name, values: samples.pin[p], colour: `--s${p % SERIES_COLOURS}`, dash: dash(p) })) },
    { id: "energy", title: "Energy balance", axis: "energy, J", series: [
      { name: "energy − initial", values: samples.energy, colour: "--ink", dash: 0 },
      { name: "work", values: samples.work, colour: "--drive", dash: 0 },
      { name: "dissipated", values: samples.dissipated, colour: "--friction", dash: 0 },
      { name: "constraint work", values: samples.constraint_work, colour: "--load", dash: 1 }] },
    { id: "miss", title: "What the energy balance misses", axis: "|miss|, J", log: true,
      series: single("|energy − initial − work + dissipated − constraint work|", magnitude(samples.miss), "--ink") },
    { id: "drift", title: "Drift", axis: "drift, m or rad", log: true,
      series: single("largest |Φ|, |φ|", magnitude(samples.drift), "--ink") },
  ];
  return list.filter(({ log, series }) => series.some(({ values }) => values.some((x) => x !== null && !(log && x === 0))));
}

/// Values of one size, all with the decimals that give the largest four digits.
function valueFormatter(peak) {
  const decimals = 3 - Math.floor(Math.log10(peak || 1));
  if (decimals < 0 || decimals > 6) return (x) => format(x);
  return (x) => (x === null ? "–" : x.toFixed(decimals).replace(/^-(?=0\.?0*$)/, "").replace("-", "−"));
}

const label = (v, span) => (Math.abs(v) < 1e-9 * span ? "0" : format(v, 6));
const linearTicks = (a, b, pixels, option, graph, values) =>
  Dygraph.numericTicks(a, b, pixels, option, graph, values).map(({ v }) => ({ v, label: label(v, Math.abs(b - a)) }));

/// Decades, as many as there is room for.
function decadeTicks(a, b, pixels, option, graph, values) {
  const [low, high] = [Math.ceil(Math.log10(a) - 1e-9), Math.floor(Math.log10(b) + 1e-9)];
  if (high - low < 1) return linearTicks(a, b, pixels, (name) => (name === "logscale" ? false : option(name)), graph, values);
  const step = Math.max(1, Math.ceil(((high - low + 1) * option("pixelsPerLabel")) / pixels));
  const ticks = [];
  for (let n = low; n <= high; n += step) ticks.push({ v: 10 ** n, label: n === 0 ? "1" : `10${superscript(n)}` });
  return ticks;
}

class Chart {
  constructor(spec, times, events, seek) {
    this.spec = spec;
    this.times = times;
    this.events = events.length <= 100 ? events : [];
    this.height = 190; // as in report.css
    this.many = spec.series.length > MANY;
    for (const series of spec.series) {
      series.peak = largest(series.values);
      series.format = spec.log ? format : valueFormatter(series.peak);
    }
    const leaders = [...spec.series].sort((a, b) => b.peak - a.peak).slice(0, LEADERS);
    for (const series of spec.series) series.on = !this.many || leaders.includes(series);
    // Those drawn last lie on top: the leaders.
    this.order = this.many ? [...spec.series].sort((a, b) => a.peak - b.peak) : spec.series;

    this.plot = element("div", { class: "graph", role: "img", "aria-label": this.description() });
    this.cursor = element("div", { class: "cursor no-print" });
    const frame = element("div", { class: "plot" }, this.plot, this.cursor);
    this.node = element("figure", { class: "chart", id: `chart-${spec.id}` },
      element("figcaption", {}, element("h3", {}, spec.title), this.legend()), frame);
    this.listen(frame, seek);
  }

  description() {
    const range = ({ name, values }) => {
      const known = values.filter((x) => x !== null);
      return `${name} from ${format(known.reduce((a, b) => Math.min(a, b)))} to ${format(known.reduce((a, b) => Math.max(a, b)))}`;
    };
    const shown = this.spec.series.filter(({ values }) => values.some((x) => x !== null)).slice(0, MANY);
    return `${this.spec.title} over time, ${this.spec.axis.split(", ").pop()}: ${shown.map(range).join("; ")}.`;
  }

  legend() {
    const entry = (series) => {
      const line = shape("line", { x1: 1, y1: 5, x2: 23, y2: 5, "stroke-dasharray": (DASHES[series.dash % DASHES.length] ?? []).join(" ") });
      line.style.stroke = `var(${series.colour})`;
      const swatch = shape("svg", { width: 24, height: 10, "aria-hidden": "true" }, line);
      series.value = element("span", { class: "value" });
      const content = [swatch, element("span", { class: "name" }, series.name), series.value];
      if (this.spec.series.length === 1) return element("span", { class: "entry" }, ...content);
      const button = element("button", { class: "entry", type: "button", "aria-pressed": String(series.on) }, ...content);
      button.addEventListener("click", () => {
        series.on = !series.on;
        button.setAttribute("aria-pressed", String(series.on));
        this.restyle();
      });
      return button;
    };
    const box = element("div", { class: "legend" });
    box.append(...this.spec.series.filter((series) => series.on).map(entry));
    const rest = this.spec.series.filter((series) => !series.on);
    if (rest.length > 0) {
      box.append(element("details", { class: "more" }, element("summary", {}, `${rest.length} smaller, in grey`),
        element("div", { class: "legend" }, ...rest.map(entry))));
    }
    return box;
  }

  colours() {
    const style = getComputedStyle(document.documentElement);
    const tint = (name) => style.getPropertyValue(name).trim();
    return { tint, series: this.order.map((series) => tint(this.many && !series.on ? "--faint" : series.colour)) };
  }

  options() {
    const { tint, series } = this.colours();
    const styles = {};
    this.order.forEach((one, i) => {
      const muted = this.many && !one.on;
      styles[`${i}`] = { strokePattern: muted ? null : DASHES[one.dash % DASHES.length], strokeWidth: muted ? 1 : 1.7 };
    });
    return { colors: series, series: styles, gridLineColor: tint("--grid"), axisLineColor: tint("--axis"),
      visibility: this.order.map((one) => this.many || one.on) };
  }

  draw() {
    const { log } = this.spec;
    const point = (x) => (log && x === 0 ? null : x); // zero has no place on a log scale
    const rows = this.times.map((t, i) => [t, ...this.order.map(({ values }) => point(values[i]))]);
    this.graph = new Dygraph(this.plot, rows, {
      labels: ["t", ...this.order.map((_, i) => `${i}`)],
      legend: "never", interactionModel: {}, showLabelsOnHighlight: false, highlightCircleSize: 0,
      xlabel: "t, s", ylabel: this.spec.axis, xLabelHeight: 15, yLabelWidth: 15, axisLabelFontSize: 12, rightGap: 14,
      logscale: Boolean(log), includeZero: !log, yRangePad: 6, xRangePad: 0, gridLineWidth: 1, axisLineWidth: 1,
      valueRange: this.valueRange(),
      underlayCallback: (context, area, graph) => this.drawUnder(context, area, graph),
      axes: {
        x: { ticker: linearTicks, pixelsPerLabel: 64, axisLabelWidth: 64, axisTickSize: 4 },
        y: { ticker: this.ticker(), pixelsPerLabel: 26, axisLabelWidth: 66, axisTickSize: 4 },
      },
      ...this.options(),
    });
  }

  valueRange() {
    return this.spec.log ? this.decades() : null;
  }

  ticker() {
    return this.spec.log ? decadeTicks : linearTicks;
  }

  /// What a log chart shows: seven decades at most below the largest value. A zero crossing would take the rest.
  decades() {
    const known = this.spec.series.flatMap(({ values }) => values.filter((x) => x > 0));
    const [low, high] = [known.reduce((a, b) => Math.min(a, b)), known.reduce((a, b) => Math.max(a, b))];
    return [Math.max(low, 1e-7 * high) / 1.5, 1.5 * high];
  }

  /// Events as thin lines; zero as a firm one.
  drawUnder(context, area, graph) {
    const { tint } = this.colours();
    const line = (x0, y0, x1, y1) => {
      context.beginPath();
      context.moveTo(x0, y0);
      context.lineTo(x1, y1);
      context.stroke();
    };
    context.save();
    context.beginPath();
    context.rect(area.x, area.y, area.w, area.h);
    context.clip();
    context.lineWidth = 1;
    context.strokeStyle = tint("--event");
    for (const [t] of this.events) line(graph.toDomXCoord(t), area.y, graph.toDomXCoord(t), area.y + area.h);
    if (!this.spec.log) {
      context.strokeStyle = tint("--axis");
      line(area.x, graph.toDomYCoord(0), area.x + area.w, graph.toDomYCoord(0));
    }
    context.restore();
  }

  restyle(more = {}) {
    this.graph.updateOptions({ ...this.options(), ...more });
  }

  resize(width, height) {
    this.graph.resize(width, height);
  }

  /// Press or drag sets the time; a finger that moves up or down still scrolls the page.
  listen(frame, seek) {
    const at = (event) => seek(this.graph.toDataXCoord(event.clientX - this.plot.getBoundingClientRect().left));
    frame.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      frame.setPointerCapture(event.pointerId);
      at(event);
    });
    frame.addEventListener("pointermove", (event) => frame.hasPointerCapture(event.pointerId) && at(event));
  }

  show(i) {
    this.moveCursor(i);
    for (const series of this.spec.series) series.value.textContent = series.format(series.values[i]);
  }

  moveCursor(i) {
    const t = this.times[i];
    const [low, high] = this.graph.xAxisRange();
    const x = this.graph.toDomXCoord(t);
    this.cursor.style.transform = `translateX(${x.toFixed(1)}px)`;
    this.cursor.hidden = t < low || t > high;
  }

  /// Whether curves are really there: some drawn pixels in the canvas that dygraphs draws them into.
  isDrawn() {
    return [...this.plot.querySelectorAll("canvas")].some((canvas) => {
      if (canvas.width === 0 || canvas.height === 0) return false;
      const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
      let painted = 0;
      for (let k = 3; k < data.length; k += 4) painted += data[k] > 128;
      return painted > 100;
    });
  }
}
