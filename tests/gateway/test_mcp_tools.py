"""The tools of an assistant, for clients of both revisions, in this process and over HTTP."""

from __future__ import annotations

import asyncio
import json
import re
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode.bag import BagWriter
from aionode.clock import Time
from aionode.gateway.mcp import reading
from aionode.gateway.mcp.answers import MAX_BYTES, SIZES, bounded
from aionode.gateway.mcp.names import MAX_CHARACTERS, tool_name
from aionode.gateway.mcp.tools import MAX_TYPED
from aionode.interfaces.std_msgs.msg import String
from aionode.interfaces.std_srvs.srv import Trigger
from tests.support.mcp_bench import POLICY, Bench, bench_of
from tests.support.waiting import until

LOOKING = ["list", "describe", "read", "watch", "look", "transform", "why", "log"]
LOOKING += ["get_parameters"]


async def answered(client: Any, tool: str, /, **arguments: Any) -> dict[str, Any]:
    """Return what a tool has answered; it must not have failed."""
    result = await client.call_tool(tool, arguments)
    assert not result.is_error, result.content
    values: dict[str, Any] = result.structured_content
    return values


async def refused(client: Any, tool: str, /, **arguments: Any) -> str:
    """Return why a tool has failed, as a model reads it."""
    result = await client.call_tool(tool, arguments)
    assert result.is_error, result.structured_content
    return str(result.content[0].text)


async def test_a_client_has_tools_for_what_the_policy_allows(assisted: Bench, era: str) -> None:
    """Each service and action has a tool of its own."""
    client = await assisted.connect(era)
    names = [tool.name for tool in (await client.list_tools()).tools]

    writing = ["move", "publish", "set_parameter", "call_switch", "do_count"]
    assert names == [*LOOKING, "stop", *writing]


async def test_a_robot_without_a_policy_is_only_looked_at(era: str) -> None:
    """No tool is offered whose calls would be refused."""
    async with bench_of('[[who]]\nname = "a"\nloopback = true\n[[allow]]\nsee = "/**"\n') as bench:
        client = await bench.connect(era)
        names = [tool.name for tool in (await client.list_tools()).tools]

    assert names == [*LOOKING, "stop"]


async def test_each_tool_says_what_it_may_do(assisted: Bench) -> None:
    """By these hints hosts decide whether to ask a person; the defaults are the worst case."""
    client = await assisted.connect()
    for tool in (await client.list_tools()).tools:
        hints = tool.annotations
        assert hints is not None
        each = (hints.read_only_hint, hints.destructive_hint, hints.idempotent_hint)
        expected = {
            "stop": (False, False, True),
            "set_parameter": (False, True, True),
            **dict.fromkeys(LOOKING, (True, False, True)),
        }
        assert each == expected.get(tool.name, (False, True, False)), tool.name
        assert hints.open_world_hint is (tool.name not in expected), tool.name


async def test_the_instructions_name_the_domain_and_the_nodes(assisted: Bench, era: str) -> None:
    """Desktop programs pass on no environment, and then see no robot in domain 0."""
    client = await assisted.connect(era)

    assert "domain 0, with 1 node." in str(client.instructions)


async def test_list_and_describe_show_the_users_names(assisted: Bench, era: str) -> None:
    """Without those that every node has."""
    client = await assisted.connect(era)
    listed = await answered(client, "list")
    described = await answered(client, "describe", name="/cmd_vel")

    assert listed["services"] == {"/switch": ["std_srvs/srv/SetBool"]}
    assert listed["actions"] == {"/count": ["example_interfaces/action/Fibonacci"]}
    assert described["topic"]["you_may"] == ["subscribe", "move (linear.x from -0.5 to 0.5)"]
    assert described["topic"]["subscribed_by"] == ["/base"]


async def test_read_returns_the_next_messages(assisted: Bench, era: str) -> None:
    """They are those that arrive while it waits."""
    client = await assisted.connect(era)
    async with asyncio.TaskGroup() as tasks:
        reading = tasks.create_task(answered(client, "read", topic="/text", count=2))
        await assisted.base.text.wait_for_subscribers()
        for text in ("one", "two"):
            assisted.base.text.publish(String(data=text))

    assert [each["value"]["data"] for each in reading.result()["messages"]] == ["one", "two"]


async def test_why_shows_what_led_to_a_message(monkeypatch: pytest.MonkeyPatch, era: str) -> None:
    """From callback to callback; topics that the policy hides are left out."""
    monkeypatch.setenv("AIONODE_CAUSES", "1")
    who = '[[who]]\nname = "a"\nloopback = true\n'
    sees = ('[[allow]]\nsee = "/**"\n', '[[allow]]\nsee = "/**"\n[[refuse]]\nsee = "/secret"\n')
    told = []
    for rules in sees:
        async with bench_of(who + rules) as bench:
            base = bench.base
            secret = base.create_publisher(String, "/secret", 10)

            def on_secret(message: String, base: Any = base) -> None:
                base.text.publish(message)

            base.create_subscription(String, "/secret", on_secret)
            heard = base.create_subscription(String, "/text")
            secret.publish(String())
            await heard.receive()
            client = await bench.connect(era)
            (line,) = (await answered(client, "why", name="/text"))["chains"]
            told.append(re.sub(r"[\d.]+ (us|ms|s)\b", "N", line))
            assert "no such name" in await refused(client, "why", name="/nowhere")
            if "refuse" in rules:
                assert "no such name" in await refused(client, "why", name="/secret")

    assert told == [
        "/text N ago ← base.on_secret (run N, waited N) ← /secret (base, not in a callback) N ago",
        "/text N ago ← base.on_secret (run N, waited N) ← something (not yours to see) N ago",
    ]


async def test_watch_sums_up_what_comes(
    assisted: Bench, era: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its progress reports how many there were so far."""
    over = asyncio.timeout(None)
    module = SimpleNamespace(timeout=lambda _: over, TaskGroup=asyncio.TaskGroup)
    monkeypatch.setattr(reading, "asyncio", module)
    client = await assisted.connect(era)
    heard: list[str] = []

    async def report(progress: float, total: float | None, message: str | None) -> None:
        heard.append(f"{progress < (total or 0)} {message}")

    async with asyncio.TaskGroup() as tasks:
        watching = tasks.create_task(
            client.call_tool(
                "watch", {"topic": "/cmd_vel", "seconds": 30.0}, progress_callback=report
            )
        )
        await until(lambda: assisted.base.count_subscribers("/cmd_vel") == 2)  # and its own
        move = {"topic": "/cmd_vel", "message": {"linear": {"x": 0.2}}, "seconds": 0.5}
        count = 0
        while True:
            moved = await client.call_tool("move", move)
            count += moved.structured_content["commands"] + 1  # and the stop
            if not moved.is_error:
                break
            assert "this computer was too busy" in moved.content[0].text
        await until(lambda: f"True {count} messages" in heard)
        over.reschedule(0)
    seen = watching.result().structured_content

    assert seen["messages"] == count
    assert seen["fields"]["linear.x"]["max"] == 0.2
    assert seen["fields"]["linear.x"]["last"] == 0.0


async def test_a_service_and_parameters_are_reached(assisted: Bench, era: str) -> None:
    """The fields of the request are the arguments of its tool."""
    client = await assisted.connect(era)
    response = await answered(client, "call_switch", data=False)
    await answered(client, "set_parameter", node="/base", name="speed", value=1)
    parameters = await answered(client, "get_parameters", node="/base", names=["speed"])

    assert response["response"]["value"]["message"] == "off"
    assert parameters["parameters"] == {"speed": 1.0}


async def test_publish_sends_one_message(assisted: Bench, era: str) -> None:
    """It waits until the subscription is matched."""
    client = await assisted.connect(era)
    published = await answered(client, "publish", topic="/says", message={"data": "hello"})
    await until(lambda: assisted.base.heard)

    assert assisted.base.heard == ["hello"]
    assert published["subscribers"] == 1


async def test_publish_names_move_for_a_topic_with_commands(assisted: Bench, era: str) -> None:
    """One command alone would have no stop."""
    client = await assisted.connect(era)

    assert "the tool `move`" in await refused(client, "publish", topic="/cmd_vel", message={})
    assert assisted.base.commands == []


async def test_move_is_refused_without_a_lease(assisted: Bench, era: str) -> None:
    """Nothing defines how it would stop."""
    client = await assisted.connect(era)

    assert "no lease" in await refused(client, "move", topic="/says", message={}, seconds=1)


MISTAKES = [
    ("move", {"topic": "/cmd_vel", "message": {"linear": {"z0": 1}}, "seconds": 1}, "did you mean"),
    ("move", {"topic": "/cmd_vel", "message": {"linear": {"x": 2}}, "seconds": 1}, "-0.5 and 0.5"),
    ("move", {"topic": "/cmd_vel", "message": {}, "seconds": 60}, "at most 10 s are allowed"),
    ("move", {"topic": "/cmd_vel", "message": {}}, "missing required field `seconds`"),
    ("move", {"topic": "/cmd", "message": {}, "seconds": 1}, "the policy does not allow"),
    ("read", {"topic": "/tekst"}, "did you mean /text?"),
    ("read", {"topik": "/text"}, "did you mean topic?"),
    ("read", {"topic": "/text", "timeout_sec": 0.05}, "published by /base"),
    ("list", {"kind": "tpics"}, "use one of actions, all, nodes, services, topics"),
    ("lst", {}, "did you mean list?"),
    ("describe", {"name": "/tekst"}, "did you mean /text?"),
    ("describe", {"name": "std_msgs/msg/Strin"}, "std_msgs/msg/String"),
    ("get_parameters", {"node": "/bas"}, "did you mean /base?"),
    ("get_parameters", {"node": "/base", "names": ["sped"]}, "did you mean speed?"),
    ("set_parameter", {"node": "/base", "name": "speed", "value": "fast"}, "speed"),
    ("call_switch", {"data": "yes"}, "SetBool_Request.data"),
    ("do_count", {"order": 1.5}, "order"),
    ("do_count", {"order": 1, "seconds": -1}, "above 0"),
    ("look", {}, "0 topics with images"),
    (
        "transform",
        {"target": "odom", "source": "base", "timeout_sec": 0.05},
        "no transforms",
    ),
]


@pytest.mark.parametrize(("tool", "arguments", "expected"), MISTAKES)
async def test_a_mistake_says_what_fits(
    tool: str, arguments: dict[str, Any], expected: str
) -> None:
    """The model reads it as a result, and can try again."""
    async with bench_of() as bench:
        client = await bench.connect()
        assert expected in await refused(client, tool, **arguments)
        assert bench.base.commands == []


async def test_an_endless_answer_is_cut(assisted: Bench, era: str) -> None:
    """Truncated texts and lists end with their full length."""
    client = await assisted.connect(era)
    result = await client.call_tool("call_switch", {"data": True})

    assert "(100000 characters)" in result.content[0].text
    assert len(result.model_dump_json()) < 20_000


@pytest.mark.slow
async def test_twenty_clients_at_once_are_served(assisted: Bench, era: str) -> None:
    """Each call has a session of its own."""
    clients = [await assisted.connect(era) for _ in range(20)]
    async with asyncio.TaskGroup() as tasks:
        calls = [tasks.create_task(answered(client, "list")) for client in clients]

    assert all(call.result()["services"] for call in calls)


async def test_each_call_has_a_line_in_the_audit_log(assisted: Bench, era: str) -> None:
    """Calls that only look, and calls that are refused, are logged as well."""
    client = await assisted.connect(era)
    await answered(client, "list")
    await refused(client, "publish", topic="/cmd_vel", message={})
    await answered(client, "stop")
    await until(lambda: sum(line["action"] == "tool" for line in assisted.audit) == 3)
    lines = [line for line in assisted.audit if line["action"] == "tool"]

    assert [(line["name"], line["who"], line["way"]) for line in lines] == [
        ("list", "model", "mcp"), ("publish", "model", "mcp"), ("stop", "model", "mcp"),
    ]  # fmt: skip
    assert lines[1]["result"].startswith("failed: publish /cmd_vel: refused")


async def test_many_services_have_one_tool(era: str) -> None:
    """A list of a hundred tools would fill the context of a model."""
    policy = POLICY.replace('call = "/switch"', 'call = "/**"')
    async with bench_of(policy) as bench:
        for number in range(MAX_TYPED):
            bench.base.create_service(Trigger, f"/work/w{number}", lambda _, response: response)
        client = await bench.connect(era)
        names = [tool.name for tool in (await client.list_tools()).tools]
        response = await answered(client, "call", service="/work/w7")

    assert names[-2:] == ["call", "do"]
    assert response["response"]["value"] == {"success": False, "message": ""}


async def test_a_recording_is_summed_up(era: str, tmp_path: Path) -> None:
    """Only those in the folder: no path leads out of it."""
    with BagWriter(tmp_path / "bags/run") as writer:
        for number in range(3):
            writer.write_message("/text", String(data="x"), Time(nanoseconds=number * 10**9))
    (tmp_path / "secret").mkdir()
    async with bench_of(bags=str(tmp_path / "bags")) as bench:
        client = await bench.connect(era)
        listed = await answered(client, "bag")
        summary = await answered(client, "bag", name="run")
        assert "no such bag" in await refused(client, "bag", name="../secret")
        assert "did you mean run?" in await refused(client, "bag", name="ran")

    assert listed["bags"] == ["run"]
    assert summary["topics"] == {"/text": {"type": "std_msgs/msg/String", "messages": 3}}
    assert summary["seconds"] == 2.0


# Laws

NAMES = st.from_regex(r"(/[a-z_][a-z0-9_]{0,30}){1,5}", fullmatch=True)


@given(names=st.lists(NAMES, unique=True, max_size=20))
def test_names_of_tools_are_short_and_unique(names: list[str]) -> None:
    """Each name stays the same, whatever else the robot offers."""
    made = [tool_name("call", name) for name in names]

    assert len(set(made)) == len(names)
    assert all(re.fullmatch(r"[A-Za-z0-9_-]+", name) for name in made)
    assert all(len(name) <= MAX_CHARACTERS for name in made)


class Counted(dict[str, Any]):
    """A mapping that counts how often one of its kind is read."""

    times = 0

    def items(self) -> Any:
        """Return the entries."""
        Counted.times += 1
        return super().items()


def test_what_does_not_fit_in_an_answer_is_not_read() -> None:
    """A message of millions of values would hold up the loop for seconds."""
    values = {"rows": [[Counted(at=number) for number in range(400)] for _ in range(400)]}

    bounded(values, MAX_BYTES)

    assert Counted.times < len(SIZES) * MAX_BYTES


JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.text(),
    lambda inner: st.lists(inner) | st.dictionaries(st.text(), inner),
)


@pytest.mark.slow
@given(values=st.dictionaries(st.text(), JSON), times=st.integers(1, 100))
def test_answers_are_bounded(values: dict[str, Any], times: int) -> None:
    """By their size as JSON; `json` puts a space behind each comma and colon."""
    longer = {"values": [values] * times}

    assert len(json.dumps(bounded(longer, 1000), ensure_ascii=False).encode()) < 2 * 1000
