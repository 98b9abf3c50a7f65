// The robot in space: its model, the axes of frames, and the layers that are chosen above. WebGL alone.

import { fill } from "./dom.js";
import { modelOf, placeOf } from "./model.js";
import { composed, matrix } from "./transforms.js";

const DESCRIPTION = /^std_msgs\/(msg\/)?String$/;
const AXES_M = 0.12;
const FLOOR_M = 10;

const VERTEX = `
attribute vec3 place; attribute vec3 normal;
uniform mat4 view; uniform mat4 model; uniform float size;
varying float light;
void main() {
  vec3 facing = mat3(model[0].xyz, model[1].xyz, model[2].xyz) * normal;
  light = length(normal) > 0.5 ? 0.45 + 0.55 * abs(dot(normalize(facing), normalize(vec3(0.3, 0.5, 0.9)))) : 1.0;
  gl_Position = view * model * vec4(place, 1.0);
  gl_PointSize = size;
}`;
const FRAGMENT = `
precision mediump float;
uniform vec4 colour; varying float light;
void main() { gl_FragColor = vec4(colour.rgb * light, colour.a); }`;

export function view3d(robot, topics, scene, transforms) {
  const root = document.getElementById("space");
  const canvas = root.querySelector("canvas");
  const select = root.querySelector(".description");
  const isOn = root.querySelector(".on");
  const caption = root.querySelector(".caption");
  let gl = null, model = null, ends = [], isNew = false;
  const eye = { yaw: -2.2, pitch: 0.6, far: 1.6 };

  function choose() {
    ends.forEach((end) => end());
    ends = [];
    if (!isOn.checked || document.hidden) return;
    gl ??= painter(canvas);
    if (!gl) { caption.textContent = "This browser has no WebGL."; return; }
    ends = [transforms.use()];
    if (select.value) ends.push(robot.subscribe(select.value, (message) => message && take(message.data)));
    isNew = true;
  }

  function take(urdf) {
    if (model?.urdf === urdf) return;
    const problems = [];
    caption.textContent = "";
    try {
      show({ urdf, ...modelOf(urdf, (uri) => robot.asset(uri)) });
    } catch (error) {
      show(null);
      caption.textContent = error.message;
      return;
    }
    const taken = model;
    for (const part of model.parts) {
      part.triangles().then((triangles) => {
        if (model !== taken) return;
        part.drawn = gl.solid(triangles);
        isNew = true;
      }).catch((error) => {
        problems.push(`${part.link}: ${error.message}`);
        if (model === taken) caption.textContent = problems.join("; ").slice(0, 500);
      });
    }
  }

  function show(other) {
    for (const { drawn } of model?.parts ?? []) if (drawn) gl.drop(drawn);
    model = other;
    isNew = true;
  }

  function draw() {
    requestAnimationFrame(draw);
    if (!isNew || !ends.length || document.hidden) return;
    isNew = false;
    const fixed = scene.frame || transforms.root(transforms.frames[0] ?? "").frame;
    gl.begin(cameraOf(canvas, eye, middle(fixed)));
    gl.draw(gl.floor, "LINES", [0.5, 0.5, 0.5, 0.5], FLOOR);
    let shown = 0;
    for (const part of model?.parts ?? []) {
      const place = part.drawn && placeOf(part.link, model.joints, transforms, fixed);
      if (!place) continue;
      shown += 1;
      gl.draw(part.drawn, "TRIANGLES", part.colour, matrix(composed(place, part.pose)));
    }
    for (const { matrix: m, points, line, colour } of scene.placed()) {
      if (points) gl.drawOnce(points, "POINTS", colour, m);
      if (line) gl.drawOnce(line, "LINE_STRIP", colour, m);
    }
    for (const frame of transforms.frames) {
      const pose = transforms.pose(fixed, frame);
      if (pose) for (const axis of gl.axes) gl.draw(axis.drawn, "LINES", axis.colour, matrix(pose));
    }
    canvas.dataset.parts = shown;
  }

  /** Look at the base of the robot: the first link of the model that has a place. */
  function middle(fixed) {
    for (const { link } of model?.parts ?? []) {
      const place = placeOf(link, model.joints, transforms, fixed);
      if (place) return place.t;
    }
    return [0, 0, 0];
  }

  canvas.onpointerdown = (event) => canvas.setPointerCapture(event.pointerId);
  canvas.onpointermove = (event) => {
    if (!event.buttons) return;
    eye.yaw -= event.movementX / 150;
    eye.pitch = Math.min(Math.max(eye.pitch + event.movementY / 150, -1.5), 1.5);
    isNew = true;
  };
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    eye.far = Math.min(Math.max(eye.far * Math.exp(event.deltaY / 500), 0.1), 200);
    isNew = true;
  }, { passive: false });
  isOn.onchange = select.onchange = choose;
  document.addEventListener("visibilitychange", choose);
  for (const source of [scene, transforms]) source.addEventListener("change", () => { isNew = true; });
  topics.addEventListener("change", () => {
    const before = select.value;
    const names = topics.named(DESCRIPTION);
    fill(select, names, "choose a description");
    if (!before) select.value = names.find((name) => name.endsWith("/robot_description")) ?? "";
    if (select.value !== before) choose();
  });
  draw();
}

const FLOOR = new Float32Array([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);

/** Return the matrix that projects what a camera sees that looks at a place. */
function cameraOf(canvas, { yaw, pitch, far }, [x, y, z]) {
  const back = [Math.cos(pitch) * Math.cos(yaw), Math.cos(pitch) * Math.sin(yaw), Math.sin(pitch)];
  const right = [-Math.sin(yaw), Math.cos(yaw), 0];
  const up = [
    back[1] * right[2] - back[2] * right[1], back[2] * right[0] - back[0] * right[2],
    back[0] * right[1] - back[1] * right[0]];
  const eye = [x + far * back[0], y + far * back[1], z + far * back[2]];
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const zoom = 2, wide = zoom * canvas.clientHeight / Math.max(canvas.clientWidth, 1);
  const near = far / 100, end = far * 100;
  const depth = (end + near) / (near - end), shift = 2 * end * near / (near - end);
  const view = [];
  for (let axis = 0; axis < 3; axis++) view.push(wide * right[axis], zoom * up[axis], depth * back[axis], -back[axis]);
  view.push(-wide * dot(right, eye), -zoom * dot(up, eye), -depth * dot(back, eye) + shift, dot(back, eye));
  return new Float32Array(view);
}

/** Draw with WebGL; null where there is none. */
function painter(canvas) {
  const gl = canvas.getContext("webgl", { antialias: true, preserveDrawingBuffer: true });
  if (!gl) return null;
  const program = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  gl.useProgram(program);
  const uniform = (name) => gl.getUniformLocation(program, name);
  const places = { view: uniform("view"), model: uniform("model"), colour: uniform("colour"), size: uniform("size") };
  const place = gl.getAttribLocation(program, "place"), normal = gl.getAttribLocation(program, "normal");
  const scratch = gl.createBuffer();

  function load(corners, normals = null, buffer = gl.createBuffer()) {
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, normals ? joined(corners, normals) : corners, gl.DYNAMIC_DRAW);
    return { buffer, count: corners.length / 3, normalsAt: normals ? corners.byteLength : null };
  }

  function draw({ buffer, count, normalsAt }, mode, colour, model) {
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, 3, gl.FLOAT, false, 0, 0);
    if (normalsAt === null) {
      gl.disableVertexAttribArray(normal);
      gl.vertexAttrib3f(normal, 0, 0, 0);
    } else {
      gl.enableVertexAttribArray(normal);
      gl.vertexAttribPointer(normal, 3, gl.FLOAT, false, 0, normalsAt);
    }
    gl.uniform4fv(places.colour, typeof colour === "string" ? rgb(colour) : colour);
    gl.uniformMatrix4fv(places.model, false, model);
    gl.drawArrays(gl[mode], 0, count);
  }

  return {
    begin(view) {
      const width = Math.round(canvas.clientWidth * devicePixelRatio);
      const height = Math.round(canvas.clientHeight * devicePixelRatio);
      if (canvas.width !== width) canvas.width = width;
      if (canvas.height !== height) canvas.height = height;
      gl.viewport(0, 0, width, height);
      gl.clearColor(0, 0, 0, 0);
      gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
      gl.enable(gl.DEPTH_TEST);
      gl.enable(gl.BLEND);
      gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
      gl.uniformMatrix4fv(places.view, false, view);
      gl.uniform1f(places.size, 3 * devicePixelRatio);
    },
    draw,
    drawOnce: (corners, mode, colour, model) => draw(load(corners, null, scratch), mode, colour, model),
    solid: (triangles) => load(triangles, normalsOf(triangles)),
    drop: ({ buffer }) => gl.deleteBuffer(buffer),
    floor: load(floorLines()),
    axes: [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map((axis, index) => ({
      drawn: load(new Float32Array([0, 0, 0, ...axis.map((each) => each * AXES_M)])),
      colour: ["#e5484d", "#2ea36b", "#3b8eea"][index],
    })),
  };
}

function joined(corners, normals) {
  const made = new Float32Array(corners.length + normals.length);
  made.set(corners);
  made.set(normals, corners.length);
  return made;
}

function rgb(colour) {
  return [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16) / 255).concat(1);
}

/** Return the normal of each corner: that of its triangle. */
function normalsOf(corners) {
  const normals = new Float32Array(corners.length);
  for (let at = 0; at < corners.length; at += 9) {
    const [a, b, c] = [0, 3, 6].map((each) => corners.subarray(at + each, at + each + 3));
    const u = [b[0] - a[0], b[1] - a[1], b[2] - a[2]], v = [c[0] - a[0], c[1] - a[1], c[2] - a[2]];
    const cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    const length = Math.hypot(...cross) || 1;
    for (let each = 0; each < 9; each++) normals[at + each] = cross[each % 3] / length;
  }
  return normals;
}

/** Return a grid in pieces of a metre: some drivers leave out lines that begin behind the eye. */
function floorLines() {
  const lines = [];
  for (let at = -FLOOR_M; at <= FLOOR_M; at++) {
    for (let from = -FLOOR_M; from < FLOOR_M; from++) {
      lines.push(at, from, 0, at, from + 1, 0, from, at, 0, from + 1, at, 0);
    }
  }
  return new Float32Array(lines);
}
