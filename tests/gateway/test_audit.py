"""The audit log: clients cannot forge it, fill it, or hide what others do."""

from __future__ import annotations

import array
import json
import stat
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from aionode.gateway import Identity
from aionode.gateway.session.audit import MAX_TEXT, REFUSALS_PER_SEC, append, shortened
from aionode.interfaces.geometry_msgs.msg import Twist, Vector3
from aionode.interfaces.std_msgs.msg import String
from aionode.parameter import Parameter
from aionode.testing import settle
from tests.support.gateway_bench import Bench

GUEST = Identity("guest", address="10.0.0.1")
OTHER = Identity("other", address="10.0.0.2")


@pytest.mark.parametrize(
    "text",
    ["a\nb", "\r", "\x00", "\x1b[31m", "\x7f", "\x9b31m", "\u202egnp.exe", "\u2028", "\U000e0041"],
)
async def test_a_line_has_no_character_that_a_terminal_obeys(bench: Bench, text: str) -> None:
    """The text is in the line nevertheless, escaped; a line remains one line."""
    bench.robot.audit.note(GUEST, "call", f"/{text}", arguments={"a": text}, result=text)
    await settle()
    (line,) = bench.lines
    assert line.isprintable()
    assert (json.loads(line)["name"], json.loads(line)["result"]) == (f"/{text}", text)


class Endless(list[Any]):
    """A list so long that nobody may iterate over it."""

    def __iter__(self) -> Iterator[Any]:
        """Yield its items."""
        for number in range(10_000):
            assert number < MAX_TEXT
            yield 7

    def __repr__(self) -> str:
        """Fail."""
        raise AssertionError


NESTED: list[Any] = []
for _ in range(900):
    NESTED = [NESTED]


@pytest.mark.parametrize(
    "arguments",
    [
        Endless(),
        {"a": Endless(), "b": 1},
        String(data="x" * 1_000_000),
        {"image": b"x" * 1_000_000},
        NESTED,
        10**5000,
        np.zeros(1_000_000),
        array.array("d", [0.0]) * 100_000,
        {"x" * 100_000: 1},
    ],
    ids=lambda arguments: type(arguments).__name__,
)
def test_what_is_written_of_arguments_does_not_grow_with_them(arguments: Any) -> None:
    """The time does not either: a message may contain a million numbers."""
    assert 1 < len(shortened(arguments)) <= MAX_TEXT


def test_arguments_are_written_as_messages_are_printed() -> None:
    """With all their fields, shortened."""
    message = Twist(linear=Vector3(x=0.5))
    assert shortened(message) == repr(message)
    assert shortened({"speed": 1.5, "names": ["a"]}) == "{'speed': 1.5, 'names': ['a']}"


async def test_a_client_that_asks_in_vain_hides_no_other(bench: Bench) -> None:
    """The number of logged refusals per second is limited for each client."""
    for _ in range(3 * REFUSALS_PER_SEC):
        bench.robot.audit.note(GUEST, "publish", "/noise", result="refused", code="not_allowed")
    bench.robot.audit.note(OTHER, "publish", "/cmd_vel", result="refused", code="not_allowed")
    await settle()
    assert [json.loads(line)["who"] for line in bench.lines].count("guest") == REFUSALS_PER_SEC
    assert json.loads(bench.lines[-1])["who"] == "other"


async def test_a_simulation_that_pauses_does_not_end_the_log(bench: Bench) -> None:
    """The simulated clock stands still; lines use the time of the machine."""
    bench.robot.node.set_parameters([Parameter("use_sim_time", value=True)])
    for _ in range(2):
        for _ in range(REFUSALS_PER_SEC):
            bench.robot.audit.note(GUEST, "publish", "/x", result="refused", code="not_allowed")
        await bench.advance(1.0)
    times = [json.loads(line)["time"] for line in bench.lines]
    assert len(times) == 2 * REFUSALS_PER_SEC
    assert times[-1] == pytest.approx(times[0] + 1.0)


def test_only_its_owner_can_read_the_file(tmp_path: Path) -> None:
    """From its first line on; an existing file keeps its permissions."""
    path = tmp_path / "audit.jsonl"
    append(path, "a\n")
    append(path, "b\n")
    assert path.read_text() == "a\nb\n"
    assert stat.S_IMODE(path.stat().st_mode) == 0o600
