"""Programs in processes of their own, for what a test cannot do in its process."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import textwrap
import threading
from typing import Any, Self

from tests.support.fork_server import start

__all__ = ["PREAMBLE", "Program"]

PREAMBLE = """
import asyncio, sys, time
import aionode
from aionode.testing import local_context
from aionode.interfaces.std_msgs.msg import String
context = local_context()
"""


class Program:
    """A Python program in a process of its own, which reports when it is ready.

    Args:
        parts: The text after `PREAMBLE`; each part may be indented.
        before: A command that is given the program's, such as ``nohup``.
        options: Of `fork_server.start`, or, with `before`, of `subprocess.Popen`.
    """

    def __init__(self, *parts: str, before: tuple[str, ...] = (), **options: Any) -> None:
        text = "\n".join([PREAMBLE, *map(textwrap.dedent, parts)])
        pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
        self.process: subprocess.Popen[str]
        if before:
            command = [*before, sys.executable, "-c", text]
            self.process = subprocess.Popen(command, text=True, **pipes | options)
        else:
            options = {"stdin": subprocess.DEVNULL, "env": os.environ, **pipes, **options}
            self.process = start(["-c", text], **options)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.process.kill()
        self.process.communicate()

    def wait_until_ready(self) -> None:
        """Wait for the line that says so."""
        assert self.process.stdout is not None
        assert self.process.stdout.readline() == "ready\n"

    def send(self, *numbers: signal.Signals, pause_sec: float = 0.0) -> None:
        """Send it signals, with a pause between each two."""
        for index, number in enumerate(numbers):
            if index:
                threading.Event().wait(pause_sec)
            self.process.send_signal(number)

    def end(self) -> tuple[int, str, str]:
        """Wait for the end; return status, output and errors."""
        out, err = self.process.communicate(timeout=20)
        return self.process.returncode, out, err
