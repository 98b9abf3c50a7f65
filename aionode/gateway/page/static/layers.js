// What messages look like from above and in space: points, lines and pictures in a frame.

import { frameOf, poseOf } from "./transforms.js";

const MAX_POINTS = 20000;
const MAX_CELLS = 16e6;
const NUMBERS = { 7: ["getFloat32", 4], 8: ["getFloat64", 8] }; // of sensor_msgs/PointField

/**
 * By its type, what reads a message: it returns { frame } with some of
 *
 * - points: x, y, z of each, in metres
 * - line: x, y, z of each corner
 * - arrow: a pose
 * - picture: a canvas; its pose and the metres of a cell
 */
export const READERS = {
  "sensor_msgs/LaserScan": scan,
  "sensor_msgs/PointCloud2": cloud,
  "nav_msgs/OccupancyGrid": grid,
  "nav_msgs/Path": path,
  "nav_msgs/Odometry": ({ pose }) => ({ arrow: poseOf(pose.pose) }),
  "geometry_msgs/PoseStamped": ({ pose }) => ({ arrow: poseOf(pose) }),
  "geometry_msgs/PoseWithCovarianceStamped": ({ pose }) => ({ arrow: poseOf(pose.pose) }),
  "geometry_msgs/PointStamped": ({ point }) => ({ points: new Float32Array([point.x, point.y, point.z]) }),
  "geometry_msgs/PolygonStamped": ({ polygon: { points } }) => ({
    line: new Float32Array([...points, ...points.slice(0, 1)].flatMap(({ x, y, z }) => [x, y, z])) }),
};

export function readerOf(type) {
  return READERS[type.replace("/msg/", "/")];
}

export function layerOf(read, message) {
  return { frame: frameOf(message.header.frame_id), ...read(message) };
}

function scan({ ranges, angle_min, angle_increment, range_min, range_max }) {
  const points = [];
  for (let index = 0; index < ranges.length && index < MAX_POINTS; index++) {
    const range = ranges[index];
    if (!(range >= range_min && range <= range_max)) continue; // also without a number
    const angle = angle_min + index * angle_increment;
    points.push(range * Math.cos(angle), range * Math.sin(angle), 0);
  }
  return { points: new Float32Array(points) };
}

function cloud({ fields, data, width, height, point_step, row_step, is_bigendian }) {
  const places = ["x", "y", "z"].map((axis) => fields.find(({ name }) => name === axis));
  if (places.some((field) => !NUMBERS[field?.datatype])) throw new Error("it has no x, y and z of float32 or float64");
  const bytes = typeof data === "string" ? Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0)) : data;
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const every = Math.max(1, Math.ceil(width * height / MAX_POINTS));
  const points = [];
  for (let index = 0; index < width * height; index += every) {
    const start = Math.floor(index / width) * row_step + (index % width) * point_step;
    const point = places.map(({ offset, datatype }) => {
      const [get, size] = NUMBERS[datatype];
      return start + offset + size <= view.byteLength ? view[get](start + offset, !is_bigendian) : NaN;
    });
    if (point.every(Number.isFinite)) points.push(...point);
  }
  return { points: new Float32Array(points) };
}

function grid({ info, data }) {
  const { width, height, resolution } = info;
  if (!(resolution > 0) || width * height > MAX_CELLS || width * height !== data.length || !data.length) {
    throw new Error(`${width} × ${height} cells of ${resolution} m with ${data.length} values are not a map`);
  }
  const canvas = new OffscreenCanvas(width, height);
  const image = new ImageData(width, height);
  for (let index = 0; index < data.length; index++) {
    const value = data[index]; // -1 is unknown; 0 is free, and 100 occupied
    const grey = value < 0 || value > 100 ? 128 : 255 - value * 2.55;
    image.data.set([grey, grey, grey, value < 0 ? 90 : 255], 4 * index);
  }
  canvas.getContext("2d").putImageData(image, 0, 0);
  return { picture: { canvas, resolution, pose: poseOf(info.origin) } };
}

function path({ header, poses }) {
  const line = poses.slice(0, MAX_POINTS).flatMap(({ pose: { position: { x, y, z } } }) => [x, y, z]);
  // Some planners name the frame in the poses only.
  return { frame: frameOf(header.frame_id || poses[0]?.header.frame_id || ""), line: new Float32Array(line) };
}
