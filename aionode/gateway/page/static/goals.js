// Goals by hand: a pose on a topic, or the goal of an action that takes a pose or a place.

import { fill, notice } from "./dom.js";

const POSE = /^geometry_msgs\/(msg\/)?PoseStamped$/;
const LIST_MS = 5000;

/** Offer where goals may go; the policy of the gateway decides, and its refusal is shown. */
export function goals(robot, topics, root) {
  const select = root.querySelector(".target");
  const arm = root.querySelector(".arm");
  const cancel = root.querySelector(".cancel");
  const progress = root.querySelector(".progress");
  const forms = new Map(); // of actions: what makes a goal of a pose, or null
  let actions = [], running = null, advertised = null;

  async function list() {
    if (!robot.isOpen || document.hidden) return;
    const { actions: names } = await robot.call("/rosapi/offered").catch(() => ({}));
    for (const name of names ?? []) {
      if (!forms.has(name)) forms.set(name, await formOf(name).catch(() => undefined));
      if (forms.get(name) === undefined) forms.delete(name); // ask again: it could not be asked
    }
    if (names) actions = names.filter((name) => forms.get(name));
    const usual = topics.named(POSE);
    fill(select, [...actions, ...(usual.length ? usual : ["/goal_pose"])], "goal goes to");
  }

  async function formOf(action) {
    const { type } = await robot.call("/rosapi/action_type", { action });
    const { typedefs } = await robot.call("/rosapi/action_goal_details", { type });
    const { fieldnames: names, fieldtypes: types } = typedefs[0];
    const field = names.find((_, index) => POSE.test(types[index]));
    if (field) return { type, goal: (frame, pose) => ({ [field]: stamped(frame, pose) }) };
    if (!names.includes("x") || !names.includes("y")) return null;
    return { type, goal: (_, { t }) => ({ x: t[0], y: t[1] }) };
  }

  async function send(frame, pose) {
    const target = select.value;
    disarm();
    if (!target) { notice("Choose where the goal goes."); return; }
    const form = actions.includes(target) ? forms.get(target) : null;
    if (!form) {
      advertise();
      robot.publish(target, stamped(frame, pose), `goal:${target}`);
      progress.textContent = `sent to ${target}`;
      return;
    }
    running?.cancel();
    const goal = robot.sendGoal(target, form.type, form.goal(frame, pose), (feedback) => {
      if (running === goal) progress.textContent = JSON.stringify(feedback).slice(0, 200);
    });
    running = goal;
    cancel.hidden = false;
    progress.textContent = "under way";
    try {
      const { status } = await goal.result;
      if (running === goal) progress.textContent = STATUS[status] ?? `ended with status ${status}`;
    } catch (error) {
      if (running === goal) progress.textContent = `failed: ${error.message}`;
    }
    if (running !== goal) return;
    running = null;
    cancel.hidden = true;
  }

  // When the topic is chosen, so that its subscriptions know the page by the time of the goal.
  function advertise() {
    const topic = select.value && !actions.includes(select.value) ? select.value : null;
    if (topic === advertised) return;
    if (advertised) robot.unadvertise(advertised);
    advertised = topic;
    if (topic) robot.advertise(topic, "geometry_msgs/PoseStamped");
  }

  function disarm() {
    arm.checked = false;
    root.querySelector("canvas").classList.remove("aiming");
  }

  arm.onchange = () => root.querySelector("canvas").classList.toggle("aiming", arm.checked);
  select.onchange = advertise;
  cancel.onclick = () => running?.cancel();
  cancel.hidden = true;
  document.getElementById("stop").addEventListener("click", () => running?.cancel());
  robot.addEventListener("state", () => {
    advertised = null; // a new connection has advertised nothing
    list();
    if (robot.isOpen) advertise();
  });
  setInterval(list, LIST_MS);
  return { send, get isArmed() { return arm.checked; } };
}

const STATUS = { 4: "succeeded", 5: "cancelled", 6: "aborted" };

function stamped(frame_id, { t: [x, y, z], q: [a, b, c, d] }) {
  return {
    header: { frame_id },
    pose: { position: { x, y, z }, orientation: { x: a, y: b, z: c, w: d } },
  };
}
