"""Rules with ``ask``: a person at the client approves or refuses, or there is nobody to ask."""

from __future__ import annotations

from collections.abc import AsyncIterator
from typing import Any

import mcp_types
import pytest

from tests.support.mcp_bench import POLICY, Bench, bench_of
from tests.support.waiting import until

ASKING = POLICY.replace("lease = ", "ask = true\nlease = ").replace(
    'call = "/switch"', 'ask = true\ncall = "/switch"'
)


@pytest.fixture(params=["in process", "http"])
async def asking(request: pytest.FixtureRequest) -> AsyncIterator[Bench]:
    """Yield a robot whose policy requires asking a person before anything moves."""
    async with bench_of(ASKING, over_http=request.param == "http") as bench:
        yield bench


class Person:
    """A person at a client, who gives one answer.

    Attributes:
        asked: The questions.
    """

    def __init__(self, action: str) -> None:
        self.asked: list[str] = []
        self._action = action

    async def __call__(self, context: Any, params: Any) -> Any:  # as the SDK calls it
        """Answer."""
        self.asked.append(params.message)
        return mcp_types.ElicitResult(action=self._action, content={})  # type: ignore[arg-type]  # a word


CALLS = {
    "call": ("call_switch", {"data": False}),
    "goal": ("do_count", {"order": 0}),
    "parameter": ("set_parameter", {"node": "/base", "name": "speed", "value": 0.1}),
    "move": ("move", {"topic": "/cmd_vel", "message": {"linear": {"x": 0.1}}, "seconds": 0.3}),
}


@pytest.mark.parametrize("what", CALLS)
async def test_yes_lets_it_pass(asking: Bench, era: str, what: str) -> None:
    """One question for each call, even if the call is repeated with the answer."""
    person = Person("accept")
    client = await asking.connect(era, elicitation_callback=person)
    answered = await client.call_tool(*CALLS[what])

    assert not answered.is_error, answered.content
    assert 1 <= len(person.asked) <= 1 + client.repeats
    assert person.asked[0].startswith("Allow model to ")


@pytest.mark.parametrize("action", ["decline", "cancel"])
@pytest.mark.parametrize("what", CALLS)
async def test_no_refuses_it(asking: Bench, era: str, what: str, action: str) -> None:
    """As a result of the call, and the robot is not touched."""
    client = await asking.connect(era, elicitation_callback=Person(action))
    answered = await client.call_tool(*CALLS[what])

    assert answered.structured_content["code"] == "not_confirmed"
    assert "a person has said no" in answered.content[0].text
    assert not asking.base.commands
    assert not asking.base.switched
    assert not asking.base.goals


@pytest.mark.parametrize("what", CALLS)
async def test_a_client_that_cannot_ask_is_told_so(asking: Bench, era: str, what: str) -> None:
    """The model can tell its user."""
    client = await asking.connect(era)
    answered = await client.call_tool(*CALLS[what])

    assert answered.is_error
    assert answered.structured_content["code"] == "not_confirmed"
    await until(lambda: any(line.get("code") == "not_confirmed" for line in asking.audit))


async def test_an_answer_counts_once_and_for_its_arguments_only(asking: Bench) -> None:
    """A client cannot reuse an approval for another call."""
    person = Person("accept")
    client = await asking.connect(elicitation_callback=person)
    server = asking.clients
    await client.call_tool("call_switch", {"data": False})
    await client.call_tool("call_switch", {"data": False})

    assert 2 <= len(person.asked) <= 2 + client.repeats
    assert server.sessions == []


async def test_the_programs_own_way_to_ask_comes_first(era: str) -> None:
    """A button on the robot is more reliable than a window of the client."""
    asked: list[str] = []

    async def ask(identity: Any, verb: str, name: str, message: Any) -> bool:
        asked.append(f"{identity.name} {verb} {name}")
        return True

    async with bench_of(ASKING, ask=ask) as bench:
        person = Person("decline")
        client = await bench.connect(era, elicitation_callback=person)
        answered = await client.call_tool(*CALLS["move"])

    assert not answered.is_error
    assert asked == ["model publish /cmd_vel"]
    assert person.asked == []
