"""Each policy rule for an assistant: what it refuses, and what it allows."""

from __future__ import annotations

import asyncio
from contextlib import AsyncExitStack
from pathlib import Path
from typing import Any, Final, NamedTuple

import httpx
import httpx2
import mcp
import pytest
from mcp.client.streamable_http import streamable_http_client

from aionode.errors import ConfigurationError, RefusedError
from aionode.gateway import Assistant, Gateway, Policy
from tests.support.mcp_bench import POLICY, Bench, bench_of
from tests.support.waiting import until

WHO: Final = '[[who]]\nname = "model"\nloopback = true\n'
SEES: Final = '[[allow]]\nsee = "/**"\n'
LEASE: Final = "lease = { ttl_sec = 0.3 }\n"


class Rule(NamedTuple):
    """A call that one policy allows and another refuses.

    Attributes:
        tool: The tool.
        arguments: Its arguments.
        allows: The rules by which it is allowed.
        refuses: The rules by which it is refused.
        code: The reason as a code for programs.
    """

    tool: str
    arguments: dict[str, Any]
    allows: str
    refuses: str
    code: str


MOVE: Final = {"topic": "/cmd_vel", "message": {"linear": {"x": 0.3}}, "seconds": 0.1}
SAY: Final = {"topic": "/says", "message": {"data": "hello"}}
SET: Final = {"node": "/base", "name": "speed", "value": 0.7}

RULES: Final = {
    "see": Rule("describe", {"name": "/text"}, SEES, "", "not_found"),
    "see a parameter": Rule(
        "get_parameters", {"node": "/base"}, SEES, '[[allow]]\nsubscribe = "/**"\n', "not_found"
    ),
    "subscribe": Rule(
        "watch", {"topic": "/cmd_vel", "seconds": 0.1},
        SEES + '[[allow]]\nsubscribe = "/cmd_vel"\n', SEES, "not_allowed",
    ),
    "publish": Rule("publish", SAY, '[[allow]]\npublish = "/says"\n', SEES, "not_allowed"),
    "publish with a lease": Rule(
        "move", MOVE, f'[[allow]]\npublish = "/cmd_vel"\n{LEASE}', SEES, "not_allowed"
    ),
    "call": Rule("call_switch", {"data": False}, '[[allow]]\ncall = "/sw*"\n', SEES, "not_allowed"),
    "goal": Rule("do_count", {"order": 0}, '[[allow]]\ngoal = "/count"\n', SEES, "not_allowed"),
    "goal by its name": Rule(
        "do", {"action": "count", "goal": {}}, '[[allow]]\ngoal = "/count"\n', SEES, "not_allowed"
    ),
    "parameter": Rule(
        "set_parameter", SET,
        SEES + '[[allow]]\nparameter = "/base:speed"\n',
        SEES + '[[allow]]\nparameter = "/base:other"\n', "not_allowed",
    ),
    "type": Rule(
        "publish", SAY, '[[allow]]\npublish = "/**"\ntype = "std_msgs/msg/String"\n',
        SEES + '[[allow]]\npublish = "/**"\ntype = "std_msgs/msg/Int8"\n', "not_allowed",
    ),
    "fields": Rule(
        "move", MOVE,
        f'[[allow]]\npublish = "/cmd_vel"\nfields = {{ "linear.x" = {{ max = 0.3 }} }}\n{LEASE}',
        f'[[allow]]\npublish = "/cmd_vel"\nfields = {{ "linear.x" = {{ max = 0.2 }} }}\n{LEASE}',
        "out_of_limits",
    ),
    "max_bytes": Rule(
        "publish", SAY, '[[allow]]\npublish = "/says"\nmax_bytes = 100\n',
        '[[allow]]\npublish = "/says"\nmax_bytes = 10\n', "too_large",
    ),
    "refuse": Rule(
        "publish", SAY, '[[allow]]\npublish = "/**"\n',
        '[[allow]]\npublish = "/**"\n[[refuse]]\npublish = "/says"\nbecause = "not this one"\n',
        "not_allowed",
    ),
    "who": Rule(
        "publish", SAY, '[[allow]]\nwho = "model"\npublish = "/says"\n',
        '[[who]]\nname = "b"\ntoken = "b"\n[[allow]]\nwho = "b"\npublish = "/says"\n',
        "not_allowed",
    ),
    "move_sec": Rule(
        "move", MOVE, f'[[allow]]\npublish = "/cmd_vel"\n{LEASE}',
        f'[[allow]]\npublish = "/cmd_vel"\n{LEASE}[limits]\nmove_sec = 0.05\n', "out_of_limits",
    ),
    "goal_sec": Rule(
        "do_count", {"order": 0, "seconds": 3}, '[[allow]]\ngoal = "/count"\n',
        '[[allow]]\ngoal = "/count"\n[limits]\ngoal_sec = 2\n', "out_of_limits",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", RULES)
async def test_a_rule_allows_and_refuses(name: str) -> None:
    """The refusal gives the reason, is in the audit log, and the robot has received nothing."""
    rule = RULES[name]
    async with bench_of(WHO + rule.refuses) as bench:
        client = await bench.connect()
        refused = await client.call_tool(rule.tool, rule.arguments)
        assert refused.is_error
        assert refused.structured_content["code"] == rule.code, refused.content
        assert not bench.base.commands
        assert not bench.base.heard
        assert not bench.base.switched
        assert not bench.base.goals
        await until(lambda: [line for line in bench.audit if line["action"] == "tool"])

        bench.use(WHO + rule.allows)
        allowed = await client.call_tool(rule.tool, rule.arguments)
        # Nothing is published here, so having waited for it suffices.
        assert not allowed.is_error or allowed.structured_content["code"] == "timeout"


async def test_clamped_fields_are_within_their_limits() -> None:
    """A rule may change a request instead of refusing it."""
    clamp = f'[[allow]]\npublish = "/cmd_vel"\n{LEASE}'
    clamp += 'fields = { "linear.x" = { max = 0.1, outside = "clamp" } }\n'
    async with bench_of(WHO + clamp) as bench:
        client = await bench.connect()
        await client.call_tool("move", MOVE)
        await until(lambda: bench.base.commands[-1:] == [0.0])

    assert max(bench.base.commands) == pytest.approx(0.1)


async def test_a_rate_slows_a_move_down_and_refuses_messages() -> None:
    """A move adapts to the rate; single messages are refused beyond it."""
    rate = f'[[allow]]\npublish = "/cmd_vel"\nrate_hz = 10\n{LEASE}'
    rate += '[[allow]]\npublish = "/says"\nrate_hz = 1\n'
    async with bench_of(WHO + rate) as bench:
        client = await bench.connect()
        moved = await client.call_tool("move", {**MOVE, "seconds": 0.55})
        first = await client.call_tool("publish", SAY)
        second = await client.call_tool("publish", SAY)

    assert moved.structured_content["outcome"].endswith("done")
    assert 4 <= moved.structured_content["commands"] <= 6
    assert not first.is_error
    assert second.structured_content["code"] == "too_fast"


async def test_a_new_policy_ends_a_move_that_it_does_not_allow(assisted: Bench, era: str) -> None:
    """While it is in progress; the robot stops."""
    client = await assisted.connect(era)
    async with asyncio.TaskGroup() as tasks:
        moving = tasks.create_task(client.call_tool("move", {**MOVE, "seconds": 9}))
        await until(lambda: assisted.base.commands)
        assisted.use(WHO + SEES)
    await until(lambda: assisted.base.commands[-1] == 0.0)

    assert "its policy has changed" in moving.result().content[0].text


async def test_the_policy_of_the_documentation_is_one() -> None:
    """It parses, and gives the tools that the page lists."""
    policy = (Path(__file__).parents[2] / "examples/gateway/assistant.toml").read_text()
    async with bench_of(policy.replace("audit_file", "# audit_file")) as bench:
        client = await bench.connect()
        tools = {tool.name: tool for tool in (await client.list_tools()).tools}

    assert "linear.x from -0.3 to 0.3" in tools["move"].description
    assert tools["move"].input_schema["properties"]["seconds"]["maximum"] == 5
    assert "publish" not in tools


# Who


async def test_a_client_is_who_its_token_says() -> None:
    """Over HTTP each request is identified by itself."""
    async with bench_of(POLICY, over_http=True) as bench:
        headers = {"Authorization": "Bearer of-another"}
        async with AsyncExitStack() as stack:
            http = await stack.enter_async_context(
                httpx2.AsyncClient(headers=headers, trust_env=False, timeout=50)
            )
            transport: Any = streamable_http_client(bench.target(), http_client=http)
            client = await stack.enter_async_context(mcp.Client(transport))
            await client.call_tool("list", {})
        await until(lambda: [line for line in bench.audit if line["action"] == "tool"])

    assert [line["who"] for line in bench.audit if line["action"] == "tool"] == ["other"]


async def test_a_wrong_token_is_refused_at_the_door() -> None:
    """As in all protocols."""
    async with (
        bench_of(POLICY, over_http=True) as bench,
        httpx.AsyncClient(trust_env=False, timeout=50) as http,
    ):
        headers = {"Authorization": "Bearer wrong"}
        answer = await http.post(bench.target(), headers=headers, json={})

    assert answer.status_code == 401


async def test_a_page_of_another_origin_is_refused() -> None:
    """A browser on the robot's machine must not give pages access."""
    async with (
        bench_of(POLICY, over_http=True) as bench,
        httpx.AsyncClient(trust_env=False, timeout=50) as http,
    ):
        headers = {"Origin": "http://evil.example"}
        answer = await http.post(bench.target(), headers=headers, json={})

    assert answer.status_code in {401, 403}


async def test_a_session_belongs_to_who_has_begun_it() -> None:
    """Knowing its number does not let anybody else use it."""
    async with (
        bench_of(POLICY, over_http=True) as bench,
        httpx.AsyncClient(trust_env=False, timeout=50) as http,
    ):
        accept = {"accept": "application/json, text/event-stream"}
        hello = {
            "jsonrpc": "2.0", "id": 1, "method": "initialize",
            "params": {"protocolVersion": "2025-11-25", "capabilities": {},
                       "clientInfo": {"name": "raw", "version": "1"}},
        }  # fmt: skip
        first = await http.post(bench.target(), headers=accept, json=hello)
        number = {"mcp-session-id": first.headers["mcp-session-id"],
                  "mcp-protocol-version": "2025-11-25"}  # fmt: skip
        ask = {"jsonrpc": "2.0", "id": 2, "method": "tools/list", "params": {}}
        own = await http.post(bench.target(), headers=accept | number, json=ask)
        token = {"Authorization": "Bearer of-another"}
        others = await http.post(bench.target(), headers=accept | number | token, json=ask)

    assert own.status_code == 200
    assert others.status_code == 404


async def test_an_assistant_is_who_it_is_started_as(node: Any) -> None:
    """By the name of a ``[[who]]``, which has to exist."""
    policy = Policy.parse(POLICY)

    assert Assistant(node, policy, name="other").identity().name == "other"
    assert Assistant(node, policy).identity().name == "model"
    with pytest.raises(ConfigurationError, match="use one of model, other"):
        Assistant(node, policy, name="nobody")
    strangers = Policy.parse('[[who]]\nname = "a"\ntoken = "a"\n')
    with pytest.raises(RefusedError):
        Assistant(node, strangers).identity()


async def test_a_name_removed_from_the_policy_is_refused(era: str) -> None:
    """A policy may change while the program is connected."""
    async with bench_of(POLICY, name="model") as bench:
        client = await bench.connect(era)
        await client.call_tool("list", {})
        bench.use('[[who]]\nname = "b"\nloopback = true\n')
        refused = await client.call_tool("list", {})

        assert refused.structured_content["code"] == "unauthorized"
        with pytest.raises(mcp.MCPError, match="no \\[\\[who\\]\\]"):
            await client.list_tools(cache_mode="bypass")


async def test_a_gateway_without_assistants_has_no_path_for_them(node: Any) -> None:
    """It has to be requested."""
    async with (
        Gateway(node, port=0) as gateway,
        httpx.AsyncClient(trust_env=False, timeout=50) as http,
    ):
        answer = await http.post(f"http://127.0.0.1:{gateway.port}/mcp", json={})
        with pytest.raises(RuntimeError, match="mcp=True"):
            gateway.tell("hello")

    assert answer.status_code == 404
