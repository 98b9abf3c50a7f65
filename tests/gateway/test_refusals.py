"""Everything that a gateway refuses, drops or reads late has a counter and a log line."""

from __future__ import annotations

import ast
import json
import logging
from functools import cache
from pathlib import Path

import pytest

from aionode import gateway as _package
from aionode.errors import MessageError, RefusedError, ServiceError
from aionode.gateway import Identity, Policy
from aionode.gateway.server.door import STATUS
from aionode.gateway.session.refusals import (
    MAX_LINES,
    MAX_PLACES,
    MAX_SUBJECTS,
    Refusal,
    Refusals,
)
from aionode.interfaces.geometry_msgs.msg import Twist
from aionode.interfaces.std_msgs.msg import String
from aionode.testing import settle
from tests.support.gateway_bench import Bench
from tests.support.gateway_server import get, raw_connect, serving
from tests.support.rosbridge import rosbridge_client
from tests.support.waiting import until

FOLDER = Path(str(_package.__file__)).parent

ERRORS = {"AionodeError", "RefusedError", "MessageError", "ServiceError", "TimeoutError", "kinds"}
"""The exceptions that concern a client, where caught."""

TOLD_BY = {"note", "note_failure", "note_refusal", "fail", "_fail", "_refuse", "_note_unreadable"}
TOLD_BY |= {"failed", "_warn", "_note_refusal"}
"""The functions that count and log them, each through `Refusals.note`."""

UNTOLD = {
    "_stopping.py:here": "its time has passed: the answer has what still moves",
    "_stopping.py:_ask": "the answer names the gateway that does not answer",
    "_stopping.py:cancelled": "the answer says that the goal has not ended",
    "foxglove/parameters.py:of": "kept for `tell`, which raises it",
    "http/offers.py:find": "a type that nobody describes is left out of a document",
    "http/offers.py:classes_of": "the same, after its time",
    "rosbridge/rosapi.py:text_of": "the text says it",
    "rosbridge/link.py:raw_id": "an id that is too long to be told back; the op has failed by it",
    "session/parameters.py:ask": "a node of the robot without parameters",
    "session/delivery/preparing.py:prepared": "raised again by `Received.once`",
    "session/command.py:_hold": "raised for who waits for the lease",
    "server/server.py:end_connections": "the gateway ends",
    "server/exchange.py:close": "its client reads no goodbye",
    "http/answers.py:_send_chunks": "the session has ended, which was said",
    "http/answers.py:_stay_alive": "some seconds have passed",
    "mcp/call.py:report": "its client does not read how far the call is; the result follows",
    "mcp/confirming.py:_elicited": "no answer is a no, which is refused and said as one",
    "mcp/events.py:reached": "its client is gone, or hears of the next event",
    "mcp/moving.py:listening": "its time has passed: the answer has the number",
    "mcp/reading.py:describe": "a node without parameters",
    "mcp/reading.py:read": "its time has passed: the answer has what came",
    "mcp/reading.py:watch": "the same",
    "mcp/reading.py:transform": "the same: the answer has the problem",
    "mcp/reading.py:log": "the same as `read`",
}
"""Functions that catch such an error silently, with the reason."""


@cache
def sources() -> dict[str, ast.Module]:
    """Return the syntax of each module, by its path."""
    return {
        str(path.relative_to(FOLDER)): ast.parse(path.read_text())
        for path in sorted(FOLDER.rglob("*.py"))
    }


def lines(caplog: pytest.LogCaptureFixture) -> list[str]:
    """Return the warnings of the gateway."""
    return [record.getMessage() for record in caplog.records if record.levelno == logging.WARNING]


# The one place


@pytest.mark.parametrize("kind", Refusal)
async def test_each_refusal_has_a_number_and_a_line_limited_in_rate(
    bench: Bench, kind: Refusal, caplog: pytest.LogCaptureFixture
) -> None:
    """The first is logged at once, and the others after 10 s, 20 s and so on."""
    refusals, who = Refusals(bench.robot.node), Identity("page", address="192.0.2.1")
    for _ in range(60):
        refusals.note(who, "rosbridge", kind, "publish /x", "a \x1b[31m reason")
        await bench.advance(1.0)

    assert refusals.counts == {kind: 60}
    assert [line.rpartition(" (")[2] for line in lines(caplog)] == [
        "192.0.2.1, rosbridge): publish /x: a \\x1b[31m reason",
        "9 more since the last line)",
        "19 more since the last line)",
    ]


async def test_a_subject_that_was_quiet_is_said_at_once(
    bench: Bench, caplog: pytest.LogCaptureFixture
) -> None:
    """A user who looks for a mistake tries repeatedly."""
    for _ in range(5):
        bench.robot.refusals.note(Identity("page"), "http", Refusal.HELD, "publish /x", "held")
        await bench.advance(30.0)

    assert len(lines(caplog)) == 5


async def test_one_client_hides_no_lines_about_another(
    bench: Bench, caplog: pytest.LogCaptureFixture
) -> None:
    """It may request any names."""
    refusals = Refusals(bench.robot.node)
    for number in range(3 * MAX_SUBJECTS):
        refusals.note(Identity("loud"), "http", Refusal.NOT_ALLOWED, f"publish /{number}", "no")
    refusals.note(Identity("quiet"), "http", Refusal.NOT_ALLOWED, "publish /x", "no")

    assert sum("loud" in line for line in lines(caplog)) == MAX_LINES
    assert sum("quiet" in line for line in lines(caplog)) == 1
    assert refusals.counts[Refusal.NOT_ALLOWED] == 3 * MAX_SUBJECTS + 1


async def test_how_many_lines_about_a_client_were_left_out_is_said_once_a_window(
    bench: Bench, caplog: pytest.LogCaptureFixture
) -> None:
    """Otherwise a flood would look no larger than its few lines."""
    refusals, loud = Refusals(bench.robot.node), Identity("loud\x1b")
    for _ in range(2):
        for number in range(MAX_LINES + 7):
            refusals.note(loud, "http", Refusal.NOT_ALLOWED, f"publish /{number}", "no")
        await bench.advance(60.0)
    refusals.note(Identity("quiet"), "http", Refusal.NOT_ALLOWED, "publish /x", "no")

    left_out = [line for line in lines(caplog) if "were omitted" in line]
    assert len(left_out) == 2
    assert all(line.startswith(r"gateway: loud\x1b: 7 more lines in 10 s") for line in left_out)


async def test_refusals_without_room_for_a_line_are_in_the_number_of_its_next(
    bench: Bench, caplog: pytest.LogCaptureFixture
) -> None:
    """An omitted line must not count as a written one."""
    refusals, loud = Refusals(bench.robot.node), Identity("loud")
    refusals.note(loud, "http", Refusal.HELD, "publish /x", "held")
    await bench.advance(10.0)
    for number in range(MAX_LINES):
        refusals.note(loud, "http", Refusal.NOT_ALLOWED, f"publish /{number}", "no")
    for _ in range(3):
        refusals.note(loud, "http", Refusal.HELD, "publish /x", "held")
    await bench.advance(10.0)
    refusals.note(loud, "http", Refusal.HELD, "publish /x", "held")

    assert lines(caplog)[-1].endswith("publish /x: held (3 more since the last line)")


async def test_a_client_without_a_name_hides_no_lines_about_one_elsewhere(
    bench: Bench, caplog: pytest.LogCaptureFixture
) -> None:
    """All unknown clients have the name ""; one host has many addresses in an IPv6 network."""
    refusals = Refusals(bench.robot.node)
    for number in range(3 * MAX_LINES):
        loud = Identity("", address=f"2001:db8::{number:x}")
        refusals.note(loud, "http", Refusal.UNAUTHORIZED, f"GET /{number}", "no token")
    quiet = Identity("", address="192.0.2.1")
    refusals.note(quiet, "http", Refusal.UNAUTHORIZED, "GET /0", "no token")

    assert sum("2001:db8::" in line for line in lines(caplog)) == MAX_LINES
    assert sum("192.0.2.1" in line for line in lines(caplog)) == 1


async def test_clients_without_names_at_many_places_have_a_bounded_number_of_lines(
    bench: Bench, caplog: pytest.LogCaptureFixture
) -> None:
    """Addresses cost an attacker nothing, and each would get its own lines."""
    refusals = Refusals(bench.robot.node)
    for number in range(2 * MAX_PLACES):
        each = Identity("", address=f"10.0.{number // 256}.{number % 256}")
        refusals.note(each, "http", Refusal.UNAUTHORIZED, "GET /", "no token")
    refusals.note(Identity("known"), "http", Refusal.HELD, "publish /x", "held")

    assert len(lines(caplog)) == MAX_PLACES + MAX_LINES + 1
    await bench.advance(10.0)
    refusals.note(Identity("known"), "http", Refusal.TOO_OLD, "publish /x", "old")
    assert sum("unknown clients: 90 more lines" in line for line in lines(caplog)) == 1


# All callers


@pytest.mark.slow
def test_each_kind_of_refusal_happens_somewhere() -> None:
    """A kind that nothing records would be dead."""
    codes, names = set(), set()
    for name, tree in sources().items():
        for node in ast.walk(tree):
            if isinstance(node, ast.Attribute):
                names.add(node.attr)
            elif isinstance(node, ast.Constant) and not name.endswith(("refusals.py", "door.py")):
                codes.add(node.value)

    dead = [kind for kind in Refusal if kind.value not in codes and kind.name not in names]
    assert dead == []


def test_each_code_of_a_refusal_is_a_kind() -> None:
    """Each kind has an HTTP status."""
    assert {Refusal.of(RefusedError("x", "y", code)).value for code in STATUS} == set(STATUS)
    assert Refusal.of(MessageError("x", "y")) is Refusal.INVALID
    assert Refusal.of(ServiceError("x", "y")) is Refusal.FAILED


def test_nothing_that_fails_for_a_client_is_left_out_without_a_word() -> None:
    """Each place that catches such an error raises another one, or counts and logs it."""
    silent = {
        f"{name}:{function.name}"
        for name, tree in sources().items()
        for function in ast.walk(tree)
        if isinstance(function, ast.FunctionDef | ast.AsyncFunctionDef)
        for node in own_nodes(function)
        if (isinstance(node, ast.ExceptHandler) and catches(node.type) and not tells(node))
        or (isinstance(node, ast.Call) and is_suppress(node) and any(map(catches, node.args)))
    }

    assert silent == set(UNTOLD)


def own_nodes(function: ast.AST) -> list[ast.AST]:
    """Return the nodes of a function, without those of nested functions."""
    found: list[ast.AST] = []
    waiting = list(ast.iter_child_nodes(function))
    while waiting:
        node = waiting.pop()
        if not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            found.append(node)
            waiting.extend(ast.iter_child_nodes(node))
    return found


def catches(node: ast.AST | None) -> bool:
    """Return whether an expression names such an error."""
    return node is not None and any(
        isinstance(each, ast.Name) and each.id in ERRORS for each in ast.walk(node)
    )


def is_suppress(node: ast.Call) -> bool:
    """Return whether a call is one of `contextlib.suppress`."""
    return getattr(node.func, "id", getattr(node.func, "attr", "")) == "suppress"


def tells(handler: ast.ExceptHandler) -> bool:
    """Return whether a handler raises, or counts and logs."""
    for node in ast.walk(handler):
        if isinstance(node, ast.Raise):
            return True
        if isinstance(node, ast.Call):
            name = getattr(node.func, "attr", getattr(node.func, "id", ""))
            if name in TOLD_BY:
                return True
    return False


# What a user sees


OPS: list[tuple[str, dict[str, object], Refusal, str]] = [
    ("publish", {"topic": "/cmd_vel", "type": "geometry_msgs/TwistStamped"}, Refusal.INVALID,
     "publish: publish.type: /cmd_vel has the type geometry_msgs/msg/Twist, not"),
    ("publish", {"topic": "/cmd_vel", "type": "geometry_msgs/Twist", "msg": {"x": 1}},
     Refusal.INVALID, "publish: geometry_msgs/msg/Twist"),
    ("subscribe", {"topic": "/none"}, Refusal.FAILED, "subscribe: "),
    ("subscribe", {"topic": "/x", "type": "no/Such"}, Refusal.FAILED, "subscribe: "),
    ("call_service", {"service": "/none"}, Refusal.FAILED, "call_service /none: "),
    ("call_service", {"service": "/rosapi/none"}, Refusal.INVALID, "call_service /rosapi/none: "),
    ("send_action_goal", {"action": "/none"}, Refusal.FAILED, "send_action_goal /none: "),
    ("fly", {}, Refusal.INVALID, "op: 'fly' is unknown"),
    ("auth", {}, Refusal.IGNORED, "auth: it has no effect"),
]  # fmt: skip


@pytest.mark.parametrize(("op", "fields", "kind", "said"), OPS)
async def test_an_op_that_fails_is_in_the_log_of_the_gateway(
    bench: Bench,
    op: str,
    fields: dict[str, object],
    kind: Refusal,
    said: str,
    caplog: pytest.LogCaptureFixture,
) -> None:
    """A roslib page that requests no statuses is not notified, and nor was the operator."""
    bench.node.create_subscription(Twist, "/cmd_vel", lambda _: None, 10)
    await settle()
    async with rosbridge_client(bench.robot) as page:
        page.send(op, **fields)
        await bench.advance(2.0)

    assert bench.robot.refusals.counts == {kind: 1}
    assert any(said in line for line in lines(caplog)), lines(caplog)


@pytest.mark.parametrize(
    ("op", "field"), [("subscribe", "topic"), ("call_service", "service"), ("fly\n[ERROR]", "x")]
)
async def test_a_refusal_is_one_line_whatever_the_client_calls_things(
    bench: Bench, op: str, field: str, caplog: pytest.LogCaptureFixture
) -> None:
    """A name with a new line would look like another line of the log; some errors have several."""
    async with rosbridge_client(bench.robot) as page:
        page.send(op, **{field: "/a b\n[ERROR] [1.0] [robot]: \x1b[31mon fire"})
        await bench.advance(2.0)

    (line,) = lines(caplog)
    assert "\n" not in line
    assert "\x1b" not in line


async def test_a_half_of_a_pair_of_characters_is_in_the_log(
    bench: Bench, caplog: pytest.LogCaptureFixture
) -> None:
    """It is not valid text, but JavaScript produces it when it cuts a name in the middle."""
    async with rosbridge_client(bench.robot) as page:
        page.send_frame('{"op":"publish","topic":"/x","type":"std_msgs/String",'
                               '"msg":{"data":"\\ud800"}}')  # fmt: skip
        await settle()

    assert bench.robot.refusals.counts[Refusal.INVALID] == 1
    assert lines(caplog)


async def test_a_gateway_that_only_reads_names_the_option(
    caplog: pytest.LogCaptureFixture,
) -> None:
    """It is the first refusal that a new user meets."""
    async with serving() as gateway, raw_connect(gateway, "/", {}, []) as page:
        topic = {"topic": "/cmd_vel", "type": "geometry_msgs/Twist"}
        await page.send(json.dumps({"op": "advertise", **topic}))
        await until(lambda: gateway.stats.refusals == {"not_allowed": 1})

    (line,) = lines(caplog)
    assert line.startswith("gateway: local (127.0.0.1, rosbridge): advertise: publish /cmd_vel: ")
    assert "--allow-write" in line


async def test_more_clients_than_there_may_be_are_in_the_log(
    caplog: pytest.LogCaptureFixture,
) -> None:
    """A page only sees that its connection failed."""
    policy = '[[who]]\nname = "local"\nloopback = true\n[limits]\nclients = 1'
    async with serving(Policy.parse(policy)) as gateway, raw_connect(gateway, "/", {}, []):
        await until(lambda: gateway.stats.sessions)
        assert (await get(gateway, "/topics")).status_code == 429

    (line,) = lines(caplog)
    start = "gateway: local (127.0.0.1, connect): connection: refused: there are already 1 "
    assert line.startswith(start)


async def test_a_driver_that_is_refused_because_of_another_is_in_the_log(
    caplog: pytest.LogCaptureFixture,
) -> None:
    """Otherwise the robot seems not to listen."""
    rule = "[[allow]]\npublish = '/cmd_vel'\nlease = { ttl_sec = 60 }"
    who = "[[who]]\nname = 'local'\nloopback = true\n"
    async with (
        serving(Policy.parse(who + rule)) as gateway,
        raw_connect(gateway, "/", {}, []) as first,
        raw_connect(gateway, "/", {}, []) as second,
    ):
        command = {"op": "publish", "topic": "/cmd_vel", "type": "geometry_msgs/Twist"}
        await first.send(json.dumps(command))
        await until(lambda: gateway.stats.holders)
        for _ in range(5):
            await second.send(json.dumps(command))
        await until(lambda: gateway.stats.refusals.get("held", 0) == 5)

    assert len([line for line in lines(caplog) if "local commands it now" in line]) == 1


async def test_messages_for_a_slow_client_are_counted_and_said(
    bench: Bench, caplog: pytest.LogCaptureFixture
) -> None:
    """They are not if the client wants only the newest."""
    words = bench.node.create_publisher(String, "/words", 100)
    async with bench.session() as session:
        for depth in (1, 3):
            await session.subscribe(
                "/words", frame=lambda received: received.message.data, key=depth, depth=depth
            )
        for _ in range(10):
            words.publish(String(data="x"))
        await settle()

    assert bench.robot.refusals.counts == {Refusal.SLOW: 7}
    (line,) = lines(caplog)
    assert "/words: messages are dropped: it reads more slowly than they arrive" in line


async def test_a_client_that_sends_too_fast_is_said_to_be_late(
    caplog: pytest.LogCaptureFixture,
) -> None:
    """Its data is processed later than it was sent."""
    policy = '[[who]]\nname = "local"\nloopback = true\n[limits]\nframes_per_sec = 20'
    async with serving(Policy.parse(policy)) as gateway, raw_connect(gateway, "/", {}, []) as page:
        for _ in range(25):
            await page.send('{"op":"set_level","level":"none"}')
        await until(lambda: gateway.stats.refusals.get("late", 0) >= 1)

    assert "it sends more than 20 a second, so it is read more slowly" in caplog.text
