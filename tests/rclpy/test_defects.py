"""The defects that `aionode.rclpy._defects` works around are still there."""

from __future__ import annotations

import subprocess
import sys

XACRO = "import sys, xacro; sys.argv = ['xacro', '/no/arm.urdf']; xacro.main()"


def test_xacro_names_no_file_that_is_not_there() -> None:
    """If this fails, xacro imports the module whose error it handles."""
    command = [sys.executable, "-c", XACRO]
    ended = subprocess.run(command, check=False, capture_output=True, text=True, timeout=60)

    assert "module 'xml' has no attribute 'parsers'" in ended.stderr
