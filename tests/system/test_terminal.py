"""A member that reads the keyboard, in a real terminal."""

from __future__ import annotations

import os
import sys

import pexpect

TELEOP = """
import sys, termios, tty
before = termios.tcgetattr(0)
tty.setraw(0)
try:
    print("press", end="", flush=True)
    key = sys.stdin.read(1)
finally:
    termios.tcsetattr(0, termios.TCSADRAIN, before)
print(" got", key, flush=True)
print("in the log", file=sys.stderr)
"""

SYSTEM = f"""
import sys
from aionode.system import run
async def main(system):
    system.process("teleop", [sys.executable, "-c", {TELEOP!r}], stdin=True)
run(main)
"""


def test_a_program_that_reads_the_keyboard_has_the_terminal() -> None:
    """It can switch the terminal to raw mode, like teleop programs; its errors are in the log."""
    env = {**os.environ, "AIONODE_TRANSPORT": "local", "NO_COLOR": "1"}
    terminal = pexpect.spawn(sys.executable, ["-c", SYSTEM], env=env, timeout=30, encoding="utf-8")
    terminal.expect_exact("press")
    terminal.send("w")
    terminal.expect_exact(" got w")
    terminal.expect_exact("teleop | in the log")
    terminal.expect(pexpect.EOF)
    terminal.close()

    assert terminal.exitstatus == 0
