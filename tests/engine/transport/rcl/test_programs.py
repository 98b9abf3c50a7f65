"""The examples with ``AIONODE_TRANSPORT=rcl``, together with the same programs of real rclpy."""

from __future__ import annotations

import os
import subprocess
import sys
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from tests.support.ros import ros_domain, ros_missing

if TYPE_CHECKING:
    from collections.abc import Iterator

pytestmark = [
    pytest.mark.skipif(bool(ros_missing()), reason=ros_missing() or "there is a ROS 2"),
    pytest.mark.timeout(120),
]

EXAMPLES = Path(__file__).parents[4] / "examples"

FOR_RCLPY = {
    "import aionode\n": "import rclpy\n",
    "from aionode import Node": "from rclpy.node import Node",
    "from aionode.interfaces.": "from ",
    "aionode.run(": "rclpy.init(); run = lambda cls: rclpy.spin(cls())\n    run(",
}
"""Code that turns an example into a program of rclpy."""


@contextmanager
def program(name: str, kind: str, folder: Path, domain_id: int) -> Iterator[subprocess.Popen[str]]:
    """Run an example with aionode, or as a program of rclpy."""
    path = EXAMPLES / name
    if kind == "rclpy":
        text = path.read_text(encoding="utf-8")
        for before, after in FOR_RCLPY.items():
            text = text.replace(before, after)
        path = folder / name
        path.write_text(text, encoding="utf-8")
    environ = {
        **os.environ,
        "AIONODE_TRANSPORT": "rcl",
        "ROS_DOMAIN_ID": str(domain_id),
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
        "PYTHONUNBUFFERED": "1",
    }
    pipe = subprocess.PIPE
    with subprocess.Popen(
        [sys.executable, "-W", "ignore", path],
        env=environ,
        stdout=pipe,
        stderr=subprocess.STDOUT,
        text=True,
    ) as process:
        try:
            yield process
        finally:
            process.terminate()


def said(process: subprocess.Popen[str], text: str) -> str:
    """Return a program's first line with a given text, or everything it has printed."""
    assert process.stdout is not None
    lines = []
    for line in process.stdout:
        lines.append(line)
        if text in line:
            return line
    return "".join(lines)


@pytest.mark.parametrize(("publishes", "listens"), [("aionode", "rclpy"), ("rclpy", "aionode")])
def test_examples_work_beside_those_of_rclpy(publishes: str, listens: str, tmp_path: Path) -> None:
    """The publisher runs on one side, the subscriber and the word counter on the other."""
    domain_id = ros_domain(60 if publishes == "rclpy" else 61)
    with ExitStack() as stack:
        subscriber, counter, publisher = (
            stack.enter_context(program(name, kind, tmp_path, domain_id))
            for name, kind in (
                ("simple_subscriber.py", listens),
                ("word_counter.py", listens),
                ("simple_publisher.py", publishes),
            )
        )
        assert 'Publishing: "Hello from ROS 2! Message count: 0"' in said(publisher, "count: 0")
        heard = said(subscriber, "Received message #2")
        assert 'Received message #2: "Hello from ROS 2! Message count:' in heard
        assert "Words so far: 14" in said(counter, "Words so far: 14")
