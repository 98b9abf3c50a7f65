"""Dropped data of others: nothing is dropped without a counter and a log line."""

from __future__ import annotations

import ast
import asyncio
import logging
from functools import cache
from pathlib import Path

import pytest

from aionode.clock import S_TO_NS
from aionode.engine import transport
from aionode.engine.context import Context
from aionode.engine.transport.drops import SUBJECTS, Drop, Drops
from aionode.engine.transport.local import LocalTransport
from aionode.interfaces.std_msgs.msg import String
from aionode.node import Node

FOLDER = Path(str(transport.__file__)).parent

OTHER_WARNINGS = {
    "rcl/_services.py": "our requests: the middleware never takes one of that size",
    "link/_connection.py": "a link ends, and Zenoh takes over; what our publishers lose by that",
    "link/_manager.py": "no link to another context, and Zenoh is used instead",
    "link/_transport.py": "no links at all, and Zenoh is used instead",
    "zenoh/session/session.py": "no port to meet others on",
    "zenoh/bridge/_state.py": "our endpoint whose name a bridge does not survive",
    "zenoh/endpoints/publisher.py": "our messages that were not delivered, in stats.dropped",
}
"""Files with warnings about anything other than data of others, and the subjects."""

UNREADABLE = {"DecodeError", "FrameError"}
TOLD_BY = {"note", "note_malformed", "_reject", "refuse", "reject", "close", "fail"}


@cache
def sources() -> dict[str, ast.Module]:
    """Return the syntax of each module, by its path."""
    return {
        str(path.relative_to(FOLDER)): ast.parse(path.read_text())
        for path in sorted(FOLDER.rglob("*.py"))
        if "_defects" not in path.parts
    }


@pytest.mark.parametrize("drop", Drop)
def test_each_drop_has_a_number_and_a_line_limited_in_rate(
    drop: Drop, caplog: pytest.LogCaptureFixture
) -> None:
    """The first is logged at once, the others after 10 s, 20 s and so on."""
    now_ns = 0
    drops = Drops(now_ns=lambda: now_ns)
    for _ in range(60):
        drops.note(drop, "/scan", "a \x1b[31m detail")
        now_ns += S_TO_NS

    assert drops.of(drop) == {"/scan": 60}
    assert drops.totals() == {drop.name.lower(): 60}
    first, *others = [record.getMessage() for record in caplog.records]
    assert [line.rpartition(" (")[2] for line in others] == [
        "9 more since the last line)", "19 more since the last line)",
    ]  # fmt: skip
    for line in (first, *others):
        assert line.startswith("/scan: ")
        assert "\x1b" not in line


def test_a_number_that_comes_at_once_is_said(caplog: pytest.LogCaptureFixture) -> None:
    """A queue may report a hundred at a time."""
    Drops().note(Drop.BUSY_LOOP, "/image", "32 MiB", count=150)

    assert "(150 at once)" in caplog.text


def test_only_so_many_subjects_are_told_apart(caplog: pytest.LogCaptureFixture) -> None:
    """Other processes may invent any number of names."""
    drops = Drops()
    caplog.set_level(logging.CRITICAL)
    for number in range(2 * SUBJECTS):
        drops.note(Drop.MALFORMED, f"/t{number}")

    assert len(drops.of(Drop.MALFORMED)) == SUBJECTS + 1
    assert drops.of(Drop.MALFORMED).total() == 2 * SUBJECTS


@pytest.mark.slow
def test_each_drop_happens_somewhere() -> None:
    """A kind that is never recorded is useless."""
    named = {
        node.attr
        for name, tree in sources().items()
        for node in ast.walk(tree)
        if isinstance(node, ast.Attribute) and name != "drops.py"
    }

    assert [drop for drop in Drop if drop.name not in named] == []


def test_nothing_unreadable_is_left_out_without_a_word() -> None:
    """Each place that catches it records it, or informs the sender or the caller."""
    silent = [
        f"{name}:{handler.lineno}"
        for name, tree in sources().items()
        for handler in ast.walk(tree)
        if isinstance(handler, ast.ExceptHandler)
        and handler.type is not None
        and UNREADABLE & names_in(handler.type)
        and not TOLD_BY & called_in(handler)
        and not any(isinstance(node, ast.Raise) for node in ast.walk(handler))
    ]

    assert silent == []


def test_every_other_warning_of_the_transports_is_known() -> None:
    """A new place that drops data of others has to use `Drops`."""
    warning = {
        name
        for name, tree in sources().items()
        for node in ast.walk(tree)
        if isinstance(node, ast.Attribute) and node.attr == "warning" and name != "drops.py"
    }

    assert warning == set(OTHER_WARNINGS)


def test_a_context_tells_what_all_of_its_transports_dropped() -> None:
    """Several may share a counter, which counts only once."""
    drops = Drops()

    class Shared(LocalTransport):
        @property
        def drops(self) -> Drops:
            return drops

    context = Context(transport=[Shared(), Shared(), LocalTransport()])
    assert context.dropped == {}
    drops.note(Drop.MALFORMED, "/scan")
    drops.note(Drop.REQUESTS, "/add", "32 MiB", count=2)

    assert context.dropped == {"malformed": 1, "requests": 2}


async def test_a_context_counts_messages_with_replaced_texts() -> None:
    """They arrived, but altered; callbacks of every transport get them alike."""
    heard: asyncio.Queue[str] = asyncio.Queue()
    async with Context(transport="local") as context, Node("n", context=context) as node:
        publisher = node.create_publisher(String, "battery", 10)
        node.create_subscription(String, "battery", lambda msg: heard.put_nowait(msg.data), 10)
        publisher.publish(b"\0\1\0\0\6\0\0\x0080 \xb0C\0")

        assert await heard.get() == "80 \N{REPLACEMENT CHARACTER}C"
        assert context.dropped == {"replaced_texts": 1}


def names_in(node: ast.AST) -> set[str]:
    """Return the names in an expression."""
    return {each.id for each in ast.walk(node) if isinstance(each, ast.Name)}


def called_in(node: ast.AST) -> set[str]:
    """Return the names of the methods called in some code."""
    return {
        each.func.attr
        for each in ast.walk(node)
        if isinstance(each, ast.Call) and isinstance(each.func, ast.Attribute)
    }
