// What @foxglove/ws-protocol does, beside a robot of robot.py:
// node foxglove_checks.mjs PORT NODE_MODULES SUBPROTOCOL
import assert from "node:assert/strict";
import { createRequire } from "node:module";

const [port, modules, subprotocol] = process.argv.slice(2);
const require = createRequire(`${modules}/`);
const { FoxgloveClient } = require("@foxglove/ws-protocol");
const { WebSocket } = require("ws");

const text = new TextDecoder();
const json = (value) => new TextEncoder().encode(JSON.stringify(value));
const deadline = setTimeout(() => {
  console.error("no answer in 20 s");
  process.exit(1);
}, 20_000);

const client = new FoxgloveClient({ ws: new WebSocket(`ws://127.0.0.1:${port}`, [subprotocol]) });
client.on("error", (error) => {
  throw error;
});
client.on("status", (status) => {
  throw new Error(status.message);
});

const channels = new Map();
const services = new Map();
const values = [];
let info;
client.on("serverInfo", (event) => (info = event));
client.on("advertise", (added) => added.forEach((each) => channels.set(each.topic, each)));
client.on("advertiseServices", (added) => added.forEach((each) => services.set(each.name, each)));
client.on("parameterValues", (event) => values.push(event));

const until = async (found) => {
  let result;
  while (!(result = found())) await new Promise((resolve) => setTimeout(resolve, 20));
  return result;
};
const once = (name) => new Promise((resolve) => client.on(name, resolve));

await until(() => info);
for (const each of ["clientPublish", "services", "parameters", "connectionGraph"])
  assert(info.capabilities.includes(each), each);

// Messages of the robot
const words = await until(() => channels.get("/listener"));
assert.equal(words.schemaName, "std_msgs/msg/String");
assert.equal(words.encoding, "cdr");
let message = once("message");
const subscription = client.subscribe(words.id);
const heard = await message;
assert.equal(heard.subscriptionId, subscription);
assert.match(text.decode(heard.data), /Hello, World/);
client.unsubscribe(subscription);

// Messages of the client
const own = { topic: "/chatter", encoding: "json", schemaName: "std_msgs/msg/String" };
const channel = client.advertise(own);
const echo = client.subscribe((await until(() => channels.get("/chatter"))).id);
const back = new Promise((resolve) =>
  client.on("message", (event) => event.subscriptionId === echo && resolve(event)),
);
client.sendMessage(channel, json({ data: "hello" }));
assert.match(text.decode((await back).data), /hello/);
client.unsubscribe(echo);
client.unadvertise(channel);

// Services
const add = await until(() => services.get("/add_two_ints"));
const response = once("serviceCallResponse");
const request = { serviceId: add.id, callId: 7, encoding: "json", data: json({ a: 1, b: 2 }) };
client.sendServiceCallRequest(request);
const answer = await response;
assert.equal(answer.callId, 7);
assert.deepEqual(JSON.parse(text.decode(answer.data)), { sum: 3 });

// Parameters
client.setParameters([{ name: "/add_two_ints_server.speed", value: 2.5 }], "set");
const set = await until(() => values.find((each) => each.id === "set"));
assert.equal(set.parameters[0].value, 2.5);
client.getParameters(["/add_two_ints_server.speed"], "get");
const got = await until(() => values.find((each) => each.id === "get"));
assert.equal(got.parameters[0].value, 2.5);

// The graph
const graph = once("connectionGraphUpdate");
client.subscribeConnectionGraph();
assert((await graph).publishedTopics.some((each) => each.name === "/listener"));

const closed = once("close");
client.close();
await closed;
clearTimeout(deadline);
