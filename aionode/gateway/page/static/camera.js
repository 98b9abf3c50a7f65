// Shows the newest image of a topic: sensor_msgs/CompressedImage, or Image in a common encoding.

import { fill } from "./dom.js";

const EVERY_MS = 100;
const IMAGE = /^sensor_msgs\/(msg\/)?(Image|CompressedImage)$/;
// For each encoding: bytes of a pixel, and the places of red, green and blue in it.
const ENCODINGS = {
  rgb8: [3, 0, 1, 2], bgr8: [3, 2, 1, 0], rgba8: [4, 0, 1, 2], bgra8: [4, 2, 1, 0],
  mono8: [1, 0, 0, 0], "8UC1": [1, 0, 0, 0], "8UC3": [3, 2, 1, 0],
  mono16: [2, 1, 1, 1], "16UC1": [2, 1, 1, 1],
};

export function camera(robot, topics) {
  const root = document.getElementById("camera");
  const select = root.querySelector("select");
  const canvas = root.querySelector("canvas");
  const caption = root.querySelector(".caption");
  let end = null, isBusy = false;

  async function show(message) {
    if (message === null || isBusy) return; // the newest picture, not all of them
    isBusy = true;
    try {
      const picture = message.format === undefined ? plain(message) : await compressed(message);
      canvas.width = picture.width;
      canvas.height = picture.height;
      if (picture instanceof ImageData) canvas.getContext("2d").putImageData(picture, 0, 0);
      else canvas.getContext("2d").drawImage(picture, 0, 0);
      caption.textContent = `${picture.width} × ${picture.height}, ${message.encoding ?? message.format}`;
    } catch (error) {
      caption.textContent = error.message;
    }
    isBusy = false;
  }

  function choose() {
    end?.();
    caption.textContent = "";
    const isShown = select.value && !document.hidden;
    end = isShown ? robot.subscribe(select.value, show, { everyMs: EVERY_MS }) : null;
  }

  select.onchange = choose;
  document.addEventListener("visibilitychange", choose);
  topics.addEventListener("change", () => fill(select, topics.named(IMAGE), "choose a topic"));
}

function compressed({ data, format }) {
  const kind = /png/.test(format) ? "image/png" : "image/jpeg";
  return createImageBitmap(new Blob([bytesOf(data)], { type: kind }));
}

function plain({ width, height, step, encoding, is_bigendian, data }) {
  if (!ENCODINGS[encoding]) throw new Error(`the encoding ${encoding} is not shown`);
  const [size, ...places] = ENCODINGS[encoding];
  const [red, green, blue] = size === 2 && is_bigendian ? [0, 0, 0] : places;
  const from = bytesOf(data);
  const picture = new ImageData(width, height);
  for (let row = 0, to = 0; row < height; row++) {
    for (let at = row * step, last = at + width * size; at < last; at += size) {
      picture.data[to++] = from[at + red];
      picture.data[to++] = from[at + green];
      picture.data[to++] = from[at + blue];
      picture.data[to++] = 255;
    }
  }
  return picture;
}

function bytesOf(data) {
  return typeof data === "string" ? Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0)) : data;
}
