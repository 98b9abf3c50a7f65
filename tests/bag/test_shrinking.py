"""The shortest piece of a bag with which a test still fails."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

import msgspec
import pytest

from aionode import bag
from aionode.bag.replaying.replay import PIECE_VARIABLE, Piece
from aionode.bag.replaying.shrinking import fails, shrink
from aionode.clock import Time
from aionode.errors import BagError
from aionode.interfaces.std_msgs.msg import Float64
from aionode.node import Node

if TYPE_CHECKING:
    from pathlib import Path

S = 1_000_000_000


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """A bag of 60 seconds with a message of each of five topics per second."""
    with bag.BagWriter(tmp_path / "run") as writer:
        for second in range(60):
            for topic in "abcde":
                message = Float64(data=float(second))
                writer.write_message(f"/{topic}", message, Time(nanoseconds=second * S))
    return tmp_path / "run"


async def test_the_piece_has_only_what_the_failure_needs(path: Path) -> None:
    """Two of five topics, and three of sixty seconds."""

    async def fail(piece: Piece) -> bool:
        return (
            {"/b", "/d"} <= set(piece.topics) and piece.start_ns <= 40 * S and piece.end_ns > 43 * S
        )

    piece = await shrink(path, fail)

    assert piece.topics == ["/b", "/d"]
    assert 39.9 * S < piece.start_ns <= 40 * S
    assert 43 * S < piece.end_ns < 43.1 * S


async def test_a_command_that_succeeds_is_an_error(path: Path) -> None:
    """Otherwise the search would end with the whole bag, as if all of it were needed."""

    async def succeed(_: Piece) -> bool:
        return False

    with pytest.raises(BagError, match="the command succeeds with the whole bag"):
        await shrink(path, succeed)


async def test_a_replay_reads_the_piece_in_the_environment(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The test names its bag as usual, and no file is written."""
    piece = Piece(path=str(path.resolve()), start_ns=30 * S, end_ns=33 * S, topics=["/b"])
    monkeypatch.setenv(PIECE_VARIABLE, msgspec.json.encode(piece).decode())
    seen: list[float] = []

    async with bag.replay(path) as run:
        node = Node("node", context=run.context)
        for topic in "ab":
            node.create_subscription(Float64, f"/{topic}", lambda msg: seen.append(msg.data), 10)
        assert run.clock.now().nanoseconds == 30 * S
        await run.play()

    assert seen == [30.0, 31.0, 32.0]


@pytest.mark.processes
@pytest.mark.one_loop
async def test_the_status_of_a_command_says_whether_it_fails(path: Path) -> None:
    """A pytest run that collects no test is not a failed test."""
    piece = Piece(path=str(path), start_ns=0, end_ns=1, topics=[])

    def leaving(status: int) -> list[str]:
        return [sys.executable, "-c", f"raise SystemExit({status})"]

    assert await fails(leaving(1), piece)
    assert not await fails(leaving(0), piece)
    assert await fails(leaving(5), piece)
    assert not await fails([*leaving(5), "pytest"], piece)
