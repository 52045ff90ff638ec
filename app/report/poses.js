// Coordinates -> where every body is. The frames are those of the scene: origin at the joint, see kernel/slideway/scene.hpp.
"use strict";

const GROUND = { x: 0, y: 0, angle: 0, c: 1, s: 0 };
const coordinates = (joint) => ({ revolute: 1, prismatic: 1, planar: 3, fixed: 0 })[joint];

const turned = (pose, [x, y]) => [pose.c * x - pose.s * y, pose.s * x + pose.c * y];
const toWorld = (pose, point) => {
  const [x, y] = turned(pose, point);
  return [pose.x + x, pose.y + y];
};
const toBody = (pose, [x, y]) => {
  const [dx, dy] = [x - pose.x, y - pose.y];
  return [pose.c * dx + pose.s * dy, -pose.s * dx + pose.c * dy];
};
const poseOf = (poses, body) => (body < 0 ? GROUND : poses[body]);

/// Poses {x, y, angle, c, s} of all bodies, given their coordinates body by body.
function posesAt(bodies, q) {
  const poses = [];
  let next = 0;
  for (const body of bodies) {
    const own = q.slice(next, next + coordinates(body.joint));
    next += own.length;
    const parent = poseOf(poses, body.parent);
    let angle = parent.angle + body.angle;
    let [x, y] = toWorld(parent, body.at);
    const slide = { prismatic: [own[0], 0], planar: [own[0], own[1]] }[body.joint];
    if (slide) {
      const [dx, dy] = turned({ c: Math.cos(angle), s: Math.sin(angle) }, slide);
      x += dx;
      y += dy;
    }
    if (body.joint === "revolute") angle += own[0];
    if (body.joint === "planar") angle += own[2];
    poses.push({ x, y, angle, c: Math.cos(angle), s: Math.sin(angle) });
  }
  return poses;
}

/// How far along a guide's line a point of the slider is.
function along(guide, poses, contact) {
  const point = toBody(poseOf(poses, guide.rail), toWorld(poses[guide.slider], contact));
  return (point[0] - guide.origin[0]) * guide.tangent[0] + (point[1] - guide.origin[1]) * guide.tangent[1];
}
