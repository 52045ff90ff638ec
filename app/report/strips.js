// Bands over time instead of curves: the mode of each guide with its events, and where the contact forces are not proved
// to be the only ones.
"use strict";

const ROW = 24; // px
const BLANK = "\u00a0"; // as the title of an axis: it keeps the place that the titles of the charts below take

/// How a band is drawn, from and to in parts of its row: place and height tell what colour tells.
const MODES = [
  { mode: 1, words: "slips +", colour: "--plus", from: 0.08, to: 0.5 },
  { mode: -1, words: "slips −", colour: "--minus", from: 0.5, to: 0.92 },
  { mode: 0, words: "rests", colour: "--rest", from: 0.38, to: 0.62 },
];
const CERTAINTIES = [
  { name: "certified", words: "certified", colour: "--certified", from: 0.8, to: 0.92 },
  { name: "single", words: "single", colour: "--single", from: 0.62, to: 0.92 },
  { name: "motion_only", words: "motion only", colour: "--motion-only", from: 0.44, to: 0.92 },
  { name: "unproven", words: "unproven", colour: "--unproven", from: 0.26, to: 0.92 },
  { name: "refuted", words: "refuted", colour: "--refuted", from: 0.08, to: 0.92 },
];

/// Marks, 9 px wide around (0, 0).
const MARKS = {
  slip_reversal: { words: "slip reversal", d: "M0,-4.5L4.5,0L0,4.5L-4.5,0Z" },
  stick: { words: "stick", d: "M-3.5,-3.5H3.5V3.5H-3.5Z" },
  slip: { words: "slip", d: "M-3.2,-4.5L4.6,0L-3.2,4.5Z" },
  normal_reversal: { words: "normal reversal", d: "M-4.5,-4.5L4.5,4.5M4.5,-4.5L-4.5,4.5" },
};

/// The strips there are: [{id, title, axis, rows: [{name, spans: [{from, to, look}], marks: [[t, kind]]}], looks, kinds, note}].
function stripList({ scene, samples, events, modes, uniqueness, run }) {
  const end = samples.t[samples.t.length - 1];
  const spans = (list, look) => list.map(([t, what], i) => ({ from: t, to: i + 1 < list.length ? list[i + 1][0] : end, look: look(what) }));
  const used = (looks, rows) => looks.filter((look) => rows.some((row) => row.spans.some((span) => span.look === look)));
  const strips = [];

  const guides = scene.guides.flatMap((guide, g) => (modes[g].length === 0 ? [] : [{
    name: guide.name,
    spans: spans(modes[g], (mode) => MODES.find((look) => look.mode === mode)),
    marks: events.filter(([, owner]) => owner === g).map(([t, , kind]) => [t, kind]),
  }]));
  if (guides.length > 0) {
    const kinds = Object.keys(MARKS).map((kind) => [kind, events.filter((event) => event[2] === kind).length]).filter(([, n]) => n > 0);
    const left = run.events_left_out > 0 ? `; ${count(run.events_left_out)} later ones are not marked` : "";
    const note = kinds.length === 0 ? "No events." : `Marks are at ${run.located ? "the located times of events" : "the ends of the steps in which events fell"}${left}.`;
    strips.push({ id: "modes", title: "Modes", axis: BLANK, rows: guides, looks: used(MODES, guides), kinds, note });
  }

  const sets = [{ name: "forces", spans: spans(uniqueness, (name) => CERTAINTIES.find((look) => look.name === name)), marks: [] }];
  const looks = used(CERTAINTIES, sets);
  if (looks.some(({ name }) => name !== "certified")) {
    const note = looks.filter(({ name }) => name !== "certified").map(({ name }) => `${UNIQUENESS[name]}.`).join(" ");
    strips.push({ id: "uniqueness", title: "Uniqueness of the contact forces", axis: BLANK, rows: sets, looks, kinds: [], note });
  }
  return strips;
}

/// "slips + 62 %, rests 38 %": the parts of the time.
function shares({ spans }, looks) {
  const whole = spans[spans.length - 1].to - spans[0].from;
  const part = (look) => spans.reduce((sum, span) => sum + (span.look === look ? span.to - span.from : 0), 0) / whole;
  return looks.map((look) => [look.words, 100 * part(look)]).filter(([, percent]) => percent > 0)
    .map(([words, percent]) => `${words} ${percent < 0.1 ? "< 0.1" : format(percent, 3)} %`).join(", ");
}

class Strip extends Chart {
  constructor(spec, times, seek) {
    // A chart needs a curve: one without values.
    super({ ...spec, series: [{ name: "", values: times.map(() => null), colour: "--ink", dash: 0 }] }, times, [], seek);
    this.height = spec.rows.length * ROW + 36; // the time axis below
    this.node.classList.add("strip");
    this.node.querySelector(".plot").style.height = `${this.height}px`;
    this.node.append(this.summary());
  }

  sentences() {
    return this.spec.rows.map((row) => `${row.name}: ${shares(row, this.spec.looks)}`);
  }

  description() {
    const { title, kinds, note } = this.spec;
    const events = kinds.map(([kind, n]) => `${n} × ${MARKS[kind].words}`).join(", ");
    return `${title} over time. ${this.sentences().join("; ")}.${events ? ` Events: ${events}.` : ""} ${note}`;
  }

  legend() {
    const entry = (sign, words) =>
      element("span", { class: "entry" }, shape("svg", { width: 18, height: 14, "aria-hidden": "true" }, sign), words);
    const looks = this.spec.looks.map(({ colour, from, to, words }) => {
      const sign = shape("rect", { x: 0, y: 14 * from, width: 18, height: 14 * (to - from) });
      sign.style.fill = `var(${colour})`;
      return entry(sign, words);
    });
    const marks = this.spec.kinds.map(([kind, n]) =>
      entry(shape("path", { class: `mark ${kind}`, d: MARKS[kind].d, transform: "translate(9,7)" }), `${MARKS[kind].words}, ${count(n)}`));
    return element("div", { class: "legend" }, ...looks, ...marks);
  }

  /// In words, below: for many guides, only when asked for.
  summary() {
    const lines = this.sentences().map((sentence) => element("span", {}, sentence));
    const note = element("span", {}, this.spec.note);
    if (lines.length <= MANY) return element("p", { class: "shares" }, ...lines, note);
    return element("div", { class: "shares" }, note,
      element("details", { class: "more" }, element("summary", {}, `Parts of the time of ${lines.length} guides`), element("p", { class: "shares" }, ...lines)));
  }

  valueRange() {
    return [0, this.spec.rows.length];
  }

  ticker() {
    const { rows } = this.spec;
    const short = (name) => (name.length > 11 ? `${name.slice(0, 4)}…${name.slice(-5)}` : name);
    return () => rows.map(({ name }, r) => ({ v: rows.length - r - 0.5, label: short(name) }));
  }

  options() {
    return { ...super.options(), drawGrid: false, yRangePad: 0 };
  }

  drawUnder(context, area, graph) {
    const { tint } = this.colours();
    const [low, high] = graph.xAxisRange();
    const x = (t) => graph.toDomXCoord(t);
    const tall = area.h / this.spec.rows.length;
    context.save();
    context.beginPath();
    context.rect(area.x, area.y, area.w, area.h);
    context.clip();
    this.spec.rows.forEach(({ spans, marks }, r) => {
      const top = area.y + r * tall;
      context.fillStyle = tint("--grid");
      context.fillRect(area.x, top + tall / 2 - 0.5, area.w, 1);
      for (const look of this.spec.looks) {
        context.fillStyle = tint(look.colour);
        for (const { from, to, look: its } of spans) {
          if (its !== look || to < low || from > high) continue;
          // Never so short that it would not be seen.
          context.fillRect(x(from), top + look.from * tall, Math.max(2, x(to) - x(from)), (look.to - look.from) * tall);
        }
      }
      this.drawMarks(context, marks.filter(([t]) => t >= low && t <= high), x, top + tall / 2, tint);
    });
    context.restore();
  }

  /// Marks of one kind that would lie on each other are drawn once; the legend counts all. What the whole guide does lies
  /// on top.
  drawMarks(context, marks, x, y, tint) {
    const last = {};
    context.lineJoin = "round";
    const ofContact = ([, kind]) => kind === "normal_reversal";
    for (const [t, kind] of [...marks.filter(ofContact), ...marks.filter((mark) => !ofContact(mark))]) {
      const at = x(t);
      if (at - last[kind] < 6) continue;
      last[kind] = at;
      const path = new Path2D();
      path.addPath(new Path2D(MARKS[kind].d), new DOMMatrix([1, 0, 0, 1, at, y]));
      context.strokeStyle = tint("--paper");
      context.lineWidth = kind === "normal_reversal" ? 5 : 3;
      context.stroke(path);
      context.strokeStyle = context.fillStyle = tint("--ink");
      context.lineWidth = 2;
      if (kind === "normal_reversal") context.stroke(path);
      else context.fill(path);
    }
  }

  show(i) {
    this.moveCursor(i);
  }

  /// Whether the longest band of each row is there.
  isDrawn() {
    const { rows } = this.spec;
    const area = this.graph.getArea();
    return rows.every(({ spans }, r) => {
      const { from, to, look } = spans.reduce((a, b) => (b.to - b.from > a.to - a.from ? b : a));
      const x = this.graph.toDomXCoord((from + to) / 2);
      const y = area.y + ((r + 0.8 * look.from + 0.2 * look.to) * area.h) / rows.length; // off the row's middle line
      return [...this.plot.querySelectorAll("canvas")].some((canvas) => {
        const ratio = canvas.width / canvas.clientWidth;
        return canvas.getContext("2d").getImageData(Math.floor(x * ratio), Math.floor(y * ratio), 1, 1).data[3] > 128;
      });
    });
  }
}
