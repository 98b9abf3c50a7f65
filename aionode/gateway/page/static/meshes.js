// Triangles: of boxes, cylinders and spheres, and of meshes in STL, OBJ and COLLADA.
// Each is a Float32Array with x, y, z of three corners after one another.

const ROUND = 24; // faces around a cylinder
const MAX_TRIANGLES = 1e6;
const MAX_NODES = 10000; // of a COLLADA scene, each as often as it is used

export function box([length, width, height]) {
  const [x, y, z] = [length / 2, width / 2, height / 2];
  const faces = [];
  for (const side of [-1, 1]) {
    faces.push([[side * x, -y, -z], [side * x, y, -z], [side * x, y, z], [side * x, -y, z]]);
    faces.push([[-x, side * y, -z], [x, side * y, -z], [x, side * y, z], [-x, side * y, z]]);
    faces.push([[-x, -y, side * z], [x, -y, side * z], [x, y, side * z], [-x, y, side * z]]);
  }
  return trianglesOf(faces);
}

export function cylinder(radius, length) {
  return turned([[0, length / 2], [radius, length / 2], [radius, -length / 2], [0, -length / 2]]);
}

export function sphere(radius) {
  const steps = ROUND / 2;
  return turned(Array.from({ length: steps + 1 }, (_, step) => {
    const angle = Math.PI * step / steps;
    return [radius * Math.sin(angle), radius * Math.cos(angle)];
  }));
}

/** Return what a profile of radii and heights makes when it is turned around the z axis. */
function turned(profile) {
  const faces = [];
  for (let side = 0; side < ROUND; side++) {
    const from = 2 * Math.PI * side / ROUND, to = 2 * Math.PI * (side + 1) / ROUND;
    const at = ([radius, z], angle) => [radius * Math.cos(angle), radius * Math.sin(angle), z];
    for (let step = 0; step + 1 < profile.length; step++) {
      const [upper, lower] = [profile[step], profile[step + 1]];
      faces.push([at(upper, from), at(lower, from), at(lower, to), at(upper, to)]);
    }
  }
  return trianglesOf(faces);
}

/** Cut faces, lists of corners, into triangles. */
function trianglesOf(faces) {
  const corners = [];
  for (const face of faces) {
    for (let at = 1; at + 1 < face.length; at++) corners.push(...face[0], ...face[at], ...face[at + 1]);
    if (corners.length > 9 * MAX_TRIANGLES) throw new Error(`it has more than ${MAX_TRIANGLES} triangles`);
  }
  return new Float32Array(corners);
}

/** Return the triangles of a file; its name ends with what it is. */
export function mesh(name, buffer) {
  const kind = /\.(\w+)$/.exec(name)?.[1].toLowerCase();
  if (kind === "stl") return stl(buffer);
  if (kind === "obj") return obj(new TextDecoder().decode(buffer));
  if (kind === "dae") return collada(new TextDecoder().decode(buffer));
  throw new Error(`${name}: only meshes in STL, OBJ and COLLADA (.dae) can be shown`);
}

function stl(buffer) {
  const view = new DataView(buffer);
  const count = buffer.byteLength >= 84 ? view.getUint32(80, true) : -1;
  if (buffer.byteLength !== 84 + 50 * count) return stlText(new TextDecoder().decode(buffer));
  if (count > MAX_TRIANGLES) throw new Error(`it has more than ${MAX_TRIANGLES} triangles`);
  const corners = new Float32Array(9 * count);
  for (let at = 0; at < count; at++) {
    for (let each = 0; each < 9; each++) corners[9 * at + each] = view.getFloat32(84 + 50 * at + 12 + 4 * each, true);
  }
  return corners;
}

function stlText(text) {
  const numbers = [...text.matchAll(/vertex\s+(\S+)\s+(\S+)\s+(\S+)/g)].flatMap((found) => found.slice(1).map(Number));
  if (!numbers.length || numbers.length % 9) throw new Error("it is not an STL file");
  return new Float32Array(numbers);
}

function obj(text) {
  const places = [], faces = [];
  for (const line of text.split("\n")) {
    const [what, ...values] = line.trim().split(/\s+/);
    if (what === "v") places.push(values.slice(0, 3).map(Number));
    if (what !== "f") continue;
    const face = values.map((value) => {
      const index = parseInt(value, 10);
      return places[index < 0 ? places.length + index : index - 1];
    });
    if (face.includes(undefined)) throw new Error("a face of the OBJ has a corner that does not exist");
    faces.push(face);
  }
  return trianglesOf(faces);
}

// COLLADA

function collada(text) {
  const tree = new DOMParser().parseFromString(text, "text/xml");
  if (tree.querySelector("parsererror")) throw new Error("it is not a COLLADA file");
  const unit = Number(tree.querySelector("asset unit")?.getAttribute("meter") ?? 1);
  const up = tree.querySelector("asset up_axis")?.textContent.trim() ?? "Y_UP";
  const upright = up === "Z_UP" ? [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0] : [1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0];
  const byId = new Map([...tree.querySelectorAll("[id]")].map((each) => [`#${each.id}`, each]));
  const faces = [];
  let nodes = 0;
  const visit = (node, outer, deep) => {
    if (deep > 50) throw new Error("its nodes contain each other");
    if (++nodes > MAX_NODES) throw new Error(`it has more than ${MAX_NODES} nodes`);
    let here = outer;
    for (const child of node.children) {
      const inner = TRANSFORMS[child.tagName]?.(numbersOf(child));
      if (inner) here = product(here, inner);
    }
    for (const child of node.children) {
      if (child.tagName === "node") visit(child, here, deep + 1);
      const used = byId.get(child.getAttribute("url"));
      if (child.tagName === "instance_node" && used) visit(used, here, deep + 1);
      if (child.tagName === "instance_geometry" && used) facesOf(used, byId, here, unit, faces);
    }
  };
  const scene = byId.get(tree.querySelector("scene instance_visual_scene")?.getAttribute("url"))
    ?? tree.querySelector("visual_scene");
  if (scene) for (const node of scene.children) visit(node, upright, 0);
  return trianglesOf(faces);
}

function numbersOf(tag) {
  return tag.textContent.trim().split(/\s+/).filter(Boolean).map(Number);
}

// Matrices of three rows and four columns

const TRANSFORMS = {
  matrix: (given) => given.slice(0, 12),
  translate: ([x, y, z]) => [1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z],
  scale: ([x, y, z]) => [x, 0, 0, 0, 0, y, 0, 0, 0, 0, z, 0],
  rotate: ([x, y, z, degrees]) => {
    const c = Math.cos(degrees * Math.PI / 180), s = Math.sin(degrees * Math.PI / 180), d = 1 - c;
    return [
      d * x * x + c, d * x * y - s * z, d * x * z + s * y, 0,
      d * x * y + s * z, d * y * y + c, d * y * z - s * x, 0,
      d * x * z - s * y, d * y * z + s * x, d * z * z + c, 0];
  },
};

function product(a, b) {
  const made = [];
  for (let row = 0; row < 12; row += 4) {
    for (let column = 0; column < 4; column++) {
      made.push(a[row] * b[column] + a[row + 1] * b[4 + column] + a[row + 2] * b[8 + column]
        + (column === 3 ? a[row + 3] : 0));
    }
  }
  return made;
}

function facesOf(geometry, byId, m, unit, faces) {
  for (const part of geometry.querySelectorAll("triangles, polylist, polygons")) {
    const inputs = [...part.children].filter(({ tagName }) => tagName === "input");
    const vertices = inputs.find((input) => input.getAttribute("semantic") === "VERTEX");
    const source = byId.get(byId.get(vertices?.getAttribute("source"))
      ?.querySelector("input[semantic=POSITION]")?.getAttribute("source"));
    const list = source?.querySelector("float_array");
    if (!list) continue;
    const numbers = numbersOf(list);
    const offset = Number(vertices.getAttribute("offset"));
    const stride = 1 + Math.max(...inputs.map((input) => Number(input.getAttribute("offset"))));
    const corner = (index) => {
      const [x, y, z] = numbers.slice(3 * index, 3 * index + 3);
      return [0, 4, 8].map((row) => unit * (m[row] * x + m[row + 1] * y + m[row + 2] * z + m[row + 3]));
    };
    const counts = part.querySelector("vcount");
    for (const run of part.querySelectorAll("p")) {
      const indices = numbersOf(run).filter((_, at) => at % stride === offset);
      const sizes = counts ? numbersOf(counts) : part.tagName === "polygons" ? [indices.length] : null;
      let at = 0;
      for (let face = 0; at < indices.length; face++) {
        const size = sizes ? sizes[face] : 3;
        if (!(size > 0)) break;
        faces.push(indices.slice(at, at + size).map(corner));
        at += size;
        if (faces.length > MAX_TRIANGLES) throw new Error(`it has more than ${MAX_TRIANGLES} triangles`);
      }
    }
  }
}
