// What pages do with roslib 2, beside a robot of robot.py. Node runs it by roslib_node.mjs, and a
// browser by roslib_page.html.
const FIBONACCI = "example_interfaces/action/Fibonacci";

const assert = {
  ok(value, text = "it is not so") {
    if (!value) throw new Error(text);
  },
  equal(value, wanted) {
    assert.ok(value === wanted, `${value} is not ${wanted}`);
  },
  deepEqual(value, wanted) {
    assert.equal(JSON.stringify(value), JSON.stringify(wanted)); // where NaN is null
  },
  async rejects(promise, pattern = /./) {
    const error = await promise.then(() => null, (reason) => reason);
    assert.ok(error && pattern.test(String(error)), `it is not rejected for ${pattern}: ${error}`);
  },
};

/** Run all checks on a robot, and return those that failed, with the reasons. */
export async function run(ROSLIB, url, say = () => undefined) {
  const ros = new ROSLIB.Ros({ url });
  const failed = {};
  for (const [name, check] of Object.entries(checks(ROSLIB, ros))) {
    try {
      await check();
      say(`ok      ${name}`);
    } catch (error) {
      failed[name] = String(error.stack);
      say(`FAILED  ${name}: ${error.stack}`);
    }
  }
  ros.close();
  return failed;
}

const once = (make, what) =>
  new Promise((done, failed) => {
    const timer = setTimeout(() => failed(new Error(`${what}: no answer in 10 s`)), 10000);
    make(
      (value) => (clearTimeout(timer), done(value)),
      (error) => (clearTimeout(timer), failed(new Error(`${what}: ${error}`))),
    );
  });
const checks = (ROSLIB, ros) => ({
  "topics in every compression": async () => {
    for (const compression of ["none", "png", "cbor"]) {
      const topic = new ROSLIB.Topic({ ros, name: "/listener", messageType: "std_msgs/String", compression });
      const message = await once((done) => topic.subscribe(done), compression);
      assert.deepEqual(message, { data: "Hello, World" });
      topic.unsubscribe();
    }
    const raw = { ros, name: "/listener", messageType: "std_msgs/String", compression: "cbor-raw" };
    const topic = new ROSLIB.Topic(raw);
    const message = await once((done) => topic.subscribe(done), "cbor-raw");
    assert.equal(new TextDecoder().decode(message.bytes.slice(8, 20)), "Hello, World");
    topic.unsubscribe();
  },
  "typed arrays come back as they were": async () => {
    const options = { ros, name: "/scan", messageType: "sensor_msgs/LaserScan", compression: "cbor" };
    const topic = new ROSLIB.Topic(options);
    const received = once((done) => topic.subscribe(done), "scan");
    topic.publish({ header: { frame_id: "laser" }, ranges: [1, 2.5] });
    const scan = await received;
    assert.ok(scan.ranges instanceof Float32Array);
    assert.deepEqual([...scan.ranges], [1, 2.5]);
    assert.ok(scan.header.stamp.sec > 0);
    topic.unsubscribe();
  },
  "a service is called, and a failed call is told": async () => {
    const options = { ros, name: "/add_two_ints", serviceType: "example_interfaces/AddTwoInts" };
    const service = new ROSLIB.Service(options);
    const answer = await once((done, failed) => service.callService({ a: 1, b: 2 }, done, failed), "add");
    assert.deepEqual(answer, { sum: 3 });
    const none = new ROSLIB.Service({ ros, name: "/none", serviceType: "x/Y" });
    await assert.rejects(once((done, failed) => none.callService({}, done, failed), "none"), /none/);
  },
  "a goal has feedback and a result": async () => {
    const action = new ROSLIB.Action({ ros, name: "/fibonacci", actionType: FIBONACCI });
    const seen = [];
    const result = await once(
      (done, failed) => action.sendGoal({ order: 3 }, done, (told) => seen.push(told), failed),
      "goal",
    );
    assert.deepEqual(result, { sequence: [0, 1, 1, 2] });
    assert.equal(seen.length, 2);
  },
  "a goal is canceled": async () => {
    const action = new ROSLIB.Action({ ros, name: "/fibonacci", actionType: FIBONACCI });
    let id;
    const ended = once((done, failed) => {
      id = action.sendGoal({ order: 50 }, failed, () => action.cancelGoal(id), done);
    }, "cancel");
    await ended;
  },
  "all goals are canceled": async () => {
    const action = new ROSLIB.Action({ ros, name: "/fibonacci", actionType: FIBONACCI });
    const ended = once((done, failed) => {
      action.sendGoal({ order: 50 }, failed, () => action.cancelAllGoals(), done);
    }, "cancel all");
    await ended;
  },
  "a page executes goals": async () => {
    const server = new ROSLIB.Action({ ros, name: "/page", actionType: FIBONACCI });
    server.advertise(
      (goal, id) => {
        server.sendFeedback(id, { sequence: [0] });
        if (goal.order < 0) server.setFailed(id);
        else server.setSucceeded(id, { sequence: [goal.order] });
      },
      () => undefined,
    );
    const action = new ROSLIB.Action({ ros, name: "/page", actionType: FIBONACCI });
    await new Promise((done) => setTimeout(done, 300)); // an op has no answer to wait for
    const send = (order, told) =>
      once((done, failed) => action.sendGoal({ order }, done, told, failed), `goal ${order}`);
    const seen = [];
    assert.deepEqual(await send(7, (feedback) => seen.push(feedback)), { sequence: [7] });
    assert.deepEqual(seen, [{ sequence: [0] }]);
    await assert.rejects(send(-1, () => undefined));
    server.unadvertise();
  },
  "a mistake is told to a page that asks for statuses": async () => {
    ros.setStatusLevel("error", "level");
    const status = once((done) => ros.on("status", done), "status");
    ros.callOnConnection({ op: "publish", topic: "/x", msg: {} });
    assert.equal((await status).level, "error");
  },
  "the robot is described": async () => {
    const details = await once((done, failed) => ros.getMessageDetails("geometry_msgs/Twist", done, failed), "details");
    assert.deepEqual(ros.decodeTypeDefs(details).linear, { x: "double", y: "double", z: "double" });
    const nodes = await once((done, failed) => ros.getNodes(done, failed), "nodes");
    assert.ok(nodes.includes("/add_two_ints_server"));
    const servers = await once((done, failed) => ros.getActionServers(done, failed), "actions");
    assert.deepEqual(servers, ["/fibonacci"]);
    const node = await once(
      (done, failed) => ros.getNodeDetails("/add_two_ints_server", (...lists) => done(lists), failed),
      "node",
    );
    assert.ok(JSON.stringify(node).includes("/listener"));
    const type = await once((done, failed) => ros.getServiceType("/add_two_ints", done, failed), "type");
    assert.equal(type, "example_interfaces/srv/AddTwoInts");
  },
});
