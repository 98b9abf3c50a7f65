"""Pages of other origins in a real browser: what they can read, and do to the robot."""

from __future__ import annotations

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING, Any, NamedTuple

import msgspec
import pytest

from aionode.gateway import Gateway, Policy
from aionode.interfaces.geometry_msgs.msg import Twist
from aionode.node import Node
from examples.web_page_robot import Robot
from tests.support.chromium import IN_A_BROWSER, chromium
from tests.support.waiting import until
from tests.support.web_server import web_server

if TYPE_CHECKING:
    from aionode.engine.context import Context
    from tests.support.chromium import Browser

pytestmark = IN_A_BROWSER

READS = {
    "fetch": "fetch(`${base}/topics`).then(text)",
    "fetch without CORS": "fetch(`${base}/topics`, {mode: 'no-cors'}).then(text)",
    "fetch of a stream": "fetch(`${base}/topics/odom`, {headers: {Accept: 'text/event-stream'}})"
    ".then((answer) => answer.body.getReader().read())",
    "XMLHttpRequest": "new Promise((done, failed) => { const request = new XMLHttpRequest();"
    "request.onload = done; request.onerror = failed; request.open('GET', `${base}/topics`);"
    "request.send(); })",
    "EventSource": "first(new EventSource(`${base}/topics/odom`), 'onmessage')",
    "rosbridge": "first(new WebSocket(base.replace('http', 'ws')), 'onopen')",
    "foxglove": "first(new WebSocket(base.replace('http', 'ws'), 'foxglove.sdk.v1'), 'onopen')",
    "img": "element('img', 'src', '/topics/camera/image.jpeg')",
    "img with CORS": "element('img', 'src', '/topics/camera/image.jpeg', {crossOrigin: ''})",
    "img of a stream": "element('img', 'src', '/topics/camera/image.mjpeg', {crossOrigin: ''})",
    "script": "element('script', 'src', '/topics')",
    "style sheet": "element('link', 'href', '/topics', {rel: 'stylesheet'})",
    "frame": "element('iframe', 'src', '/topics').then((frame) => frame.contentDocument.body.id)",
}
"""What a page tries; each has a promise, which is rejected if nothing can be read."""

WRITES = {
    "publish": "fetch(`${base}/topics/cmd_vel`, {method: 'POST', body, headers: json})",
    "publish without asking": "fetch(`${base}/topics/cmd_vel`, {method: 'POST', body, "
    "mode: 'no-cors', headers: {'Content-Type': 'text/plain'}})",
    "beacon": "navigator.sendBeacon(`${base}/topics/cmd_vel`, new Blob([body]))",
    "form": "post(`${base}/services/robot/reset`)",
    "call": "fetch(`${base}/services/robot/reset`, {method: 'POST', body: '{}', headers: json})",
    "parameter": "fetch(`${base}/parameters/robot/floor`, {method: 'PUT', body: '2.0', "
    "headers: json})",
    "socket": "new Promise((done, failed) => { const socket = new WebSocket(base.replace('http', "
    "'ws')); socket.onerror = failed; socket.onopen = () => { socket.send(JSON.stringify({op: "
    "'publish', topic: '/cmd_vel', msg: JSON.parse(body)})); done(); }; })",
}

PAGE = """<!doctype html><title>elsewhere</title><body><script>
const base = new URLSearchParams(location.search).get("base");
const body = '{"linear": {"x": 0.25}}';
const json = { "Content-Type": "application/json" };
const text = (answer) => answer.text().then((got) => got || Promise.reject("nothing"));
const first = (source, event) => new Promise((done, failed) => {
  source[event] = () => (source.close(), done());
  source.onerror = failed;
});
const element = (tag, field, path, options = {}) => new Promise((done, failed) => {
  const made = document.createElement(tag);
  Object.assign(made, options, { onload: () => done(made), onerror: failed });
  made[field] = base + path;
  document.body.append(made);
});
const post = (action) => {
  const frame = Object.assign(document.createElement("iframe"), { name: "answer" });
  const form = Object.assign(document.createElement("form"), { action, method: "post" });
  Object.assign(form, { enctype: "text/plain", target: "answer" });
  document.body.append(frame, form);
  form.submit();
};
const attempt = async (tries) => {
  const succeeded = [];
  for (const [name, work] of Object.entries(tries))
    await Promise.resolve().then(work).then(() => succeeded.push(name), () => undefined);
  return succeeded;
};
</script>"""


class Scene(NamedTuple):
    """A robot, its gateway, and a browser with a page of another origin.

    Attributes:
        robot: The robot.
        gateway: Its gateway: programs and the page that is listed may do everything.
        commands: What the robot was told to drive.
        browser: The browser.
        port: Where the page is served: its origin is listed by its address, not as localhost.
    """

    robot: Robot
    gateway: Gateway
    commands: list[Twist]
    browser: Browser
    port: int

    async def attempt(self, host: str, tries: dict[str, str]) -> list[str]:
        """Make the page of a host try things, and return those that succeeded."""
        base = f"http://127.0.0.1:{self.gateway.port}"
        page = await self.browser.open(f"http://{host}:{self.port}/page?base={base}")
        await page.until("typeof attempt === 'function'")
        given = ", ".join(f"{name!r}: () => {work}" for name, work in tries.items())
        found: Any = await page.value(f"attempt({{{given}}})")
        return list(found)


@asynccontextmanager
async def scene(context: Context) -> AsyncIterator[Scene]:
    """Yield a robot, its gateway, and a browser."""
    commands: list[Twist] = []
    async with (
        web_server({"/page": PAGE}) as port,
        Robot(context) as robot,
        Node("wheels", context=context) as wheels,
        Gateway(robot, policy_for(f"http://127.0.0.1:{port}"), port=0) as gateway,
        chromium() as browser,
    ):
        wheels.create_subscription(Twist, "/cmd_vel", commands.append, 100)
        yield Scene(robot, gateway, commands, browser, port)


def policy_for(origin: str) -> Policy:
    """Return a policy under which pages of an origin may do everything."""
    return msgspec.structs.replace(Policy.default(allow_write=True), origins=[origin])


async def test_a_page_of_another_origin_reads_and_does_nothing(context: Context) -> None:
    """The browser of anyone who views any page may run on the robot's network."""
    async with scene(context) as whole:
        robot, gateway, commands, *_ = whole
        robot.x = 5.0
        succeeded = await whole.attempt("localhost", READS)
        written = await whole.attempt("localhost", WRITES)

        assert succeeded == []
        # with an unknown outcome
        assert set(written) <= {"publish without asking", "beacon", "form"}
        await until(lambda: gateway.stats.refused >= len(READS) + len(WRITES))
        assert commands == []
        assert robot.x == 5.0
        assert robot.settings.floor == 0.5
        assert gateway.stats.sessions == {}


@pytest.mark.slow
async def test_a_page_whose_origin_is_listed_reads_and_writes(context: Context) -> None:
    """This shows that what the other page cannot do is not refused for another reason.

    An image needs the attribute ``crossorigin``; otherwise the browser does not reveal which page
    requests it. Scripts, style sheets and frames are never answered.
    """
    async with scene(context) as whole:
        robot, _, commands, *_ = whole
        robot.x = 5.0
        succeeded = await whole.attempt("127.0.0.1", READS)
        written = await whole.attempt("127.0.0.1", WRITES)
        await until(lambda: len(commands) >= 2)

        refused = {"fetch without CORS", "img", "script", "style sheet", "frame"}
        assert set(READS) - set(succeeded) == refused
        assert {"publish", "call", "parameter", "socket"} <= set(written)
        assert robot.x < 5.0
        assert robot.settings.floor == 2.0
