// The mechanism to scale, as SVG, with its forces. Built for one width; each instant then moves what moves.
"use strict";

const HEAD = 9; // of an arrow, px

/// An arrow from (x, y) by (dx, dy), px. Shorter than a pixel and a half: nothing.
function arrow(x, y, dx, dy) {
  const length = Math.hypot(dx, dy);
  if (!(length > 1.5)) return "";
  const [ux, uy] = [dx / length, dy / length];
  const head = Math.min(HEAD, 0.6 * length);
  const [bx, by] = [x + dx - head * ux, y + dy - head * uy];
  const half = 0.45 * head;
  return `M${x},${y}L${bx},${by}M${x + dx},${y + dy}L${bx - half * uy},${by + half * ux}L${bx + half * uy},${by - half * ux}Z`;
}

/// An arc with a head around (x, y), px, that starts on the right and turns by `angle`, counter-clockwise for > 0. The arc
/// runs to its end and back, so that filling it fills the head alone.
function turnArrow(x, y, radius, angle) {
  if (!(Math.abs(angle) > 0.05)) return "";
  const at = (a, r) => `${x + r * Math.cos(a)},${y - r * Math.sin(a)}`;
  const sense = Math.sign(angle);
  const back = angle - sense * Math.min(HEAD / radius, 0.6 * Math.abs(angle));
  const wide = Math.abs(back) > Math.PI ? 1 : 0;
  const arc = (end, sweep) => `A${radius},${radius} 0 ${wide} ${sweep} ${at(end, radius)}`;
  const line = sense > 0 ? arc(back, 0) + arc(0, 1) : arc(back, 1) + arc(0, 0);
  const half = 0.45 * HEAD;
  return `M${at(0, radius)}${line}M${at(angle, radius)}L${at(back, radius - half)}L${at(back, radius + half)}Z`;
}

/// A spring of `turns` between two points, px.
function zigzag(x0, y0, x1, y1, turns, half) {
  const length = Math.hypot(x1 - x0, y1 - y0) || 1;
  const [ux, uy] = [(x1 - x0) / length, (y1 - y0) / length];
  const at = (s, w) => `L${x0 + s * length * ux - w * uy},${y0 + s * length * uy + w * ux}`;
  let d = `M${x0},${y0}${at(0.15, 0)}`;
  for (let i = 0; i < 2 * turns; ++i) d += at(0.15 + (0.7 * (i + 0.5)) / (2 * turns), i % 2 ? -half : half);
  return `${d}${at(0.85, 0)}L${x1},${y1}`;
}

/// Corners of the convex hull (Andrew's monotone chain).
function hull(points) {
  const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const turn = (o, a, b) => (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
  const chain = (list) => {
    const kept = [];
    for (const point of list) {
      while (kept.length > 1 && turn(kept[kept.length - 2], kept[kept.length - 1], point) <= 0) kept.pop();
      kept.push(point);
    }
    return kept.slice(0, -1);
  };
  return sorted.length < 3 ? sorted : [...chain(sorted), ...chain(sorted.reverse())];
}

class Mechanism {
  constructor(box, data) {
    this.box = box;
    this.scene = data.scene;
    this.samples = data.samples;
    this.start = this.scene.bodies.flatMap((body) => body.start);
    this.arrowFactor = 1;
    const every = Math.max(1, Math.floor(this.samples.t.length / 500));
    this.poses = [posesAt(this.scene.bodies, this.start)];
    for (let i = 0; i < this.samples.t.length; i += every) this.poses.push(this.posesAtSample(i));
    if (this.samples.t.length > 0) this.poses.shift();
    this.contacts = this.scene.guides.flatMap((guide, g) => guide.contacts.map((point) => ({ guide, g, point })));
    this.measure();
  }

  posesAtSample(i) {
    const q = this.samples.t.length > 0 ? this.samples.q.map((values) => values[i]) : this.start;
    return posesAt(this.scene.bodies, q);
  }

  /// The points that give each body its outline, how far each slider travels, and the box that holds all of it.
  measure() {
    const { bodies, guides, pins, springs } = this.scene;
    this.points = bodies.map((body) => [[0, 0], ...(body.mass > 0 ? [body.com] : [])]);
    this.groundPoints = [];
    const add = (body, point) => (body < 0 ? this.groundPoints : this.points[body]).push(point);
    for (const body of bodies) add(body.parent, body.at);
    for (const { a, a_at, b, b_at } of [...pins, ...springs]) {
      add(a, a_at);
      add(b, b_at);
    }
    for (const { guide, point } of this.contacts) add(guide.slider, point);

    const all = [...this.groundPoints];
    for (const poses of this.poses) this.points.forEach((points, i) => all.push(...points.map((p) => toWorld(poses[i], p))));
    const size = (points) => {
      const [xs, ys] = [points.map((p) => p[0]), points.map((p) => p[1])];
      const low = (v) => v.reduce((a, b) => Math.min(a, b), Infinity);
      const high = (v) => v.reduce((a, b) => Math.max(a, b), -Infinity);
      return { x0: low(xs), x1: high(xs), y0: low(ys), y1: high(ys) };
    };
    let extent = size(all);
    const length = Math.max(extent.x1 - extent.x0, extent.y1 - extent.y0) || 1;

    this.rails = guides.map((guide) => {
      const places = this.poses.flatMap((poses) => guide.contacts.map((contact) => along(guide, poses, contact)));
      const low = Math.min(...places) - 0.07 * length;
      const high = Math.max(...places) + 0.07 * length;
      return [low, high].map((s) => [guide.origin[0] + s * guide.tangent[0], guide.origin[1] + s * guide.tangent[1]]);
    });
    guides.forEach((guide, g) => {
      if (guide.rail >= 0) this.points[guide.rail].push(...this.rails[g]);
      for (const poses of this.poses) all.push(...this.rails[g].map((p) => toWorld(poseOf(poses, guide.rail), p)));
    });
    extent = size(all);
    const least = 0.1 * length;
    if (extent.x1 - extent.x0 < least) (extent.x0 -= least / 2), (extent.x1 += least / 2);
    if (extent.y1 - extent.y0 < least) (extent.y0 -= least / 2), (extent.y1 += least / 2);
    this.extent = extent;
  }

  /// N that an arrow as long as a quarter of the drawing shows: all but the highest hundredth of the forces are shorter.
  forceScale(columns) {
    const sizes = columns.flat().map((x) => Math.abs(x ?? 0)).filter((x) => x > 0).sort((a, b) => a - b);
    return sizes.length > 0 ? sizes[Math.floor(0.99 * (sizes.length - 1))] : 0;
  }

  draw() {
    const { bodies, guides, drives, loads, springs } = this.scene;
    const { x0, x1, y0, y1 } = this.extent;
    const width = Math.max(200, this.box.clientWidth);
    const most = Math.max(240, Math.min(0.95 * width, document.documentElement.classList.contains("printing") ? 420 : window.innerHeight - 330));
    const pad = 38;
    const height = Math.min(most, Math.max(0.45 * width, ((y1 - y0) / (x1 - x0)) * (width - 2 * pad) + 2 * pad));
    const scale = Math.min((width - 2 * pad) / (x1 - x0), (height - 2 * pad) / (y1 - y0));
    const left = width / 2 - (scale * (x0 + x1)) / 2;
    const top = height / 2 + (scale * (y0 + y1)) / 2;
    this.scale = scale;
    this.screen = ([x, y]) => [left + scale * x, top - scale * y];
    this.local = ([x, y]) => [scale * x, -scale * y];
    this.bold = bodies.length > 12 ? 0.65 : 1;

    const drives_N = drives.flatMap((drive, d) => (drive.unit === "N" ? [this.samples.drive[d]] : []));
    const typical = this.forceScale([...this.samples.lambda, ...drives_N, loads.map((load) => Math.hypot(...load.force))]);
    const friction = this.forceScale(this.samples.friction);
    const reference = typical || friction;
    this.perNewton = reference > 0 ? (this.arrowFactor * 0.25 * Math.min(width, height)) / reference : 0;
    const small = friction > 0 && friction < 0.12 * reference;
    this.frictionFactor = small ? niceBelow((0.4 * reference) / friction) : 1;
    this.torques = drives.map((drive, d) => largest(this.samples.drive[d]));

    const svg = shape("svg", { viewBox: `0 0 ${width} ${height}`, width, height, role: "img" });
    svg.setAttribute("aria-label", this.description());
    const layer = (name) => svg.appendChild(shape("g", { class: name }));
    this.drawPaths(layer("paths"));
    this.drawGround(layer("ground"));
    this.drawBodies(layer("bodies"));
    this.drawSliders(layer("sliders"));
    this.drawJoints(layer("joints"));
    const forces = layer("forces");
    const line = (kind) => forces.appendChild(shape("path", { class: kind }));
    this.springs = springs.map(() => line("spring"));
    this.jointSprings = this.scene.joint_springs.map(() => line("spring"));
    this.loads = loads.map(() => line("load"));
    this.drives = drives.map(() => line("drive"));
    this.friction = guides.map(() => line("friction"));
    this.lambda = this.contacts.map(() => line("contact"));
    this.drawNames(layer("names"));
    this.box.replaceChildren(svg);
  }

  description() {
    const many = (n, what) => (n > 0 ? [`${n} ${n > 1 ? (what === "body" ? "bodies" : `${what}s`) : what}`] : []);
    const { bodies, guides, drives, pins, springs, loads } = this.scene;
    const parts = [many(bodies.length, "body"), many(guides.length, "guide"), many(drives.length, "drive"),
      many(pins.length, "pin"), many(springs.length, "spring"), many(loads.length, "load")].flat();
    return `Drawing of ${this.scene.name} to scale: ${parts.join(", ")}.`;
  }

  drawPaths(layer) {
    const trace = (at) => {
      const d = this.poses.map((poses) => this.screen(at(poses)).map((x) => x.toFixed(1)).join()).join("L");
      layer.append(shape("path", { d: `M${d}` }));
    };
    for (const { guide, point } of this.contacts) trace((poses) => toWorld(poses[guide.slider], point));
    this.scene.bodies.forEach((body, i) => {
      if (body.parent >= 0) trace((poses) => [poses[i].x, poses[i].y]);
      if (body.parent < 0 && this.points[i].length < 3) trace((poses) => toWorld(poses[i], body.com));
    });
    for (const pin of this.scene.pins) trace((poses) => toWorld(poses[pin.a], pin.a_at));
  }

  /// Supports, rails of the ground, and the axes of prismatic joints on it.
  drawGround(layer) {
    const { bodies, pins, springs } = this.scene;
    const supports = new Map();
    const support = (point) => supports.set(this.screen(point).map(Math.round).join(), this.screen(point));
    for (const body of bodies) if (body.parent < 0 && ["revolute", "fixed"].includes(body.joint)) support(body.at);
    for (const { a, a_at, b, b_at } of [...pins, ...springs]) {
      if (a < 0) support(a_at);
      if (b < 0) support(b_at);
    }
    for (const rail of this.groundRails()) this.drawRail(layer, rail.map(this.screen), true);
    const k = this.bold;
    for (const [x, y] of supports.values()) {
      const hatch = [-14, -7, 0, 7].map((dx) => `M${dx},18l7,0m-7,6l6,-6`).join("");
      layer.append(shape("path", { class: "support", d: "M0,0L-10,18H10Z", transform: `translate(${x},${y}) scale(${k})` }),
        shape("path", { class: "hatch", d: hatch, transform: `translate(${x},${y}) scale(${k})` }));
    }
  }

  /// Rails on the ground; guides on one line share theirs.
  groundRails() {
    const lines = new Map();
    this.scene.guides.forEach((guide, g) => {
      if (guide.rail >= 0) return;
      const [tx, ty] = guide.tangent;
      const sense = tx < -1e-9 || (Math.abs(tx) <= 1e-9 && ty < 0) ? -1 : 1;
      const offset = sense * (tx * guide.origin[1] - ty * guide.origin[0]) * this.scale;
      const name = [(sense * tx).toFixed(4), (sense * ty).toFixed(4), Math.round(offset)].join();
      const place = ([x, y]) => sense * (tx * x + ty * y);
      const ends = [...(lines.get(name) ?? []), ...this.rails[g]].sort((a, b) => place(a) - place(b));
      lines.set(name, [ends[0], ends[ends.length - 1]]);
    });
    return lines.values();
  }

  /// A slot; one of the ground is hatched on both sides.
  drawRail(layer, [[xa, ya], [xb, yb]], grounded) {
    const length = Math.hypot(xb - xa, yb - ya);
    const group = shape("g", { transform: `translate(${xa},${ya}) rotate(${(Math.atan2(yb - ya, xb - xa) * 180) / Math.PI})` });
    const half = 5 * this.bold;
    if (grounded) {
      let d = "";
      for (let x = 3; x < length; x += 9) d += `M${x},${half}l-5,6M${x + 2},${-half}l5,-6`;
      group.append(shape("path", { class: "hatch", d }));
    }
    group.append(shape("rect", { class: "rail", x: 0, y: -half, width: length, height: 2 * half, rx: grounded ? 1 : half }));
    layer.append(group);
  }

  drawBodies(layer) {
    this.bodies = this.scene.bodies.map((body, i) => {
      const group = layer.appendChild(shape("g", { class: "body" }));
      const corners = hull(this.points[i].map(this.local));
      const reach = Math.max(...corners.map(([x, y]) => Math.hypot(x - corners[0][0], y - corners[0][1])));
      if (reach > 3) {
        const d = `M${corners.map((p) => p.map((x) => x.toFixed(2)).join()).join("L")}Z`;
        group.append(shape("path", { class: "edge", d, "stroke-width": 15 * this.bold }),
          shape("path", { class: "plate", d, "stroke-width": 12.4 * this.bold }));
      }
      this.scene.guides.forEach((guide, g) => {
        if (guide.rail === i) this.drawRail(group, this.rails[g].map(this.local), false);
      });
      if (body.mass > 0 && this.scene.bodies.length <= 12) {
        const [x, y] = this.local(body.com);
        const r = 5 * this.bold;
        group.append(shape("circle", { class: "com", cx: x, cy: y, r }),
          shape("path", { class: "com-quarters", d: `M${x},${y}v${-r}a${r},${r} 0 0 1 ${r},${r}zv${r}a${r},${r} 0 0 1 ${-r},${-r}z` }));
      }
      return group;
    });
  }

  drawSliders(layer) {
    const several = this.scene.guides.length > 1;
    this.sliders = this.scene.guides.map((guide, g) => {
      const ends = guide.contacts.map(this.local);
      const span = ends.length > 1 ? Math.hypot(ends[0][0] - ends[1][0], ends[0][1] - ends[1][1]) : 10 * this.bold;
      const [w, h] = [span + 14 * this.bold, 18 * this.bold];
      const group = layer.appendChild(shape("g", { class: "slider" }));
      group.append(shape("rect", { x: -w / 2, y: -h / 2, width: w, height: h, rx: 3 * this.bold }));
      if (several) group.firstChild.style.fill = `var(--s${g % SERIES_COLOURS})`;
      for (const x of ends.length > 1 ? [-span / 2, span / 2] : [0]) group.append(shape("circle", { cx: x, cy: 0, r: 2.6 * this.bold }));
      return group;
    });
  }

  drawJoints(layer) {
    const joint = () => layer.appendChild(shape("circle", { class: "joint", r: 4.2 * this.bold }));
    this.joints = this.scene.bodies.map((body) => (body.joint === "revolute" ? joint() : null));
    this.pins = this.scene.pins.map(joint);
    this.blocks = this.scene.bodies.map((body) =>
      body.joint !== "prismatic" ? null : layer.appendChild(shape("rect", { class: "prismatic", x: -8, y: -6, width: 16, height: 12, rx: 2 })));
  }

  drawNames(layer) {
    this.names = this.scene.bodies.map((body) => {
      const text = layer.appendChild(shape("text"));
      text.textContent = body.name;
      return text;
    });
  }

  /// What the arrows mean and how long they are: [{kind, label, d, width}], d a sample that is to scale.
  key() {
    const length = niceBelow(90 / this.scale);
    const bar = length * this.scale;
    const entries = [{ kind: "bar", d: `M1,3v10M1,8h${bar}M${1 + bar},3v10`, width: bar + 2, label: `${format(length)} m` }];
    const straight = (kind, what, factor, perNewton) => {
      const newtons = niceBelow(90 / perNewton);
      entries.push({ kind, d: arrow(1, 8, newtons * perNewton, 0), width: newtons * perNewton + 3,
        label: `${what}, ${format(newtons)} N${factor > 1 ? ` (drawn × ${format(factor)})` : ""}` });
    };
    const has = (columns) => this.perNewton > 0 && columns.some((values) => largest(values) > 0);
    if (has(this.samples.lambda)) straight("contact", "contact force", 1, this.perNewton);
    if (has(this.samples.friction)) straight("friction", "friction", this.frictionFactor, this.perNewton * this.frictionFactor);
    const { drives, loads } = this.scene;
    if (has(this.samples.drive.filter((_, d) => drives[d].unit === "N"))) straight("drive", "drive force", 1, this.perNewton);
    drives.forEach((drive, d) => {
      if (drive.unit === "N m" && this.torques[d] > 0 && entries.filter((entry) => entry.turn).length < 3) {
        entries.push({ kind: "drive", turn: true, d: turnArrow(9, 8, 6.5, 5), width: 18,
          label: `${drives.length > 1 ? `${drive.name}: ` : ""}drive torque, full turn ${format(this.torques[d], 3)} N m` });
      }
    });
    if (has([loads.map((load) => Math.hypot(...load.force))])) straight("load", "load", 1, this.perNewton);
    const g = Math.hypot(...this.scene.gravity);
    const [gx, gy] = this.scene.gravity.map((x) => (7 * x) / g);
    if (g > 0) entries.push({ kind: "bar", d: arrow(8 - gx, 8 + gy, 2 * gx, -2 * gy), width: 16, label: `gravity ${format(g)} m/s²` });
    return entries;
  }

  /// Moves everything to sample i.
  show(i) {
    const poses = this.posesAtSample(i);
    const { bodies, guides, pins, springs, joint_springs, drives, loads } = this.scene;
    const move = (node, [x, y], angle = 0) =>
      node?.setAttribute("transform", `translate(${x.toFixed(2)},${y.toFixed(2)}) rotate(${((-angle * 180) / Math.PI).toFixed(3)})`);
    const world = (body, point) => toWorld(poseOf(poses, body), point);

    bodies.forEach((body, b) => {
      const place = this.screen([poses[b].x, poses[b].y]);
      move(this.bodies[b], place, poses[b].angle);
      move(this.joints[b], place);
      move(this.blocks[b], place, poses[b].angle);
      const [x, y] = this.screen(world(b, body.com));
      move(this.names[b], [x + 10, y - 10]);
    });
    pins.forEach((pin, p) => move(this.pins[p], this.screen(world(pin.a, pin.a_at))));
    springs.forEach((spring, s) => {
      const ends = [...this.screen(world(spring.a, spring.a_at)), ...this.screen(world(spring.b, spring.b_at))];
      this.springs[s].setAttribute("d", zigzag(...ends, 6, 5));
    });
    joint_springs.forEach(({ body }, s) => {
      const [x, y] = this.screen([poses[body].x, poses[body].y]);
      const [x0, y0] = this.screen(world(bodies[body].parent, bodies[body].at));
      const slides = bodies[body].joint === "prismatic" && Math.hypot(x - x0, y - y0) > 4;
      this.jointSprings[s].setAttribute("d", slides ? zigzag(x0, y0, x, y, 6, 5) : `M${x - 9},${y}a9,9 0 1 1 9,9a6.5,6.5 0 1 1 6.5,-6.5`);
    });

    const force = (node, point, fx, fy, factor = 1) => {
      const k = this.perNewton * factor;
      node.setAttribute("d", arrow(...this.screen(point), k * fx, -k * fy));
    };
    let c = 0;
    guides.forEach((guide, g) => {
      const rail = poseOf(poses, guide.rail);
      const [tx, ty] = turned(rail, guide.tangent);
      const points = guide.contacts.map((contact) => world(guide.slider, contact));
      const middle = [0, 1].map((axis) => points.reduce((sum, point) => sum + point[axis], 0) / points.length);
      move(this.sliders[g], this.screen(middle), Math.atan2(ty, tx));
      if (this.samples.t.length === 0) return;
      for (const point of points) {
        const lambda = this.samples.lambda[c][i];
        force(this.lambda[c++], point, -ty * lambda, tx * lambda);
      }
      const friction = this.samples.friction[g][i];
      force(this.friction[g], middle, tx * friction, ty * friction, this.frictionFactor);
    });
    drives.forEach((drive, d) => {
      const value = this.samples.drive[d][i] ?? 0;
      const place = [poses[drive.body].x, poses[drive.body].y];
      if (drive.unit === "N m") {
        const angle = this.torques[d] > 0 ? (5.2 * value) / this.torques[d] : 0;
        this.drives[d].setAttribute("d", turnArrow(...this.screen(place), 17 * this.bold, angle));
      } else {
        const body = bodies[drive.body];
        const angle = poseOf(poses, body.parent).angle + body.angle + (drive.axis === 1 ? Math.PI / 2 : 0);
        force(this.drives[d], place, value * Math.cos(angle), value * Math.sin(angle));
      }
    });
    loads.forEach((load, l) => {
      const point = world(load.body, load.at);
      force(this.loads[l], point, ...load.force);
      if (load.torque !== 0) {
        const turn = turnArrow(...this.screen(point), 13 * this.bold, 4 * Math.sign(load.torque));
        this.loads[l].setAttribute("d", this.loads[l].getAttribute("d") + turn);
      }
    });
  }
}
