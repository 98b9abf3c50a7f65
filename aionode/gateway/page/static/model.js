// The robot's model: the visible parts of a URDF, as triangles with their colours.

import { box, cylinder, mesh, sphere } from "./meshes.js";
import { composed, IDENTITY, ofAngles } from "./transforms.js";

const GREY = [0.6, 0.6, 0.62, 1];
const MAX_PARTS = 1000;

function numbers(text, given) {
  const found = (text ?? "").trim().split(/\s+/).filter(Boolean).map(Number);
  return found.length === given.length && found.every(Number.isFinite) ? found : given;
}

function inner(tag, name) {
  return [...(tag?.children ?? [])].find((child) => child.tagName === name);
}

function originOf(tag) {
  const origin = inner(tag, "origin");
  return {
    t: numbers(origin?.getAttribute("xyz"), [0, 0, 0]),
    q: ofAngles(numbers(origin?.getAttribute("rpy"), [0, 0, 0])),
  };
}

/**
 * Return what a URDF shows: { parts, joints }.
 *
 * A part has its link, the pose in it, a colour, and `triangles`, a function that makes or fetches them.
 * Joints say where links are while nothing publishes their transforms.
 */
export function modelOf(urdf, fetchAsset) {
  const tree = new DOMParser().parseFromString(urdf, "text/xml");
  const robot = tree.documentElement;
  if (tree.querySelector("parsererror") || robot.tagName !== "robot") throw new Error("the description is not a URDF");
  const colourOf = (material) => numbers(inner(material, "color")?.getAttribute("rgba"), GREY);
  const materials = new Map([...robot.children].filter(({ tagName }) => tagName === "material")
    .map((material) => [material.getAttribute("name"), colourOf(material)]));
  const parts = [], joints = new Map();
  for (const tag of robot.children) {
    if (tag.tagName === "joint") {
      const child = inner(tag, "child")?.getAttribute("link"), parent = inner(tag, "parent")?.getAttribute("link");
      if (child && parent) joints.set(child, { parent, pose: originOf(tag) });
    }
    if (tag.tagName !== "link") continue;
    for (const visual of tag.children) {
      if (visual.tagName !== "visual" || parts.length >= MAX_PARTS) continue;
      const shape = inner(visual, "geometry")?.firstElementChild;
      if (!shape) continue;
      const material = inner(visual, "material");
      const own = inner(material, "color") ? colourOf(material) : materials.get(material?.getAttribute("name"));
      parts.push({
        link: tag.getAttribute("name"), pose: originOf(visual), colour: own ?? GREY,
        triangles: () => trianglesOf(shape, fetchAsset),
      });
    }
  }
  return { parts, joints };
}

async function trianglesOf(shape, fetchAsset) {
  const number = (name) => numbers(shape.getAttribute(name), [0])[0];
  switch (shape.tagName) {
    case "box": return box(numbers(shape.getAttribute("size"), [0, 0, 0]));
    case "cylinder": return cylinder(number("radius"), number("length"));
    case "sphere": return sphere(number("radius"));
    case "mesh": {
      const name = shape.getAttribute("filename") ?? "";
      const scale = numbers(shape.getAttribute("scale"), [1, 1, 1]);
      return mesh(name, await fetchAsset(name)).map((each, at) => each * scale[at % 3]);
    }
    default: throw new Error(`${shape.tagName}: only boxes, cylinders, spheres and meshes can be shown`);
  }
}

/** Return the pose of a link: by the transforms, else by the joints of the model as they are at zero. */
export function placeOf(link, joints, transforms, fixed) {
  let pose = IDENTITY;
  for (let deep = 0; deep < 100; deep++) {
    const outer = transforms.pose(fixed, link);
    if (outer) return composed(outer, pose);
    const joint = joints.get(link);
    if (!joint) return null;
    pose = composed(joint.pose, pose);
    link = joint.parent;
  }
  return null;
}
