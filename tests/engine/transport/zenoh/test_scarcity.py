"""Sessions in processes that may open few descriptors, or start few threads."""

from __future__ import annotations

import resource
import subprocess
import sys

import pytest

from aionode.engine.context import Context
from aionode.engine.transport.zenoh._defects import scarcity
from aionode.errors import TransportError
from aionode.node import Node
from tests.support.peers import isolated_environment

pytestmark = [
    pytest.mark.one_loop,
    pytest.mark.skipif(not sys.platform.startswith("linux"), reason="only Linux lists descriptors"),
]

PROGRAM = """
import asyncio
from aionode import Node
async def main():
    async with Node("node"):
        print("running")
asyncio.run(main())
"""


@pytest.mark.processes
@pytest.mark.parametrize(
    "count", [8, 23, *(pytest.param(count, marks=pytest.mark.slow) for count in (14, 17, 29))]
)
def test_few_descriptors_are_an_error_that_names_the_limit(count: int) -> None:
    """Zenoh panics with some of these numbers, and aborts the process with others."""

    def limit() -> None:
        resource.setrlimit(resource.RLIMIT_NOFILE, (count, count))

    done = subprocess.run(
        [sys.executable, "-c", PROGRAM],
        env=isolated_environment(),
        capture_output=True,
        text=True,
        timeout=40,
        check=False,
        preexec_fn=lambda: resource.setrlimit(
            resource.RLIMIT_NOFILE, (count, count)
        ),  # the test starts no thread
    )

    assert done.returncode == 1
    assert f"descriptors (files and sockets) of its {count}" in done.stderr
    assert "ulimit -n" in done.stderr.splitlines()[-1]


async def test_few_threads_are_an_error_that_names_the_limit(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Zenoh's runtime aborts the process if it gets none."""
    monkeypatch.setattr(scarcity, "of_container", lambda: 12)
    monkeypatch.setattr(scarcity, "can_start_threads", lambda count: count < 12)

    with pytest.raises(TransportError, match="the limit is 12 for its user or its container"):
        async with Node("node", context=Context(domain_id=42)):
            pass


def test_threads_are_tried_out() -> None:
    """Other processes of the user or container count against the same limit."""
    assert scarcity.can_start_threads(16)
