// Shows the newest images of topics: sensor_msgs/CompressedImage, or Image.

import { another, fill } from "./dom.js";
import { picture } from "./picture.js";

const EVERY_MS = 100;
const IMAGE = /^sensor_msgs\/(msg\/)?(Image|CompressedImage)$/;

export function cameras(robot, topics) {
  const root = document.getElementById("camera");
  const first = root.querySelector(".view");
  root.querySelector(".more").onclick = () => camera(robot, topics, another(first));
  camera(robot, topics, first);
}

function camera(robot, topics, root) {
  const select = root.querySelector("select");
  const canvas = root.querySelector("canvas");
  const caption = root.querySelector(".caption");
  let end = null, isBusy = false;

  async function show(message) {
    if (message === null || isBusy) return; // only the newest picture is shown
    isBusy = true;
    try {
      const shown = message.format === undefined ? picture({ ...message, data: bytesOf(message.data) }) : await compressed(message);
      canvas.width = shown.width;
      canvas.height = shown.height;
      if (shown instanceof ImageData) canvas.getContext("2d").putImageData(shown, 0, 0);
      else canvas.getContext("2d").drawImage(shown, 0, 0);
      shown.close?.(); // rather than when it is collected: ten of them a second fill the memory
      caption.textContent = `${canvas.width} × ${canvas.height}, ${message.encoding ?? message.format}`;
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
  const offer = () => fill(select, topics.named(IMAGE), "choose a topic");
  topics.addEventListener("change", offer);
  offer();
}

function compressed({ data, format }) {
  if (format.includes("compressedDepth")) throw new Error("compressedDepth is only available over HTTP");
  const kind = /png/.test(format) ? "image/png" : "image/jpeg";
  return createImageBitmap(new Blob([bytesOf(data)], { type: kind }));
}

function bytesOf(data) {
  return typeof data === "string" ? Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0)) : data;
}
