// The robot's surroundings from above, in one frame: scans, clouds, maps, paths and poses; a goal by hand.

import { element, fill, notice } from "./dom.js";
import { goals } from "./goals.js";
import { layerOf, readerOf } from "./layers.js";
import { applied, facing, heading, matrix } from "./transforms.js";

const COLOURS = ["#e5484d", "#0b8fd4", "#2ea36b", "#e8862e", "#9a6be0", "#b0932b"];
const EVERY_MS = 100;
const GRID_M = [0.1, 0.5, 1, 5, 10, 50, 100, 500, 1000];
const FIXED = ["map", "odom", "world"]; // the first of them that is there is the fixed frame

/** The layers that are chosen, which the view in space shows too. */
export class Scene extends EventTarget {
  constructor(robot, topics, transforms) {
    super();
    this.robot = robot;
    this.transforms = transforms;
    this.layers = new Map();
    this.root = document.getElementById("scene");
    this.canvas = this.root.querySelector("canvas");
    this.list = this.root.querySelector(".layers");
    this.fixed = this.root.querySelector(".fixed");
    this.caption = this.root.querySelector(".caption");
    this.axes = this.root.querySelector(".axes");
    this.middle = [0, 0];
    this.scale = 40; // pixels of a metre
    this.goals = goals(robot, topics, this.root);
    topics.addEventListener("change", () => this.offer(topics.types));
    transforms.addEventListener("change", () => this.note());
    this.fixed.onchange = () => { this.isChosen = true; this.note(); };
    this.axes.onchange = () => this.note();
    this.root.querySelector(".fit").onclick = () => this.fit();
    document.addEventListener("visibilitychange", () => this.listen());
    this.listenToPointer();
    this.draw();
  }

  /** The frame in which all is shown. */
  get frame() {
    return this.fixed.value;
  }

  note() {
    this.isNew = true;
    this.dispatchEvent(new Event("change"));
  }

  // Layers

  offer(types) {
    for (const [topic, layer] of this.layers) {
      if (types.get(topic) === layer.type) continue;
      layer.box.remove();
      layer.end?.();
      this.layers.delete(topic);
      this.listen(); // nobody needs transforms after the last one
      this.note();
    }
    for (const [topic, type] of types) {
      if (this.layers.has(topic) || !readerOf(type)) continue;
      const used = [...this.layers.values()].map(({ colour }) => colour);
      const colour = COLOURS.find((each) => !used.includes(each)) ?? COLOURS[this.layers.size % COLOURS.length];
      const input = element("input", { type: "checkbox", onchange: () => this.listen() });
      const box = element("label", { title: type }, input, topic);
      box.style.color = colour;
      this.layers.set(topic, { type, colour, input, box, end: null, shown: null });
      this.list.append(box);
    }
  }

  listen() {
    const isAny = !document.hidden && [...this.layers.values()].some(({ input }) => input.checked);
    if (isAny) this.endTransforms ??= this.transforms.use();
    else { this.endTransforms?.(); this.endTransforms = null; }
    for (const [topic, layer] of this.layers) {
      const isWanted = layer.input.checked && !document.hidden;
      if (isWanted && !layer.end) {
        const read = readerOf(layer.type);
        layer.end = this.robot.subscribe(topic, (message) => {
          if (message === null) return;
          try {
            layer.shown = layerOf(read, message);
            layer.problem = "";
          } catch (error) {
            layer.shown = null;
            layer.problem = `${topic}: ${error.message}`;
          }
          this.note();
        }, { everyMs: EVERY_MS });
      } else if (!isWanted && layer.end) {
        layer.end();
        layer.end = layer.shown = null;
        layer.problem = "";
        this.note();
      }
    }
  }

  chooseFrame() {
    const shown = [...this.layers.values()].map((layer) => layer.shown?.frame).filter(Boolean);
    const frames = [...new Set([...this.transforms.frames, ...shown])].sort();
    fill(this.fixed, frames, "fixed frame");
    if (!this.fixed.value) this.isChosen = false; // it has gone
    if (!this.isChosen && frames.length) {
      this.fixed.value = FIXED.find((each) => frames.includes(each)) ?? this.transforms.root(shown[0] ?? frames[0]).frame;
    }
  }

  /** Yield the layers that can be placed, each with its colour and its matrix in the fixed frame. */
  *placed() {
    for (const [topic, { shown, colour }] of this.layers) {
      const pose = shown && this.transforms.pose(this.frame, shown.frame);
      if (pose) yield { topic, colour, pose, matrix: matrix(pose), ...shown };
    }
  }

  // Drawing

  draw() {
    requestAnimationFrame(() => this.draw());
    if (!this.isNew || document.hidden) return;
    this.isNew = false;
    this.chooseFrame();
    const { canvas } = this;
    const density = devicePixelRatio, width = canvas.clientWidth, height = canvas.clientHeight;
    if (canvas.width !== Math.round(width * density)) canvas.width = Math.round(width * density);
    if (canvas.height !== Math.round(height * density)) canvas.height = Math.round(height * density);
    const context = canvas.getContext("2d");
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, canvas.width, canvas.height);
    const scale = this.scale * density, [x, y] = this.middle;
    const base = [scale, 0, 0, -scale, canvas.width / 2 - x * scale, canvas.height / 2 + y * scale];
    context.setTransform(...base);
    const placed = [...this.placed()];
    for (const layer of placed) if (layer.picture) drawPicture(context, base, layer);
    context.setTransform(...base);
    this.drawGrid(context, width, height);
    const pixel = 1 / this.scale;
    for (const layer of placed) {
      context.fillStyle = context.strokeStyle = layer.colour;
      context.lineWidth = 2 * pixel;
      if (layer.points) drawPoints(context, layer, 1.5 * pixel);
      if (layer.line) drawLine(context, layer);
      if (layer.arrow) {
        const m = layer.matrix, [ax, ay] = applied(m, ...layer.arrow.t);
        drawArrow(context, ax, ay, heading(layer.pose) + heading(layer.arrow), 14 * pixel);
      }
    }
    if (this.axes.checked) this.drawAxes(context, pixel);
    if (this.goal) {
      context.fillStyle = context.strokeStyle = "#d6409f";
      drawArrow(context, ...this.goal.place, this.goal.yaw, 18 * pixel);
    }
    const missing = [...this.layers].filter(([, { shown }]) => shown && !this.transforms.pose(this.frame, shown.frame));
    const problems = [...this.layers.values()].map(({ problem }) => problem).filter(Boolean);
    this.caption.textContent = [
      ...problems, ...missing.map(([topic, { shown }]) => `${topic}: no transform from ${shown.frame} to ${this.frame}`),
    ].join("; ") || "Drag to move, turn the wheel to zoom.";
    canvas.dataset.shown = placed.map(({ topic }) => topic).join(" ");
    if (!this.hasFitted && placed.some(({ picture, points }) => picture || points?.length > 3)) {
      this.hasFitted = true;
      this.fit();
    }
  }

  drawGrid(context, width, height) {
    const step = GRID_M.find((each) => each * this.scale >= 25) ?? 5000;
    const [x, y] = this.middle, halfX = width / 2 / this.scale, halfY = height / 2 / this.scale;
    context.strokeStyle = "rgb(128 128 128 / 25%)";
    context.lineWidth = 1 / this.scale;
    context.beginPath();
    for (let at = Math.ceil((x - halfX) / step) * step; at < x + halfX; at += step) {
      context.moveTo(at, y - halfY);
      context.lineTo(at, y + halfY);
    }
    for (let at = Math.ceil((y - halfY) / step) * step; at < y + halfY; at += step) {
      context.moveTo(x - halfX, at);
      context.lineTo(x + halfX, at);
    }
    context.stroke();
  }

  drawAxes(context, pixel) {
    context.lineWidth = 2 * pixel;
    const named = []; // places on the screen: names on top of each other cannot be read
    for (const frame of this.transforms.frames) {
      const pose = this.transforms.pose(this.frame, frame);
      if (!pose) continue;
      const m = matrix(pose), size = 18 * pixel;
      for (const [axis, colour] of [[0, "#e5484d"], [4, "#2ea36b"]]) {
        context.strokeStyle = colour;
        context.beginPath();
        context.moveTo(pose.t[0], pose.t[1]);
        context.lineTo(pose.t[0] + m[axis] * size, pose.t[1] + m[axis + 1] * size);
        context.stroke();
      }
      const [x, y] = pose.t.map((each) => each * this.scale);
      if (named.some(([a, b]) => Math.abs(a - x) < 60 && Math.abs(b - y) < 12)) continue;
      named.push([x, y]);
      context.save();
      context.translate(pose.t[0], pose.t[1]);
      context.scale(pixel, -pixel);
      context.fillStyle = getComputedStyle(this.canvas).color;
      context.font = "11px system-ui, sans-serif";
      context.fillText(frame.slice(0, 60), 4, 12);
      context.restore();
    }
  }

  /** Show all layers. */
  fit() {
    let [left, low, right, high] = [Infinity, Infinity, -Infinity, -Infinity];
    const note = (m, x, y, z) => {
      const [a, b] = applied(m, x, y, z);
      left = Math.min(left, a); right = Math.max(right, a); low = Math.min(low, b); high = Math.max(high, b);
    };
    for (const { matrix: m, points, line, picture, arrow, pose } of this.placed()) {
      for (const list of [points, line]) {
        for (let at = 0; at < (list?.length ?? 0); at += 3) note(m, list[at], list[at + 1], list[at + 2]);
      }
      if (arrow) note(m, ...arrow.t);
      if (!picture?.pose) continue;
      const inner = matrix(picture.pose), { width, height } = picture.canvas;
      for (const [x, y] of [[0, 0], [width, 0], [0, height], [width, height]]) {
        note(matrix(pose), ...applied(inner, x * picture.resolution, y * picture.resolution, 0));
      }
    }
    if (left > right) return;
    this.middle = [(left + right) / 2, (low + high) / 2];
    const { clientWidth: width, clientHeight: height } = this.canvas;
    this.scale = clamp(0.9 * Math.min(width / Math.max(right - left, 1), height / Math.max(high - low, 1)));
    this.note();
  }

  // The pointer

  place(event) {
    const box = this.canvas.getBoundingClientRect();
    return [
      this.middle[0] + (event.clientX - box.x - box.width / 2) / this.scale,
      this.middle[1] - (event.clientY - box.y - box.height / 2) / this.scale];
  }

  listenToPointer() {
    const { canvas } = this;
    let held = null;
    canvas.onpointerdown = (event) => {
      canvas.setPointerCapture(event.pointerId);
      held = this.place(event);
      if (this.goals.isArmed) this.goal = { place: held, yaw: 0, isTurned: false };
      this.note();
    };
    canvas.onpointermove = (event) => {
      if (!held) return;
      const [x, y] = this.place(event);
      if (!this.goal) this.middle = [this.middle[0] + held[0] - x, this.middle[1] + held[1] - y];
      else if (Math.hypot(x - held[0], y - held[1]) * this.scale > 8) this.goal.yaw = Math.atan2(y - held[1], x - held[0]);
      this.note();
    };
    canvas.onpointerup = () => {
      const { goal } = this;
      held = this.goal = null;
      this.note();
      if (!goal) return;
      if (!this.frame) notice("Choose a layer and a fixed frame before a goal.");
      else this.goals.send(this.frame, { t: [...goal.place, 0], q: facing(goal.yaw) });
    };
    canvas.onpointercancel = () => { held = this.goal = null; this.note(); };
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      const before = this.place(event);
      this.scale = clamp(this.scale * Math.exp(-event.deltaY / 500));
      const after = this.place(event);
      this.middle = this.middle.map((each, axis) => each + before[axis] - after[axis]);
      this.note();
    }, { passive: false });
  }
}

function clamp(scale) {
  return Math.min(Math.max(scale, 0.05), 5000);
}

function drawPicture(context, base, { matrix: m, picture }) {
  if (!picture.pose) return;
  const inner = matrix(picture.pose);
  context.setTransform(...base);
  context.transform(m[0], m[1], m[4], m[5], m[12], m[13]);
  context.transform(inner[0], inner[1], inner[4], inner[5], inner[12], inner[13]);
  context.scale(picture.resolution, picture.resolution);
  context.imageSmoothingEnabled = false;
  context.drawImage(picture.canvas, 0, 0);
}

function drawPoints(context, { matrix: m, points }, size) {
  for (let at = 0; at < points.length; at += 3) {
    const [x, y] = applied(m, points[at], points[at + 1], points[at + 2]);
    context.fillRect(x - size, y - size, 2 * size, 2 * size);
  }
}

function drawLine(context, { matrix: m, line }) {
  context.beginPath();
  for (let at = 0; at < line.length; at += 3) {
    const [x, y] = applied(m, line[at], line[at + 1], line[at + 2]);
    context.lineTo(x, y);
  }
  context.stroke();
}

function drawArrow(context, x, y, yaw, size) {
  const at = (angle, far) => [x + far * Math.cos(yaw + angle), y + far * Math.sin(yaw + angle)];
  context.beginPath();
  context.moveTo(...at(0, size));
  for (const angle of [2.5, Math.PI, -2.5]) context.lineTo(...at(angle, angle === Math.PI ? 0.3 * size : 0.8 * size));
  context.closePath();
  context.fill();
}
