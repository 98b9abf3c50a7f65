"""Every rule of a policy, allowed and refused, over every protocol: one table, and its exceptions.

A cell of the table is one request of one client over one protocol. It shows what the robot did,
what the client was told in the form of its protocol, and the line of the audit log.
"""

from __future__ import annotations

import json
from collections.abc import AsyncIterator, Callable, Coroutine, Iterator
from contextlib import AsyncExitStack, asynccontextmanager
from dataclasses import dataclass
from functools import partial
from typing import Any, Final, cast

import pytest

from aionode.clock import S_TO_NS
from aionode.engine.context import Context
from aionode.errors import PolicyFileError, RefusedError
from aionode.gateway import Gateway, Identity, Policy, Rule, Session
from aionode.gateway.policy.policy import LIMITED
from aionode.gateway.policy.policy import VERBS as ALL_VERBS
from aionode.gateway.server.door import STATUS
from aionode.gateway.session import audit as _audit
from aionode.gateway.session.arrivals import HAS_WAITED
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.geometry_msgs.msg import TwistStamped
from aionode.interfaces.nav_msgs.srv import GetPlan
from aionode.interfaces.rcl_interfaces.msg import SetParametersResult
from aionode.interfaces.std_msgs.msg import String
from aionode.interfaces.tf2_msgs.action import LookupTransform
from aionode.node import Node
from aionode.parameter import Parameter
from aionode.qos import DurabilityPolicy, QoSProfile
from aionode.testing import settle
from tests.support.ways_in import WAYS, Answer, Ask, Way, until, way_in

VERBS: Final = tuple(verb for verb in ALL_VERBS if verb not in {"stop", "asset"})
"""All verbs about names of the graph, except that of assistants, whose rules have their own test:
test_mcp_policy.py. Those about files are in test_assets.py."""

USED: Final = tuple(verb for verb in VERBS if verb != "see")
SENT: Final = ("publish", "call", "goal")
"""The verbs with which a client sends a message."""

CLASSES: Final[dict[str, tuple[Any, Any]]] = {
    "subscribe": (TwistStamped, String),
    "publish": (TwistStamped, String),
    "call": (GetPlan, AddTwoInts),
    "goal": (LookupTransform, Fibonacci),
    "advertise": (GetPlan, AddTwoInts),
}
"""The type of most names, and another one."""

NUMBERS: Final = {
    "publish": "twist.linear.x",
    "call": "tolerance",
    "goal": "timeout.sec",
    "parameter": "value",
}
TEXTS: Final = {
    "publish": "header.frame_id",
    "call": "start.header.frame_id",
    "goal": "fixed_frame",
}


@dataclass(frozen=True)
class Row:
    """One key of a rule, for each verb that may have it.

    A client asks for a name that ends with ``open``, which has to pass, and for one that ends with
    ``closed``, which the rest of the row is about.

    Attributes:
        key: The key of a rule that it shows.
        verbs: The verbs.
        rule: Further lines of the ``[[allow]]``.
        refuse: The last line of a ``[[refuse]]`` for the second name.
        code: The code of the refusal; empty if the second ask passes, too.
        reason: A part of its text.
        number: The number that is sent with the second name.
        arrives: The number that reaches the robot.
        text: A text that is sent with it.
        stamp_sec: The stamp of what is sent, in seconds; 0 for none.
        who: The client that asks.
    """

    key: str
    verbs: tuple[str, ...] = USED
    rule: str = ""
    refuse: str = ""
    code: str = "not_allowed"
    reason: str = "the policy does not allow"
    number: int = 1
    arrives: int = 1
    text: str = ""
    stamp_sec: int = 0
    who: str = "staff"


LEASE: Final = "lease = { ttl_sec = 60, max_age_sec = 30 }"
ROWS: Final[dict[str, Row]] = {
    "names": Row("names"),
    "type": Row("type", tuple(CLASSES), "type = 'TYPE'"),
    "refuse": Row("refuse", refuse="because = 'the arm is out'", reason="the arm is out"),
    "hidden": Row("see", refuse="because = 'hidden'", reason="hidden"),
    "see": Row("see", ("see",), reason="the policy does not show it"),
    "who": Row("who", rule="who = 'staff'", who="guest"),
    "rate": Row("rate_hz", rule="rate_hz = 0.001", code="too_fast",
                reason="more often than 0.001 times a second"),
    "size": Row("max_bytes", SENT, "max_bytes = 300", code="too_large", text="a" * 300,
                reason="more than 300 bytes"),
    "field": Row("fields", tuple(NUMBERS), "fields = { 'NUMBER' = { min = 0, max = 5 } }",
                 code="out_of_limits", number=9, reason="is not within 0 and 5"),
    "clamp": Row("fields", tuple(NUMBERS), number=9, arrives=5, code="",
                 rule="fields = { 'NUMBER' = { min = 0, max = 5, outside = 'clamp' } }"),
    "finite": Row("finite", tuple(NUMBERS), "finite = true", code=""),
    "ask": Row("ask", rule="ask = true", code="not_confirmed", reason="a person has said no"),
    "nobody": Row("ask", rule="ask = true", code="not_confirmed", reason="there is nobody to ask"),
    "held": Row("lease", ("publish",), LEASE, code="held", reason="pilot commands it now"),
    "taken": Row("lease", ("publish",), code="held", reason="pilot commands it now"),
    "stamp": Row("lease", ("publish",), LEASE, code="too_old", stamp_sec=5, reason="s old"),
    "arrival": Row("lease", ("publish",), f"{LEASE}\nask = true", code="too_old",
                   reason="s old, at most 30 s are allowed"),
    "silence": Row("lease", ("publish",), "lease = { ttl_sec = 0.6, max_age_sec = 30 }", code=""),
}  # fmt: skip
"""The table. A lease is refused where another client holds it, also to a client whose rule has no
lease (`taken`), and for a command that is old by its stamp or since it arrived; a client that is
silent is followed by the stop."""

NO_CELLS: Final[dict[tuple[str, str], str]] = {
    ("http", "advertise"): "a request has an answer, and gets no requests",
    ("events", "publish"): "events go to the client",
    ("events", "call"): "a service has one response, which is not a stream",
    ("events", "parameter"): "a parameter has one value, which is not a stream",
    ("events", "see"): "lists are not streams",
    ("events", "advertise"): "events go to the client",
    ("foxglove", "goal"): "the protocol has no actions, and their services are not announced",
    ("foxglove", "advertise"): "in the protocol clients offer no services",
}
"""The verbs that a protocol does not have, with the reason."""

NO_KEYS: Final[dict[str, tuple[str, ...]]] = {
    "type": ("parameter",),
    "max_bytes": ("see", "subscribe", "parameter", "advertise"),
    "fields": ("see", "subscribe", "advertise"),
    "finite": ("see", "subscribe", "advertise"),
    "lease": ("see", "subscribe", "call", "goal", "parameter", "advertise"),
    "rate_hz": ("see",),
    "ask": ("see",),
}
"""The keys of a rule that have no meaning for a verb: a policy with such a rule is not loaded."""

KINDS: Final = {"rosbridge": "rosbridge", "foxglove": "foxglove", "http": "http", "events": "http"}
"""The protocols, as named in the audit log."""

UNTOLD: Final = {
    ("foxglove", "hidden", "subscribe"): "channels have numbers, and the client is told of none",
    ("foxglove", "hidden", "call"): "services have numbers, and the client is told of none",
}
"""Things that a client has no means to request."""

NOT_FOUND: Final = {("http", "hidden", "subscribe"), ("events", "hidden", "subscribe")}
"""Requests answered as if the name did not exist, so that there is no refusal to log."""

SEEN: Final = """
[[allow]]
who = "seers"
see = ["/see/*/open", "/robot"]
[[allow]]
who = "seers"
see = "/see/type/*"
type = "geometry_msgs/msg/TwistStamped"
[[refuse]]
see = "/robot:see.closed"
"""


def cells() -> Iterator[tuple[str, str]]:
    """Yield each row with each of its verbs."""
    yield from ((row, verb) for row, given in ROWS.items() for verb in given.verbs)


def names_of(row: str, verb: str) -> tuple[str, str]:
    """Return the names with which a row allows and refuses a verb."""
    start = f"/robot:{row}." if verb in {"see", "parameter"} else f"/{verb}/{row}/"
    return f"{start}open", f"{start}closed"


def type_of(row: str, verb: str, *, is_closed: bool = False) -> Any:
    """Return the class for one of these names; None for a parameter."""
    return CLASSES[verb][row == "type" and is_closed] if verb in CLASSES else None


def policy_text() -> str:
    """Return the policy of the whole table."""
    lines = ["[limits]\nsubscriptions = 1000\nadvertised = 1000\n"]
    for name in ("pilot", "staff", "guest", "seer"):
        groups = ["seers"] if name == "seer" else ["users"]
        lines.append(f"[[who]]\nname = {name!r}\ntoken = {name!r}\ngroups = {groups}\n")
    lines.append(f"[[allow]]\nwho = 'pilot'\npublish = '/**'\n{LEASE}\n")
    for row, verb in cells():
        lines += rules_of(row, verb)
    lines.append("[[allow]]\nwho = 'users'\nsee = '/**'\n")
    return "".join([*lines, SEEN])


def rules_of(row: str, verb: str) -> list[str]:
    """Return the rules of a row for a verb."""
    given = ROWS[row]
    opened, closed = names_of(row, verb)
    glob = opened if row == "names" else f"{opened.removesuffix('open')}*"
    rule = given.rule.replace("NUMBER", NUMBERS.get(verb, ""))
    if verb in CLASSES:
        rule = rule.replace("TYPE", CLASSES[verb][0].__ros_type__)
    who = "" if "who" in rule else "who = 'users'\n"
    lines = [f"[[allow]]\n{who}{verb} = {glob!r}\n{rule}\n"]
    if given.refuse:
        refused = "see" if given.key == "see" else verb
        lines.append(f"[[refuse]]\n{refused} = {closed!r}\n{given.refuse}\n")
    return lines


# The robot


class Robot(Node):
    """A robot with something for each cell, which records what was done to it."""

    def __init__(self, context: Context) -> None:
        super().__init__("robot", context=context)
        self.done: dict[tuple[str, str], list[float]] = {}
        for row, verb in cells():
            for name in names_of(row, verb):
                self._add(verb, name, type_of(row, verb, is_closed=name.endswith("closed")))
        for name in ("see.open", "see.closed"):
            self.declare_parameter(name, 0.0)
        for kind in ("topic", "type"):
            self.create_publisher(TwistStamped, f"/see/{kind}/open", 1)
            self.create_publisher(String, f"/see/{kind}/closed", 1)
        for end in ("open", "closed"):
            self.create_service(GetPlan, f"/see/service/{end}", lambda _: GetPlan.Response())
            self.create_action_server(Fibonacci, f"/see/action/{end}", lambda _: Fibonacci.Result())
        self.add_on_set_parameters_callback(self._set)

    def _add(self, verb: str, name: str, cls: Any) -> None:
        """Offer the target of a verb."""
        match verb:
            case "subscribe":
                latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
                self.create_publisher(cls, name, latched).publish(cls())
            case "publish":
                self.create_subscription(cls, name, partial(self._note, verb, name), 10)
            case "call":
                self.create_service(cls, name, partial(self._answer, name, cls))
            case "goal":
                self.create_action_server(cls, name, partial(self._execute, name, cls))
            case "parameter":
                self.declare_parameter(name.partition(":")[2], 0.0)

    def _note(self, verb: str, name: str, message: Any) -> None:
        for part in NUMBERS[verb].split("."):
            message = getattr(message, part, 1.0)
        self.done.setdefault((verb, name), []).append(float(message))

    def _answer(self, name: str, cls: Any, request: Any) -> Any:
        self._note("call", name, request)
        return cls.Response()

    def _execute(self, name: str, cls: Any, goal: Any) -> Any:
        self._note("goal", name, goal.request)
        goal.succeed()
        return cls.Result()

    def _set(self, parameters: list[Parameter]) -> SetParametersResult:
        for each in parameters:
            self.done.setdefault(("parameter", f"/robot:{each.name}"), []).append(each.value)
        return SetParametersResult(successful=True)

    def effects(self, verb: str, name: str) -> list[float]:
        """Return what was done with a name: the numbers that arrived, or 1 for each endpoint."""
        if verb == "subscribe":
            return [1.0] * self.count_subscribers(name)
        if verb == "advertise":
            return [1.0] * self.count_services(name)
        return list(self.done.get((verb, name), ()))


def values_for(verb: str, number: float, text: str = "", stamp_sec: int = 0) -> Any:
    """Return the values that a client sends."""
    match verb:
        case "publish":
            header = {"frame_id": text, **({"stamp": {"sec": stamp_sec}} if stamp_sec else {})}
            return {"header": header, "twist": {"linear": {"x": number}}}
        case "call":
            return {"start": {"header": {"frame_id": text}}, "tolerance": number}
        case "goal":
            return {"timeout": {"sec": number}, "fixed_frame": text}
    return float(number)


# The table


class LateTime:
    """A steady clock that is a minute ahead: a person has thought about an answer for so long."""

    def __init__(self, time_base: Any) -> None:
        self._time_base = time_base

    def steady_ns(self) -> int:
        """Return its time in nanoseconds."""
        return int(self._time_base.steady_ns()) + 60 * S_TO_NS


class Table:
    """The cells of one protocol, filled one after another.

    Attributes:
        failed: What is wrong in which cell.
        lines: The lines of the audit log.
    """

    def __init__(
        self,
        way: str,
        robot: Robot,
        gateway: Gateway,
        pilot: Session,
        clients: dict[str, Way],
    ) -> None:
        self.failed: dict[str, str] = {}
        self.lines: list[dict[str, Any]] = []
        self._pilot = pilot
        self._way = way
        self._robot = robot
        self._gateway = gateway
        self._clients = clients

    async def fill(self, row: str, verb: str) -> None:
        """Request what a row allows, and what it refuses."""
        opened, closed = names_of(row, verb)
        given = ROWS[row]
        self._gateway.clients.robot.ask = self._person
        self._gateway.clients.robot.time_base = self._robot.context.time_base
        who = "seer" if verb == "see" else "staff"
        await self._attempt(f"{verb}, {row}, open", self._pass(row, verb, opened, who))
        if row == "silence":
            return  # the first name has shown everything, and takes time
        if row == "nobody":
            self._gateway.clients.robot.ask = None
        if not given.code:
            work = self._pass(row, verb, closed, who, given.number, given.arrives)
        elif (self._way, row, verb) in UNTOLD:
            work = self._learn_nothing(closed)
        else:
            if row == "rate":
                await self._ask(row, verb, closed, who)
            if row in {"held", "taken"}:
                await self._command(closed)
            work = self._refuse(row, verb, closed, "seer" if verb == "see" else given.who)
        await self._attempt(f"{verb}, {row}, closed", work)

    async def names(self, who: str) -> set[str]:
        """Return the names shown to a client."""
        return await self._clients[who].names()

    async def _attempt(self, cell: str, work: Coroutine[Any, Any, None]) -> None:
        try:
            await work
        except (AssertionError, TimeoutError) as error:
            self.failed[f"{self._way}, {cell}"] = str(error) or repr(error)

    async def _ask(
        self, row: str, verb: str, name: str, who: str, number: float = 1, **sent: Any
    ) -> Answer:
        """Make a client send a request."""
        self.lines.clear()
        before = len(self._robot.effects(verb, name))
        cls = type_of(row, verb, is_closed=name.endswith("closed"))
        type_name = "" if cls is None else cls.__ros_type__
        is_usual = cls is type_of(row, verb)
        values = values_for(verb, number, **sent) if is_usual else {}

        def is_done() -> bool:
            return len(self._robot.effects(verb, name)) > before

        return await self._clients[who].do(Ask(verb, name, type_name, values, is_done))

    async def _pass(
        self, row: str, verb: str, name: str, who: str, number: int = 1, arrives: int = 1
    ) -> None:
        """Send an allowed request: it reaches the robot, the client is answered, it is logged."""
        before = len(self._robot.effects(verb, name))
        answer = await self._ask(row, verb, name, who, number)
        assert answer == Answer(), answer
        if verb in NUMBERS:
            effects = await until(lambda: self._robot.effects(verb, name)[before:])
            assert effects[0] == arrives, effects
        if row == "silence":
            await until(lambda: self._robot.effects(verb, name)[-1] == 0.0)
        if verb != "see":  # reading is not logged
            line = await self._line(verb, name, lambda line: "code" not in line)
            assert line["who"] == who
            assert line["result"] in {"ok", "succeeded"}, line
            assert line["way"] == KINDS[self._way], line
            assert ("arguments" in line) is (verb in NUMBERS), line
            assert ("duration_ms" in line) is (verb in {"call", "goal", "parameter"}), line

    async def _refuse(self, row: str, verb: str, name: str, who: str) -> None:
        """Send a refused request: nothing reaches the robot, the client is told, it is logged."""
        given = ROWS[row]
        before = self._robot.effects(verb, name)
        sent = {"text": given.text, "stamp_sec": given.stamp_sec}
        answer = await self._ask(row, verb, name, who, given.number, **sent)
        await settle()
        assert len(self._robot.effects(verb, name)) <= len(before)  # requests leave nothing behind
        if (self._way, row, verb) in NOT_FOUND:
            assert answer.code == "404 not_found"
            return
        assert f"{verb} {name}: refused: " in answer.refusal, answer
        assert given.reason in answer.refusal, answer
        if self._way in {"http", "events"}:
            assert answer.code == f"{STATUS[given.code]} {given.code}"
        line = await self._line(verb, name, lambda line: "code" in line)
        assert line["who"] == who
        assert line["code"] == given.code, line
        assert line["way"] == KINDS[self._way], line
        assert line["result"].startswith("refused: ")
        assert given.reason in line["result"], line

    async def _learn_nothing(self, name: str) -> None:
        """Check that a client learns nothing of a name."""
        assert name not in await self._clients["staff"].names()

    async def _line(self, verb: str, name: str, fits: Callable[[dict[str, Any]], bool]) -> Any:
        """Wait for the audit log's line about a request."""
        names = {name, name.partition(":")[0]}
        return await until(
            lambda: next(
                (
                    line
                    for line in self.lines
                    if line["action"] == verb and line["name"] in names and fits(line)
                ),
                None,
            )
        )

    async def _command(self, topic: str) -> None:
        """Make another client command a topic; again if the gateway was stalled meanwhile."""
        values = values_for("publish", 1)
        while True:
            try:
                await self._pilot.publish(topic, values, TwistStamped.__ros_type__)
                break
            except RefusedError as error:
                if HAS_WAITED not in str(error):
                    raise
        await until(lambda: self._robot.effects("publish", topic))

    async def _person(self, _who: Identity, _verb: str, name: str, _message: Any) -> bool:
        """Approve or refuse; for `arrival` approve a minute later."""
        if name == names_of("arrival", "publish")[1]:
            robot = self._gateway.clients.robot
            robot.time_base = cast("Any", LateTime(robot.node.context.time_base))
            return True
        return name.endswith("open")


@asynccontextmanager
async def table_of(context: Context, way: str) -> AsyncIterator[Table]:
    """Yield the table of one protocol: a robot, its gateway, and a client for each identity."""
    async with AsyncExitStack() as stack:
        robot = await stack.enter_async_context(Robot(context))
        node = await stack.enter_async_context(Node("gateway", context=context))
        policy = Policy.parse(policy_text())
        gateway = await stack.enter_async_context(Gateway(node, policy, port=0))
        pilot = Identity("pilot", frozenset({"users"}))
        session = await stack.enter_async_context(gateway.clients.session(pilot, "program"))
        clients = {
            who: await stack.enter_async_context(
                way_in(way, gateway.port, {"Authorization": f"Bearer {who}"})
            )
            for who in ("staff", "guest", "seer")
        }
        table = Table(way, robot, gateway, session, clients)
        robot.create_subscription(
            String, "/gateway/audit", lambda line: table.lines.append(json.loads(line.data)), 1000
        )
        yield table


@pytest.mark.slow
@pytest.mark.parametrize("way", WAYS)
async def test_every_rule_lets_pass_and_refuses(
    context: Context, way: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The robot, the client and the audit log agree, in each cell."""
    monkeypatch.setattr(_audit, "REFUSALS_PER_SEC", 10_000)
    async with table_of(context, way) as table:
        for row, verb in cells():
            if (way, verb) not in NO_CELLS:
                await table.fill(row, verb)

    assert not table.failed, "\n".join(f"{cell}: {why}" for cell, why in table.failed.items())


@pytest.mark.parametrize("way", [way for way in WAYS if way != "events"])
async def test_no_list_has_what_is_hidden(context: Context, way: str) -> None:
    """Lists contain neither its name nor its type, nor do the endpoints of a node."""
    async with table_of(context, way) as table:
        shown = await table.names("seer")

    opened = {f"/see/{kind}/open" for kind in ("topic", "type", "service")}
    actions = set() if way == "foxglove" else {"/see/action/open"}  # it has no actions
    assert {name for name in shown if not name.startswith("/robot:")} == {
        "/robot",
        *opened,
        *actions,
    }
    assert "/robot:see.open" in shown
    assert "/robot:see.closed" not in shown


def test_the_table_has_every_key_of_a_rule() -> None:
    """A new key has no row yet, so this test fails."""
    keys = {row.key for row in ROWS.values()}
    verbs = {
        key: {verb for row in ROWS.values() if row.key == key for verb in row.verbs} for key in keys
    }

    assert keys | set(ALL_VERBS) | {"because"} == {*Rule.__struct_fields__, "names", "refuse"}
    assert {key: set(VERBS) - set(verbs) for key, verbs in LIMITED.items()} == {
        key: set(verbs) for key, verbs in NO_KEYS.items()
    }
    for key in sorted(keys - {"see"}):
        missing = set(USED) - verbs[key] - set(NO_KEYS.get(key, ()))
        assert not missing, f"{key}: no row for {missing}"


@pytest.mark.parametrize(
    ("key", "verb"), [(key, verb) for key, verbs in NO_KEYS.items() for verb in verbs]
)
def test_a_key_that_means_nothing_for_a_verb_is_a_mistake(key: str, verb: str) -> None:
    """A reader of the file would believe that it has an effect."""
    values = {
        "type": "'a/msg/B'",
        "max_bytes": "1",
        "fields": "{ x = { max = 1 } }",
        "finite": "false",
        "lease": "{}",
        "rate_hz": "1",
        "ask": "true",
    }
    with pytest.raises(PolicyFileError, match=key):
        Policy.parse(f"[[allow]]\n{verb} = '/**'\n{key} = {values[key]}\n")
