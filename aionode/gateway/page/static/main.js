// The page of a robot: connects to the gateway that served it, and fills its panels.

import { cameras } from "./camera.js";
import { notice } from "./dom.js";
import { log, parameters, services } from "./nodes.js";
import { Robot } from "./robot.js";
import { Scene } from "./scene.js";
import { Teleop } from "./teleop.js";
import { MessageView, Topics } from "./topics.js";
import { frameTree, Transforms } from "./transforms.js";
import { view3d } from "./view3d.js";

const robot = new Robot(new URL(location.href.replace(/^http/, "ws").replace(/[?#].*/, "")));
const state = document.getElementById("state");
const delay = document.getElementById("delay");
const signIn = document.getElementById("sign-in");

const topics = new Topics(robot);
new MessageView(robot, topics);
cameras(robot, topics);
new Teleop(robot, topics);
const transforms = new Transforms(robot);
const scene = new Scene(robot, topics, transforms);
view3d(robot, topics, scene, transforms);
frameTree(transforms);
log(robot);
parameters(robot);
services(robot);

state.textContent = "connecting";
robot.addEventListener("state", ({ detail }) => {
  state.textContent = robot.isOpen ? "connected" : "not connected";
  state.classList.toggle("open", robot.isOpen);
  delay.textContent = "";
  signIn.hidden = !detail?.refused;
  if (detail?.reason) notice(detail.reason);
  else if (detail?.refused) robot.whyRefused().then(notice);
});
robot.addEventListener("delay", () => { delay.textContent = `${Math.round(robot.delayMs)} ms`; });
robot.addEventListener("status", ({ detail }) => notice(detail.text));

// A token after "#" in the address never leaves the browser with a request for a page.
const given = new URLSearchParams(location.hash.slice(1)).get("token")
  ?? new URLSearchParams(location.search).get("token");
if (given) {
  sessionStorage.setItem("token", given);
  history.replaceState(null, "", location.pathname);
}
robot.token = sessionStorage.getItem("token") ?? "";
signIn.onsubmit = (event) => {
  event.preventDefault();
  robot.token = document.getElementById("token").value;
  sessionStorage.setItem("token", robot.token);
  robot.connect();
};
robot.connect();
