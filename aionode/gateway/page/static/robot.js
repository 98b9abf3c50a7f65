// The connection to the gateway, over the rosbridge protocol.

import { decode } from "./cbor.js";

const FIRST_WAIT_MS = 500;
const LONGEST_WAIT_MS = 5000;
const CHECK_MS = 2000;
const SILENT_MS = 6000;

/**
 * Topics and services of a robot. It reconnects automatically, with the same subscriptions.
 *
 * Events: "state" when the connection opens or closes, "status" when the gateway refuses something.
 */
export class Robot extends EventTarget {
  constructor(url) {
    super();
    this.url = url;
    this.token = "";
    this.isOpen = false;
    this.delayMs = null;
    this.topics = new Map();
    this.calls = new Map();
    this.nextId = 1;
    this.waitMs = FIRST_WAIT_MS;
    setInterval(() => this.check(), CHECK_MS);
  }

  connect() {
    clearTimeout(this.retry);
    const url = new URL(this.url);
    if (this.token) url.searchParams.set("token", this.token);
    const socket = new WebSocket(url);
    socket.binaryType = "arraybuffer";
    socket.onopen = () => this.onOpen();
    socket.onmessage = (event) => this.onFrame(event.data);
    socket.onclose = (event) => socket === this.socket && this.onClose(event);
    this.socket = socket;
  }

  onOpen() {
    this.isOpen = true;
    this.waitMs = FIRST_WAIT_MS;
    this.heardMs = performance.now();
    this.send({ op: "set_level", level: "warning" });
    for (const [name, topic] of this.topics) this.subscribeTopic(name, topic);
    this.check();
    this.tell("state");
  }

  onClose(event) {
    const wasOpen = this.isOpen;
    this.isOpen = false;
    this.delayMs = null;
    for (const call of this.calls.values()) call.reject(new Error("the connection was lost"));
    this.calls.clear();
    this.retry = setTimeout(() => this.connect(), this.waitMs);
    this.waitMs = Math.min(2 * this.waitMs, LONGEST_WAIT_MS);
    this.tell("state", { refused: !wasOpen, reason: event.reason });
  }

  /** Return why the gateway refuses: a browser reveals that for a POST, but not for a WebSocket. */
  async whyRefused() {
    const url = new URL("healthz", this.url);
    url.protocol = url.protocol.replace("ws", "http");
    const headers = this.token ? { Authorization: `Bearer ${this.token}` } : {};
    try {
      const answer = await fetch(url, { method: "POST", headers });
      const { error } = await answer.json().catch(() => ({}));
      if (answer.status !== 405) return error ?? `refused: ${answer.status} ${answer.statusText}`;
      return "The gateway answers, but its WebSocket does not: a proxy has to pass on the headers Upgrade and Connection.";
    } catch (error) {
      return `The gateway cannot be reached: ${error.message}`;
    }
  }

  /** Request the time, and close the connection if nothing has arrived for too long. */
  async check() {
    if (!this.isOpen) return;
    if (performance.now() - this.heardMs > SILENT_MS) {
      const socket = this.socket;
      this.socket = null; // closing it may take minutes, and does not matter any more
      socket.close();
      this.onClose({ reason: `nothing was received for ${SILENT_MS / 1000} s` });
      return;
    }
    const startMs = performance.now();
    await this.call("/rosapi/get_time").catch(() => null);
    if (!this.isOpen) return;
    this.delayMs = performance.now() - startMs;
    this.tell("delay");
  }

  onFrame(data) {
    this.heardMs = performance.now();
    const isText = typeof data === "string";
    const frame = isText ? JSON.parse(data) : decode(data);
    if (frame.op === "publish") {
      const raw = frame.msg?.bytes instanceof Uint8Array && "secs" in frame.msg;
      const size = isText ? data.length : raw ? frame.msg.bytes.length : data.byteLength;
      this.topics.get(frame.topic)?.readers.forEach((reader) => reader.read(raw ? null : frame.msg, size));
    } else if (frame.op === "action_feedback") {
      this.calls.get(frame.id)?.feedback(frame.values);
    } else if (frame.op === "action_result") {
      const goal = this.calls.get(frame.id);
      this.calls.delete(frame.id);
      if (frame.result) goal?.resolve(frame);
      else goal?.reject(new Error(String(frame.values)));
    } else if (frame.op === "service_response") {
      const call = this.calls.get(frame.id);
      this.calls.delete(frame.id);
      if (frame.result) call?.resolve(frame.values);
      else call?.reject(new Error(String(frame.values)));
    } else if (frame.op === "status") {
      this.tell("status", { level: frame.level, text: frame.msg, id: frame.id });
    }
  }

  tell(name, detail) {
    this.dispatchEvent(new CustomEvent(name, { detail }));
  }

  send(frame) {
    if (this.isOpen && this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(frame));
  }

  /** The number of bytes waiting for the network: commands behind many would arrive too late. */
  get waitingBytes() {
    return this.isOpen ? this.socket.bufferedAmount : 0;
  }

  // Topics

  /**
   * Call read(message, size) for each message, and return a function that ends it.
   *
   * A reader without values gets null for the message: then nobody decodes it. With the type of the
   * topic it may come before its publishers.
   */
  subscribe(name, read, { values = true, everyMs = 0, type } = {}) {
    const topic = this.topics.get(name) ?? { readers: new Set(), id: null, type };
    const reader = { read, values, everyMs };
    topic.readers.add(reader);
    this.topics.set(name, topic);
    this.subscribeTopic(name, topic);
    return () => {
      if (!topic.readers.delete(reader)) return;
      if (topic.readers.size === 0) {
        this.topics.delete(name);
        this.send({ op: "unsubscribe", id: topic.id, topic: name });
      } else this.subscribeTopic(name, topic);
    };
  }

  // The gateway has one setting for each topic of a client, so all readers share one subscription.
  subscribeTopic(name, topic) {
    const readers = [...topic.readers];
    const compression = readers.some((reader) => reader.values) ? "cbor" : "cbor-raw";
    const throttle_rate = Math.min(...readers.map((reader) => reader.everyMs));
    const settings = `${compression} ${throttle_rate}`;
    if (topic.settings === settings && topic.socket === this.socket) return;
    const before = topic.socket === this.socket ? topic.id : null;
    topic.settings = settings;
    topic.socket = this.socket;
    topic.id = `subscribe:${name}:${this.nextId++}`;
    this.send({ op: "subscribe", id: topic.id, topic: name, type: topic.type, compression, throttle_rate });
    if (before) this.send({ op: "unsubscribe", id: before, topic: name });
  }

  advertise(topic, type) {
    this.send({ op: "advertise", id: `advertise:${topic}`, topic, type });
  }

  unadvertise(topic) {
    this.send({ op: "unadvertise", id: `advertise:${topic}`, topic });
  }

  publish(topic, msg, id) {
    this.send({ op: "publish", id, topic, msg });
  }

  // Services

  /** Return a promise of the response; it fails with the gateway's error. */
  call(service, args = {}, timeout = 5) {
    if (!this.isOpen) return Promise.reject(new Error("not connected"));
    const id = `call_service:${service}:${this.nextId++}`;
    return new Promise((resolve, reject) => {
      this.calls.set(id, { resolve, reject });
      this.send({ op: "call_service", id, service, args, timeout });
    });
  }

  // Goals

  /** Send a goal; `result` of what this returns is a promise of its end, and fails if it is refused. */
  sendGoal(action, action_type, args, feedback) {
    const id = `send_action_goal:${action}:${this.nextId++}`;
    const result = new Promise((resolve, reject) => {
      if (!this.isOpen) { reject(new Error("not connected")); return; }
      this.calls.set(id, { resolve, reject, feedback });
      this.send({ op: "send_action_goal", id, action, action_type, args, feedback: true });
    });
    return { result, cancel: () => this.send({ op: "cancel_action_goal", id, action }) };
  }

  // Files

  /** Return the bytes of a file of a package, by its package:// address. */
  async asset(uri) {
    const [, packageName, path] = /^package:\/\/([^/]+)\/(.+)$/.exec(uri) ?? [];
    if (!path) throw new Error(`${uri}: only package:// is served`);
    const url = new URL(`assets/${[packageName, ...path.split("/").map(decodeURIComponent)].map(encodeURIComponent).join("/")}`, this.url);
    url.protocol = url.protocol.replace("ws", "http");
    const headers = this.token ? { Authorization: `Bearer ${this.token}` } : {};
    const answer = await fetch(url, { headers });
    if (answer.ok) return answer.arrayBuffer();
    const { error } = await answer.json().catch(() => ({}));
    throw new Error(error ?? `${uri}: ${answer.status}`);
  }
}
