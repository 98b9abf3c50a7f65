// Drives while the pad or a key is held. Releasing it, hiding the page or losing the connection stops.

import { element, notice } from "./dom.js";

const ID = "teleop";
const PERIOD_MS = 50;
const MAX_WAITING_BYTES = 2000;
const KEYS = {
  ArrowUp: [1, 0], KeyW: [1, 0], ArrowDown: [-1, 0], KeyS: [-1, 0],
  ArrowLeft: [0, 1], KeyA: [0, 1], ArrowRight: [0, -1], KeyD: [0, -1],
};
const COMMAND = /^geometry_msgs\/(msg\/)?Twist(Stamped)?$/;

export class Teleop {
  constructor(robot, topics) {
    this.robot = robot;
    this.topics = topics;
    const root = document.getElementById("teleop");
    this.topic = root.querySelector(".topic");
    this.armed = root.querySelector(".armed");
    this.speed = root.querySelector(".speed");
    this.turn = root.querySelector(".turn");
    this.pad = root.querySelector(".pad");
    this.knob = this.pad.querySelector("i");
    this.keys = new Set();
    this.timer = null;
    this.pointer = null;
    this.command = null; // [forward, left], from -1 to 1, while it is held

    this.armed.onchange = () => (this.armed.checked ? this.arm() : this.disarm());
    this.topic.onchange = () => this.disarm();
    this.pad.onpointerdown = (event) => this.grab(event);
    this.pad.onpointermove = (event) => this.pad.hasPointerCapture(event.pointerId) && this.move(event);
    for (const end of ["pointerup", "pointercancel", "lostpointercapture", "blur"]) {
      this.pad.addEventListener(end, () => this.release());
    }
    this.pad.onkeydown = (event) => this.key(event, true);
    this.pad.onkeyup = (event) => this.key(event, false);
    document.getElementById("stop").onclick = () => this.stop();
    addEventListener("keydown", (event) => event.code === "Escape" && this.stop());
    addEventListener("blur", () => this.release());
    addEventListener("pagehide", () => this.disarm());
    document.addEventListener("visibilitychange", () => document.hidden && this.disarm());
    robot.addEventListener("state", () => this.disarm());
    // Refused commands have no effect: the user who holds the pad should see that, and let go.
    robot.addEventListener("status", ({ detail }) => detail.id === ID && this.release());
    topics.addEventListener("change", () => this.list());
  }

  list() {
    const names = this.topics.named(COMMAND);
    document.getElementById("command-topics").replaceChildren(
      ...names.map((value) => element("option", { value })));
    if (!this.topic.value) this.topic.value = names.find((name) => name.endsWith("cmd_vel")) ?? names[0] ?? "";
  }

  arm() {
    if (!this.robot.isOpen || !this.topic.value) {
      this.armed.checked = false;
      notice(this.robot.isOpen ? "Teleop: name a topic" : "Teleop: not connected");
      return;
    }
    this.name = this.topic.value;
    this.type = this.topics.types.get(this.name) ?? "geometry_msgs/msg/Twist";
    this.robot.advertise(this.name, this.type);
    this.pad.classList.add("armed");
    this.pad.focus();
  }

  disarm() {
    this.release();
    if (this.pad.classList.contains("armed")) this.robot.unadvertise(this.name);
    this.pad.classList.remove("armed");
    this.armed.checked = false;
  }

  /** Stop, whether or not the pad is held, and do not drive until "drive" is ticked again. */
  stop() {
    if (this.pad.classList.contains("armed")) this.publish([0, 0]);
    this.disarm();
  }

  // Input

  grab(event) {
    if (!this.armed.checked || event.button !== 0) return;
    this.pointer = event.pointerId;
    this.pad.setPointerCapture(this.pointer);
    this.move(event);
  }

  move(event) {
    const box = this.pad.getBoundingClientRect();
    const right = (event.clientX - box.left) / box.width * 2 - 1;
    const down = (event.clientY - box.top) / box.height * 2 - 1;
    const length = Math.max(1, Math.hypot(right, down));
    this.hold([-down / length, -right / length]);
  }

  key(event, isDown) {
    if (!KEYS[event.code]) return;
    event.preventDefault();
    if (!this.armed.checked || (event.repeat && this.command === null)) return;
    if (isDown) this.keys.add(event.code);
    else this.keys.delete(event.code);
    if (!this.keys.size) { this.release(); return; }
    const sum = (place) => [...this.keys].reduce((total, code) => total + KEYS[code][place], 0);
    this.hold([Math.sign(sum(0)), Math.sign(sum(1))]);
  }

  hold(command) {
    const isNew = this.command === null;
    this.command = command.map((part) => (Math.abs(part) < 0.08 ? 0 : part));
    this.draw();
    if (!isNew) return;
    this.timer = setInterval(() => this.send(), PERIOD_MS);
    this.send();
  }

  release() {
    if (this.command === null) return;
    clearInterval(this.timer);
    this.command = null;
    // A pointer or key that is still held has to be pressed again.
    if (this.pointer !== null && this.pad.hasPointerCapture(this.pointer)) {
      this.pad.releasePointerCapture(this.pointer);
    }
    this.pointer = null;
    this.keys.clear();
    this.publish([0, 0]);
    this.draw();
  }

  // Output

  send() {
    if (this.robot.waitingBytes > MAX_WAITING_BYTES) {
      this.release();
      notice("Teleop: the network is too slow for commands");
      return;
    }
    this.publish(this.command);
  }

  publish([forward, left]) {
    const twist = {
      linear: { x: forward * Number(this.speed.value), y: 0, z: 0 },
      angular: { x: 0, y: 0, z: left * Number(this.turn.value) },
    };
    // The gateway stamps a header without a stamp with the robot's time.
    const isStamped = this.type.endsWith("Stamped");
    const message = isStamped ? { header: { frame_id: "base_link" }, twist } : twist;
    this.robot.publish(this.name, message, ID);
  }

  draw() {
    const [forward, left] = this.command ?? [0, 0];
    this.pad.classList.toggle("held", this.command !== null);
    this.knob.style.transform = `translate(${-left * 70}px, ${-forward * 70}px)`;
  }
}
