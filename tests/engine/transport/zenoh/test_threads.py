"""How many threads Zenoh has in a process of aionode."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

PROGRAM = """
import asyncio, os
from pathlib import Path
from aionode import Context, Node

async def main():
    async with (
        Context() as one,
        Context() as two,
        Node("one", context=one),
        Node("two", context=two) as node,
    ):
        await node.graph.until(lambda: len(node.graph.nodes()) == 2)
        tasks = Path("/proc/self/task").iterdir()
        pools = {(task / "comm").read_text().partition("-")[0] for task in tasks}
        print(*sorted(pools & {"acc", "app", "net", "rx", "tx"}))
        print(os.environ.get("ZENOH_RUNTIME"))

asyncio.run(main())
"""


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="only Linux names threads")
@pytest.mark.parametrize(
    ("given", "threads", "left"),
    [
        (None, "net tx", "None"),
        ("(acc: (handover: net))", "app net rx tx", "(acc: (handover: net))"),
    ],
)
def test_zenoh_has_two_pools_of_threads_unless_the_environment_says_otherwise(
    given: str | None, threads: str, left: str
) -> None:
    """Programs that this one starts do not inherit what only it needs."""
    environ = {name: text for name, text in os.environ.items() if name != "ZENOH_RUNTIME"}
    if given is not None:
        environ["ZENOH_RUNTIME"] = given

    done = subprocess.run(
        [sys.executable, "-c", PROGRAM], env=environ, capture_output=True, text=True, check=True
    )

    assert done.stdout.splitlines() == [threads, left]
