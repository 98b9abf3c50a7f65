// Where frames are: what /tf and /tf_static say last, and the arithmetic of poses.

import { element } from "./dom.js";

const MAX_FRAMES = 2000;
const MAX_DEPTH = 100; // frames in a chain: a circle ends there
const TREE_MS = 500;

/** A pose is a translation t in metres and a quaternion q (x, y, z, w). */
export const IDENTITY = { t: [0, 0, 0], q: [0, 0, 0, 1] };

export function rotated([x, y, z, w], [a, b, c]) {
  const u = 2 * (y * c - z * b), v = 2 * (z * a - x * c), s = 2 * (x * b - y * a);
  return [a + w * u + y * s - z * v, b + w * v + z * u - x * s, c + w * s + x * v - y * u];
}

/** Return the pose `inner`, which is given in `outer`, in the frame of `outer`. */
export function composed(outer, inner) {
  const t = rotated(outer.q, inner.t).map((each, axis) => each + outer.t[axis]);
  const [x, y, z, w] = outer.q, [a, b, c, d] = inner.q;
  return { t, q: [
    w * a + x * d + y * c - z * b, w * b - x * c + y * d + z * a,
    w * c + x * b - y * a + z * d, w * d - x * a - y * b - z * c] };
}

export function inverse({ t, q: [x, y, z, w] }) {
  const q = [-x, -y, -z, w];
  return { t: rotated(q, t).map((each) => -each), q };
}

/** Return the 4 × 4 matrix of a pose, column by column as WebGL has it. */
export function matrix({ t, q }) {
  const columns = [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map((axis) => rotated(q, axis));
  return new Float32Array([...columns[0], 0, ...columns[1], 0, ...columns[2], 0, ...t, 1]);
}

export function applied(m, x, y, z) {
  return [
    m[0] * x + m[4] * y + m[8] * z + m[12], m[1] * x + m[5] * y + m[9] * z + m[13],
    m[2] * x + m[6] * y + m[10] * z + m[14]];
}

export function heading({ q: [x, y, z, w] }) {
  return Math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z));
}

export function facing(yaw) {
  return [0, 0, Math.sin(yaw / 2), Math.cos(yaw / 2)];
}

/** Return a quaternion of roll, pitch and yaw, as URDF has them. */
export function ofAngles([roll, pitch, yaw]) {
  const about = (axis, angle) => {
    const q = [0, 0, 0, Math.cos(angle / 2)];
    q[axis] = Math.sin(angle / 2);
    return { t: [0, 0, 0], q };
  };
  return composed(composed(about(2, yaw), about(1, pitch)), about(0, roll)).q;
}

/** Return the pose of a Pose or a Transform; null if it has a number that is not finite. */
export function poseOf(message) {
  const { x, y, z } = message.position ?? message.translation;
  const given = message.orientation ?? message.rotation;
  const length = Math.hypot(given.x, given.y, given.z, given.w);
  const pose = length
    ? { t: [x, y, z], q: [given.x / length, given.y / length, given.z / length, given.w / length] }
    : { t: [x, y, z], q: [0, 0, 0, 1] }; // a message that nobody has filled in
  return [...pose.t, ...pose.q].every(Number.isFinite) ? pose : null;
}

export function frameOf(name) {
  return name.replace(/^\//, "");
}

/** The frames of the robot. It listens only while somebody uses it: a robot publishes many transforms. */
export class Transforms extends EventTarget {
  constructor(robot) {
    super();
    this.robot = robot;
    this.parents = new Map();
    this.uses = 0;
  }

  /** Listen until the function that this returns is called. */
  use() {
    if (!this.uses++) {
      this.ends = [["/tf", false], ["/tf_static", true]].map(([topic, isStatic]) => this.robot.subscribe(
        topic, (message) => message && this.read(message, isStatic), { type: "tf2_msgs/msg/TFMessage" }));
    }
    let isOver = false;
    return () => {
      if (isOver) return;
      isOver = true;
      if (--this.uses) return;
      this.ends.forEach((end) => end());
      this.parents.clear(); // what is old by the next use
    };
  }

  read({ transforms }, isStatic) {
    for (const { header, child_frame_id, transform } of transforms) {
      const child = frameOf(child_frame_id), parent = frameOf(header.frame_id), pose = poseOf(transform);
      if (!pose || !child || !parent) continue;
      if (!this.parents.has(child) && this.parents.size >= MAX_FRAMES) continue;
      this.parents.set(child, { parent, pose, isStatic, heardMs: performance.now() });
    }
    this.dispatchEvent(new Event("change"));
  }

  get frames() {
    const names = new Set(this.parents.keys());
    for (const { parent } of this.parents.values()) names.add(parent);
    return [...names].sort();
  }

  /** Return the outermost frame around one, with the pose in it. */
  root(frame) {
    let pose = IDENTITY;
    for (let deep = 0; deep < MAX_DEPTH && this.parents.has(frame); deep++) {
      const edge = this.parents.get(frame);
      pose = composed(edge.pose, pose);
      frame = edge.parent;
    }
    return { frame, pose };
  }

  /** Return the pose of a frame in another one; null if nothing connects them. */
  pose(fixed, frame) {
    if (fixed === frame) return IDENTITY;
    const outer = this.root(fixed), inner = this.root(frame);
    return outer.frame === inner.frame ? composed(inverse(outer.pose), inner.pose) : null;
  }
}

/** The panel with the tree of frames. */
export function frameTree(transforms) {
  const root = document.getElementById("frames");
  const isOn = root.querySelector(".on");
  const rows = root.querySelector("tbody");
  let end = null;

  function show() {
    if (!end) return;
    const children = new Map();
    for (const [child, { parent }] of transforms.parents) {
      children.set(parent, [...(children.get(parent) ?? []), child]);
    }
    const made = [];
    const add = (frame, deep) => {
      if (deep > MAX_DEPTH) return;
      made.push(row(frame, deep, transforms.parents.get(frame)));
      for (const child of (children.get(frame) ?? []).sort()) add(child, deep + 1);
    };
    for (const frame of transforms.frames) if (!transforms.parents.has(frame)) add(frame, 0);
    rows.replaceChildren(...made);
  }

  function choose() {
    end?.();
    end = isOn.checked && !document.hidden ? transforms.use() : null;
    if (!end) rows.replaceChildren();
  }

  isOn.onchange = choose;
  document.addEventListener("visibilitychange", choose);
  setInterval(show, TREE_MS);
}

function row(frame, deep, edge) {
  const name = element("td", { textContent: frame });
  name.style.paddingLeft = `${deep}em`;
  if (!edge) return element("tr", {}, name, element("td"), element("td"));
  const where = `${edge.pose.t.map((each) => each.toFixed(3)).join(", ")}`
    + `  ${(heading(edge.pose) * 180 / Math.PI).toFixed(1)}°`;
  const age = edge.isStatic ? "static" : `${((performance.now() - edge.heardMs) / 1000).toFixed(1)} s`;
  return element("tr", {}, name, element("td", { textContent: where }), element("td", { textContent: age }));
}
