"""Motion ends with its call: by cancelling, a timeout, its time, or the tool `stop`."""

from __future__ import annotations

import asyncio
import re
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import Any, Final

import httpx
import mcp
import pytest

from aionode.gateway import Assistant, Gateway, Policy, _stopping
from aionode.gateway._stopping import StopMotion
from aionode.gateway.session.arrivals import HAS_WAITED
from aionode.node import Node
from aionode.testing import settle
from tests.support.mcp_bench import POLICY, Bench, bench_of
from tests.support.waiting import until

MOVE: Final[tuple[str, dict[str, Any]]] = (
    "move",
    {"topic": "/cmd_vel", "message": {"linear": {"x": 0.2}}, "seconds": 9},
)
GOAL: Final[tuple[str, dict[str, Any]]] = ("do_count", {"order": 1000})
WATCH: Final[tuple[str, dict[str, Any]]] = ("watch", {"topic": "/text", "seconds": 30})

PATIENT: Final = POLICY.replace("ttl_sec = 0.3", "ttl_sec = 60.0")

MOVING: Final = {"move": MOVE, "goal": GOAL, "watch": WATCH}


def is_under_way(bench: Bench, what: str) -> bool:
    """Return whether a call has started its work."""
    if what == "watch":
        return bench.base.text.get_subscription_count() > 0
    return bool(bench.base.commands if what == "move" else bench.base.goals)


async def has_ended(bench: Bench, what: str) -> None:
    """Wait until a call has ended, and check that nothing follows its end."""
    base, clients = bench.base, bench.clients
    if what == "move":
        await until(lambda: base.commands[-1] == 0.0)
        sent = len(base.commands)
        await until(lambda: not clients.sessions)
        assert len(base.commands) == sent
    elif what == "goal":
        await until(lambda: base.goals == ["begun", "cancelled"])
    await until(lambda: not clients.sessions)
    assert not clients.robot.commands.holders()


def seconds_of(answered: Any, how: str) -> float:
    """Return how long a motion lasted that ended this way, longer where the computer is busy."""
    outcome = re.fullmatch(rf"stopped after (.*) s: {how}", answered.structured_content["outcome"])
    assert outcome is not None, answered
    return float(outcome[1])


@pytest.mark.parametrize("what", MOVING)
async def test_a_cancel_ends_it(assisted: Bench, era: str, what: str) -> None:
    """The same for a watch, which only costs the robot time.

    With a lease that does not end the motion first when this computer is busy.
    """
    assisted.use(PATIENT)
    client = await assisted.connect(era)
    tool, arguments = MOVING[what]
    async with asyncio.TaskGroup() as tasks:
        calling = tasks.create_task(client.call_tool(tool, arguments))
        await until(lambda: is_under_way(assisted, what))
        calling.cancel()

    await has_ended(assisted, what)
    await until(lambda: any(line["action"] == "tool" for line in assisted.audit))
    lines = [line for line in assisted.audit if line["action"] == "tool"]
    assert len(lines) == 1 + client.repeats
    assert lines[-1]["result"].endswith("cancelled")


@pytest.mark.parametrize("what", MOVING)
async def test_a_timeout_of_the_client_ends_it(assisted: Bench, era: str, what: str) -> None:
    """A client that no longer waits would not stop the robot either.

    With a lease that does not end the motion first when this computer is busy.
    """
    assisted.use(PATIENT)
    client = await assisted.connect(era)
    tool, arguments = MOVING[what]
    async with asyncio.TaskGroup() as tasks:
        tasks.create_task(giving_up(client, tool, arguments))
        await until(lambda: is_under_way(assisted, what))

    await has_ended(assisted, what)


async def giving_up(client: Any, tool: str, arguments: dict[str, Any]) -> None:
    """Call a tool, and wait for its answer for only a second."""
    with pytest.raises(mcp.MCPError):
        await client.call_tool(tool, arguments, read_timeout_seconds=1.0)


@asynccontextmanager
async def raw_call(gateway: object, tool: str, arguments: dict[str, Any]) -> AsyncIterator[None]:
    """Call a tool with the revision that has sessions, and close the connection, like a kill."""
    assert isinstance(gateway, Gateway)
    address = f"http://127.0.0.1:{gateway.port}/mcp"
    head = {"accept": "application/json, text/event-stream"}
    async with httpx.AsyncClient(trust_env=False, timeout=30, headers=head) as client:

        def request(method: str, number: int | None, **params: Any) -> dict[str, Any]:
            numbered = {} if number is None else {"id": number}
            return {"jsonrpc": "2.0", "method": method, "params": params, **numbered}

        hello = request(
            "initialize", 1, protocolVersion="2025-11-25", capabilities={},
            clientInfo={"name": "raw", "version": "1"},
        )  # fmt: skip
        answer = await client.post(address, json=hello)
        own = {"mcp-session-id": answer.headers["mcp-session-id"],
               "mcp-protocol-version": "2025-11-25"}  # fmt: skip
        await client.post(address, json=request("notifications/initialized", None), headers=own)
        called = request("tools/call", 2, name=tool, arguments=arguments)

        async def call() -> None:
            # Its headers come with its first event, so nothing is known here unless it is refused.
            while HAS_WAITED in (await client.post(address, json=called, headers=own)).text:
                called["id"] += 1

        async with asyncio.TaskGroup() as tasks:
            calling = tasks.create_task(call())
            yield
            calling.cancel()


@pytest.mark.parametrize("what", MOVING)
async def test_a_client_that_disconnects_ends_it_in_the_older_revision_too(what: str) -> None:
    """By specification its call continues; but nobody is left to stop the robot."""
    async with bench_of(over_http=True) as bench:
        tool, arguments = MOVING[what]
        async with raw_call(bench.served, tool, arguments):
            await until(lambda: is_under_way(bench, what))
        await has_ended(bench, what)


async def test_a_move_ends_by_its_time(assisted: Bench, era: str) -> None:
    """With the stop, which its result mentions."""
    client = await assisted.connect(era)
    tool, arguments = MOVE
    answered = await client.call_tool(tool, {**arguments, "seconds": 0.4})
    await until(lambda: assisted.base.commands[-1] == 0.0)

    assert seconds_of(answered, "done") >= 0.4
    assert (
        assisted.base.commands[:-1]
        == [pytest.approx(0.2)] * answered.structured_content["commands"]
    )


async def test_a_goal_ends_at_the_ceiling(assisted: Bench, era: str) -> None:
    """Nobody notices that a client is frozen."""
    assisted.use(POLICY + "[limits]\ngoal_sec = 0.3\n")
    client = await assisted.connect(era)
    answered = await client.call_tool(*GOAL)

    assert answered.is_error
    assert seconds_of(answered, "expired") >= 0.3
    assert answered.structured_content["status"] == "canceled"
    assert assisted.base.goals == ["begun", "cancelled"]


async def test_a_goal_reports_its_progress(assisted: Bench, era: str) -> None:
    """By its feedback; finally it returns its result."""
    client = await assisted.connect(era)
    heard: list[str] = []

    async def report(progress: float, total: float | None, message: str | None) -> None:
        heard.append(f"{progress < (total or 0)} {message}")

    answered = await client.call_tool("do_count", {"order": 40}, progress_callback=report)

    assert answered.structured_content["result"]["value"] == {"sequence": [40]}
    assert heard[0].startswith("True {'sequence': [")


@pytest.mark.parametrize("what", ["move", "goal"])
async def test_stop_ends_what_the_client_moves(assisted: Bench, era: str, what: str) -> None:
    """From the same client, while its call is in progress; the call's result says what ended it."""
    client = await assisted.connect(era)
    async with asyncio.TaskGroup() as tasks:
        calling = tasks.create_task(client.call_tool(*MOVING[what]))
        await until(lambda: is_under_way(assisted, what))
        stopped = await client.call_tool("stop", {})
    await has_ended(assisted, what)

    assert calling.result().structured_content["outcome"].endswith("by stop of model")
    name = "/cmd_vel" if what == "move" else "/count"
    assert stopped.structured_content == {"ended": [f"{name} (model)"], "still_moving": []}


async def test_stop_may_be_called_again_and_without_any_right(era: str) -> None:
    """It is always allowed."""
    policy = '[[who]]\nname = "nobody"\nloopback = true\n'
    async with bench_of(policy) as bench:
        client = await bench.connect(era)
        for _ in range(2):
            answered = await client.call_tool("stop", {})
            assert answered.structured_content == {"ended": [], "still_moving": []}


@pytest.mark.parametrize("what", ["move", "goal"])
async def test_stop_ends_the_motion_of_others_by_the_policys_word_only(what: str) -> None:
    """Otherwise the answer says who moves; if allowed, the other's call ends."""
    driver = PATIENT.replace('name = "other"\ntoken', 'name = "driver"\ntoken')
    async with bench_of(driver, over_http=True) as bench:
        client = await bench.connect()
        headers = {"Authorization": "Bearer of-another"}
        async with httpx2_client(headers) as http, asyncio.TaskGroup() as tasks:
            from mcp.client.streamable_http import streamable_http_client

            other = await connect(
                bench, tasks, streamable_http_client(bench.target(), http_client=http)
            )
            calling = tasks.create_task(other.call_tool(*MOVING[what]))
            await until(lambda: is_under_way(bench, what))
            name = "/cmd_vel" if what == "move" else "/count"

            stopped = await client.call_tool("stop", {})
            assert stopped.structured_content == {
                "ended": [], "still_moving": [{"name": name, "who": "driver"}],
            }  # fmt: skip
            assert not calling.done()

            bench.use(driver + '[[allow]]\nwho = "model"\nstop = "/**"\n')
            stopped = await client.call_tool("stop", {})
            assert stopped.structured_content == {
                "ended": [f"{name} (driver)"], "still_moving": [],
            }  # fmt: skip
            outcome = (await calling).structured_content["outcome"]
            bench.closing.set()
        assert outcome.endswith("by stop of model")


def httpx2_client(headers: dict[str, str]) -> Any:
    """Return the HTTP client that the SDK uses."""
    import httpx2

    return httpx2.AsyncClient(headers=headers, trust_env=False, timeout=30)


async def connect(bench: Bench, tasks: asyncio.TaskGroup, transport: Any) -> Any:
    """Return a client that stays connected until the bench closes."""
    connected: asyncio.Future[Any] = asyncio.get_running_loop().create_future()

    async def stay() -> None:
        async with mcp.Client(transport) as client:
            connected.set_result(client)
            await bench.closing.wait()

    tasks.create_task(stay())
    return await connected


@pytest.mark.parametrize("what", ["move", "goal"])
async def test_stop_reaches_what_the_client_moves_through_another_gateway(
    assisted: Bench, era: str, what: str
) -> None:
    """Two programs that each start their own `aionode mcp` are one identity, and so is a page."""
    async with another_assistant(assisted) as other:
        client = await assisted.connect(era)
        async with mcp.Client(other.server) as second, asyncio.TaskGroup() as tasks:
            calling = tasks.create_task(second.call_tool(*MOVING[what]))
            await until(lambda: is_under_way(assisted, what))
            stopped = await client.call_tool("stop", {})

    assert calling.result().structured_content["outcome"].endswith("by stop of model")
    name = "/cmd_vel" if what == "move" else "/count"
    assert stopped.structured_content == {"ended": [f"{name} (model)"], "still_moving": []}


async def test_what_others_move_through_another_gateway_ends_by_its_policys_word(
    assisted: Bench,
) -> None:
    """The policy that let them move determines who may end it."""
    driver = PATIENT.replace('name = "model"', 'name = "driver"')
    async with another_assistant(assisted, driver) as other:
        client = await assisted.connect()
        async with mcp.Client(other.server) as second, asyncio.TaskGroup() as tasks:
            calling = tasks.create_task(second.call_tool(*MOVE))
            await until(lambda: is_under_way(assisted, "move"))

            stopped = await client.call_tool("stop", {})
            assert stopped.structured_content == {
                "ended": [], "still_moving": [{"name": "/cmd_vel", "who": "driver"}],
            }  # fmt: skip
            assert not calling.done()

            word = '[[who]]\nname = "model"\ntoken = "t"\n[[allow]]\nwho = "model"\nstop = "/**"\n'
            other.clients.use_policy(Policy.parse(driver + word))
            stopped = await client.call_tool("stop", {})
            assert stopped.structured_content == {
                "ended": ["/cmd_vel (driver)"], "still_moving": [],
            }  # fmt: skip


async def test_a_gateway_that_does_not_answer_is_named(
    assisted: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What it moves continues, while the rest was stopped."""
    monkeypatch.setattr(_stopping, "ANSWER_SEC", 0.1)
    assisted.base.create_service(StopMotion, "/frozen/_stop", never)
    await settle()
    client = await assisted.connect()

    stopped = await client.call_tool("stop", {})

    assert stopped.structured_content == {
        "ended": [], "still_moving": [{"name": "unknown", "who": "/base does not answer"}],
    }  # fmt: skip


async def test_a_gateway_that_names_too_much_is_cut_short(assisted: Bench) -> None:
    """Anyone in the domain can offer the service; the answer for a model remains small."""
    assisted.base.create_service(StopMotion, "/liar/_stop", boasting)
    await settle()
    client = await assisted.connect()

    stopped = await client.call_tool("stop", {})

    first = stopped.structured_content["still_moving"][0]
    assert first == {"name": "unknown", "who": "/base names more than 100"}


def test_what_another_gateway_names_is_bounded() -> None:
    """In number and in length."""
    named = _stopping.told(
        [f"/{number}{'x' * 1000}" for number in range(1000)], ["y" * 1000] * 1000
    )

    assert len(named) == _stopping.MAX_TOLD
    assert {len(text) for each in named for text in each} == {_stopping.MAX_TEXT}


async def boasting(_request: Any, response: Any) -> Any:
    """Name a thousand motions, with long names."""
    response.moving = [f"/{number}{'x' * 1000}" for number in range(1000)]
    response.moving_of = ["y" * 1000] * 1000
    return response


async def test_gateways_that_were_not_asked_are_counted(
    assisted: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nobody concludes that nothing moves by them."""
    monkeypatch.setattr(_stopping, "MAX_GATEWAYS", 1)
    for number in range(3):
        assisted.base.create_service(StopMotion, f"/many/_stop_{number}", silent)
    await settle()
    client = await assisted.connect()

    stopped = await client.call_tool("stop", {})

    assert stopped.structured_content["still_moving"] == [
        {"name": "unknown", "who": "2 more gateways were not asked"}
    ]


async def silent(_request: Any, response: Any) -> Any:
    """Name nothing."""
    return response


async def never(_request: Any, _response: Any) -> Any:
    """Answer no request."""
    await asyncio.Event().wait()


@asynccontextmanager
async def another_assistant(bench: Bench, policy: str = PATIENT) -> AsyncIterator[Assistant]:
    """Yield the assistant of another program for the same robot."""
    async with (
        Node("another", context=bench.base.context) as node,
        Assistant(node, Policy.parse(policy)) as assistant,
    ):
        await settle()
        yield assistant


async def test_one_mover_at_a_time(assisted: Bench, era: str) -> None:
    """The second is told who moves, and the first continues."""
    assisted.use(PATIENT)
    first, second = await assisted.connect(era), await assisted.connect(era)
    async with asyncio.TaskGroup() as tasks:
        moving = tasks.create_task(first.call_tool(MOVE[0], {**MOVE[1], "seconds": 1}))
        await until(lambda: assisted.base.commands)
        held = await second.call_tool(*MOVE)

    assert "model commands it now, by mcp" in held.content[0].text
    assert moving.result().structured_content["outcome"].endswith("done")
