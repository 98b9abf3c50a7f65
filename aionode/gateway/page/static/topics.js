// The list of topics with their rates, the message of one topic, and plots of its numbers.

import { another, element, leaves, short } from "./dom.js";
import { Plot } from "./plot.js";

const LIST_MS = 3000;
const RATE_MS = 1000;
const WINDOW = 3; // seconds over which rates are averaged
const MAX_ROWS = 200;
// Topics with large messages are measured only while their message is shown.
const LARGE = /\/(Image|CompressedImage|PointCloud2?|LaserScan|OccupancyGrid|MarkerArray|DisparityImage)$/;

export class Topics extends EventTarget {
  constructor(robot) {
    super();
    this.robot = robot;
    this.types = new Map();
    this.rates = new Map();
    this.root = document.getElementById("topics");
    this.rows = this.root.querySelector("tbody");
    this.filter = this.root.querySelector(".filter");
    this.measuring = this.root.querySelector(".rates");
    this.filter.oninput = () => this.show();
    this.measuring.onchange = () => this.show();
    document.addEventListener("visibilitychange", () => this.show());
    robot.addEventListener("state", () => this.list());
    setInterval(() => this.list(), LIST_MS);
    setInterval(() => this.showRates(), RATE_MS);
  }

  async list() {
    if (!this.robot.isOpen || document.hidden) return;
    const { topics, types } = await this.robot.call("/rosapi/offered").catch(() => ({}));
    if (!topics) return;
    this.types = new Map(topics.map((name, index) => [name, types[index]]).sort());
    this.show();
    this.dispatchEvent(new Event("change"));
  }

  /** Return the names of topics whose type matches. */
  named(pattern) {
    return [...this.types].filter(([, type]) => pattern.test(type)).map(([name]) => name);
  }

  show() {
    const wanted = this.filter.value.toLowerCase();
    const shown = [...this.types].filter(([name, type]) => `${name} ${type}`.toLowerCase().includes(wanted));
    const rows = new Map([...this.rows.children].map((row) => [row.dataset.topic, row]));
    this.rows.replaceChildren(...shown.map(([name, type]) => rows.get(name) ?? this.row(name, type)));
    this.measure(new Set(shown.slice(0, MAX_ROWS).map(([name]) => name)));
  }

  row(name, type) {
    const row = element("tr", { onclick: () => this.choose(name) },
      element("td", {}, name, element("small", { textContent: type })),
      element("td", { className: "rate" }), element("td", { className: "size" }));
    row.dataset.topic = name;
    return row;
  }

  choose(name) {
    for (const row of this.rows.children) row.classList.toggle("chosen", row.dataset.topic === name);
    this.dispatchEvent(new CustomEvent("choose", { detail: name }));
  }

  /** Measure only the topics that are visible: each subscription costs the robot work. */
  measure(shown) {
    const isOn = this.measuring.checked && !document.hidden;
    for (const [name, rate] of this.rates) {
      if (isOn && shown.has(name)) continue;
      rate.end();
      this.rates.delete(name);
    }
    for (const name of isOn ? shown : []) {
      if (this.rates.has(name) || LARGE.test(this.types.get(name))) continue;
      const rate = { arrivals: [], sinceMs: performance.now() };
      rate.end = this.robot.subscribe(
        name, (_, size) => rate.arrivals.push([performance.now(), size]), { values: false });
      this.rates.set(name, rate);
    }
  }

  showRates() {
    const now = performance.now();
    for (const row of this.rows.children) {
      const rate = this.rates.get(row.dataset.topic);
      let texts = ["", ""];
      if (rate) {
        rate.arrivals = rate.arrivals.filter(([time]) => time > now - WINDOW * 1000);
        const seconds = Math.max(Math.min(WINDOW, (now - rate.sinceMs) / 1000), 1);
        const size = rate.arrivals.reduce((sum, [, bytes]) => sum + bytes, 0);
        if (rate.arrivals.length) {
          texts = [(rate.arrivals.length / seconds).toFixed(1), (size / seconds / 1000).toFixed(1)];
        } else texts = ["–", "–"];
      }
      row.querySelector(".rate").textContent = texts[0];
      row.querySelector(".size").textContent = texts[1];
    }
  }
}

/** The newest message of the selected topic; clicking a number plots it. */
export class MessageView {
  constructor(robot, topics) {
    this.robot = robot;
    const root = document.getElementById("message");
    this.name = root.querySelector(".name");
    this.rows = root.querySelector("tbody");
    this.plots = new Plots(robot);
    topics.addEventListener("choose", (event) => this.choose(event.detail));
  }

  choose(topic) {
    this.end?.();
    this.topic = topic;
    this.newest = null;
    this.name.textContent = topic;
    this.rows.replaceChildren();
    this.cells = new Map();
    this.end = this.robot.subscribe(topic, (message) => this.read(message), { everyMs: 100 });
  }

  read(message) {
    if (message === null || this.newest) { this.newest = message ?? this.newest; return; }
    this.newest = message;
    requestAnimationFrame(() => {
      if (this.newest) this.show(this.newest); // otherwise another topic was chosen meanwhile
      this.newest = null;
    });
  }

  show(message) {
    let count = 0;
    const shown = new Set();
    for (const [path, value] of leaves(message)) {
      if (++count > MAX_ROWS) break;
      shown.add(path);
      const cell = this.cells.get(path) ?? this.row(path, value);
      cell.textContent = short(value);
    }
    for (const [path, cell] of this.cells) {
      if (shown.has(path)) continue;
      cell.parentNode.remove();
      this.cells.delete(path);
    }
  }

  row(path, value) {
    const isNumber = ["number", "bigint", "boolean"].includes(typeof value);
    const cell = element("td", { className: isNumber ? "number" : "" });
    if (isNumber) {
      const { topic } = this;
      cell.title = "plot";
      cell.onclick = () => this.plots.add(topic, path);
    }
    this.rows.append(element("tr", {}, element("td", { textContent: path }), cell));
    this.cells.set(path, cell);
    return cell;
  }
}

/** The plots; numbers that are chosen go to the last one. */
class Plots {
  constructor(robot) {
    this.robot = robot;
    const root = document.getElementById("plot");
    const first = root.querySelector(".view");
    root.querySelector(".more").onclick = () => this.use(another(first));
    this.use(first);
  }

  use(view) {
    this.legend = view.querySelector(".legend");
    this.plot = new Plot(view.querySelector("canvas"));
    this.names = new Set();
  }

  add(topic, path) {
    const { legend, names, plot } = this;
    const name = `${topic} ${path}`;
    if (names.has(name)) return;
    names.add(name);
    const colour = plot.add(name);
    const end = this.robot.subscribe(topic, (message) => {
      if (message === null) return;
      for (const [each, value] of leaves(message)) {
        if (each === path) plot.push(name, Number(value));
      }
    }, { everyMs: 20 });
    const button = element("button", { type: "button", title: "remove", textContent: `${name} ×` });
    button.style.color = colour;
    button.onclick = () => {
      end();
      plot.remove(name);
      names.delete(name);
      button.remove();
    };
    legend.append(button);
  }
}
