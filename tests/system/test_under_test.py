"""A whole system in a test."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

import pytest

from aionode import Node
from aionode.errors import ConfigurationError, NotReadyError
from aionode.interfaces.std_msgs.msg import String
from aionode.system import NodeExists, System
from aionode.testing import system_under_test

if TYPE_CHECKING:
    from pathlib import Path

TALKER = """
import aionode
from aionode.interfaces.std_msgs.msg import String
class Talker(aionode.Node):
    def __init__(self):
        super().__init__("talker")
        self.words = self.create_publisher(String, "/words", 10)
        self.create_timer(0.1, lambda: self.words.publish(String(data="hello")))
aionode.run(Talker)
"""


async def test_a_file_is_started_in_a_domain_of_its_own_and_is_ready(tmp_path: Path) -> None:
    """The test talks to it by a node in the same context."""
    (tmp_path / "talker.py").write_text(TALKER)
    description = tmp_path / "robot.py"
    description.write_text(
        "import sys\n"
        "from aionode.system import NodeExists\n"
        "async def main(system):\n"
        f"    talker = [sys.executable, {str(tmp_path / 'talker.py')!r}]\n"
        "    system.process('talker', talker, ready=NodeExists('/talker', timeout_sec=30.0))\n"
    )

    async with (
        system_under_test(description) as system,
        Node("listener", context=system.context) as node,
    ):
        assert system.context.domain_id >= 102
        assert (await node.create_subscription(String, "/words").receive()).data == "hello"


async def test_a_member_that_does_not_come_fails_with_its_last_lines() -> None:
    """That is what the person who reads the failure of the test needs."""

    async def main(system: System) -> None:
        code = "print('no camera'); import time; time.sleep(100)"
        system.process(
            "camera", [sys.executable, "-S", "-c", code], ready=NodeExists("/camera", 0.5)
        )

    with pytest.raises(NotReadyError, match=r"node /camera.*\n  no camera"):
        async with system_under_test(main):
            pass


async def test_a_file_without_main_is_refused(tmp_path: Path) -> None:
    """The text says what a file needs."""
    file = tmp_path / "empty.py"
    file.write_text("")
    with pytest.raises(ConfigurationError, match="async def main"):
        async with system_under_test(file):
            pass
