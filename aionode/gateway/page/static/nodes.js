// The log, the parameters and the services of nodes.

import { element, fill, notice } from "./dom.js";

const LEVELS = { 10: "DEBUG", 20: "INFO", 30: "WARN", 40: "ERROR", 50: "FATAL" };
const MAX_LINES = 500;
const MAX_LETTERS = 5000; // of a line
const LIST_MS = 5000;
const AT_ONCE = 8; // parameters requested at a time

export function log(robot) {
  const root = document.getElementById("log");
  const select = root.querySelector("select");
  const rows = root.querySelector("tbody");
  const place = root.querySelector(".scroll");

  function isHidden(row) {
    return Number(row.dataset.level) < Number(select.value);
  }

  select.onchange = () => { for (const row of rows.children) row.hidden = isHidden(row); };
  robot.subscribe("/rosout", (message) => {
    if (message === null) return;
    const isAtEnd = place.scrollTop + place.clientHeight > place.scrollHeight - 30;
    const time = new Date(message.stamp.sec * 1000 + message.stamp.nanosec / 1e6);
    const row = element("tr", { className: `level-${message.level}` },
      element("td", { textContent: time.toLocaleTimeString() }),
      element("td", { textContent: LEVELS[message.level] ?? message.level }),
      element("td", { textContent: `${message.name}: ${message.msg}`.slice(0, MAX_LETTERS) }));
    row.dataset.level = message.level;
    row.hidden = isHidden(row);
    rows.append(row);
    while (rows.children.length > MAX_LINES) rows.firstChild.remove();
    if (isAtEnd) place.scrollTop = place.scrollHeight;
  });
}

export function parameters(robot) {
  const root = document.getElementById("parameters");
  const select = root.querySelector("select");
  const rows = root.querySelector("tbody");

  async function list() {
    if (!robot.isOpen || document.hidden) return;
    const { nodes } = await robot.call("/rosapi/offered").catch(() => ({}));
    if (nodes) fill(select, nodes, "choose a node");
  }

  async function show() {
    rows.replaceChildren();
    const node = select.value;
    if (!node) return;
    try {
      const { names } = await robot.call("/rosapi/get_param_names", {}, 10);
      const own = names.filter((name) => name.startsWith(`${node}:`)).sort();
      for (let at = 0; at < own.length; at += AT_ONCE) {
        const some = own.slice(at, at + AT_ONCE);
        const answers = await Promise.all(some.map((name) => robot.call("/rosapi/get_param", { name })));
        if (select.value !== node) return;
        rows.append(...some.map((name, index) => row(name, answers[index].value)));
      }
      if (!own.length) rows.append(element("tr", {}, element("td", { textContent: "none" })));
    } catch (error) {
      notice(`Parameters of ${node}: ${error.message}`);
    }
  }

  function row(name, value) {
    const input = element("input", { value, spellcheck: false });
    input.onchange = async () => {
      input.className = "";
      try {
        JSON.parse(input.value);
        const answer = await robot.call("/rosapi/set_param", { name, value: input.value });
        if (answer.successful === false) throw new Error(answer.reason);
        input.className = "taken";
      } catch (error) {
        input.className = "refused";
        const hint = error instanceof SyntaxError ? "write the value as JSON, with quotes around text" : error.message;
        notice(`${name}: ${hint}`);
      }
    };
    return element("tr", {}, element("td", { textContent: name.slice(name.indexOf(":") + 1) }), element("td", {}, input));
  }

  select.onchange = show;
  robot.addEventListener("state", list);
  setInterval(list, LIST_MS);
}

export function services(robot) {
  const root = document.getElementById("services");
  const select = root.querySelector("select");
  const request = root.querySelector("textarea");
  const button = root.querySelector(".call");
  const shownType = root.querySelector(".type");
  const response = root.querySelector(".response");

  async function list() {
    if (!robot.isOpen || document.hidden) return;
    const { services: names } = await robot.call("/rosapi/offered").catch(() => ({}));
    if (names) fill(select, names, "choose a service");
  }

  async function choose() {
    const service = select.value;
    shownType.textContent = response.textContent = "";
    request.value = "{}";
    if (!service) return;
    try {
      const { type } = await robot.call("/rosapi/service_type", { service });
      const { typedefs } = await robot.call("/rosapi/service_request_details", { type });
      if (select.value !== service) return;
      shownType.textContent = type;
      request.value = JSON.stringify(template(typedefs, typedefs[0]), null, 1);
    } catch (error) {
      notice(`${service}: ${error.message}`);
    }
  }

  async function call() {
    response.textContent = "…";
    try {
      const values = await robot.call(select.value, JSON.parse(request.value), 15);
      response.textContent = JSON.stringify(values, null, 1);
    } catch (error) {
      response.textContent = `failed: ${error.message}`;
    }
  }

  select.onchange = choose;
  button.onclick = () => select.value && call();
  robot.addEventListener("state", list);
  setInterval(list, LIST_MS);
}

/** Return an example of a type for the user to fill in. */
function template(typedefs, typedef) {
  if (!typedef) return {};
  return Object.fromEntries(typedef.fieldnames.map((name, index) => {
    if (typedef.fieldarraylen[index] >= 0) return [name, []];
    const inner = typedefs.find((each) => each.type === typedef.fieldtypes[index]);
    if (inner) return [name, template(typedefs, inner)];
    return [name, example(typedef.fieldtypes[index])];
  }));
}

function example(type) {
  if (type === "string" || type === "wstring") return "";
  return type === "boolean" || type === "bool" ? false : 0;
}
