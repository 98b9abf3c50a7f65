"""Starts programs of this repository and waits for what they print."""

from __future__ import annotations

import os
import queue
import signal
import subprocess
import threading
import time  # noqa: TID251  # how long a process takes is what is tested
from pathlib import Path
from typing import TYPE_CHECKING, Self

from tests.support.fork_server import start

if TYPE_CHECKING:
    from collections.abc import Iterator
    from types import TracebackType

__all__ = ["ROOT", "SOON_S", "Process", "member"]

ROOT = Path(__file__).parent.parent.parent
PATIENCE_S = 40.0

SOON_S = 5.0
"""How long something that takes a moment may take on a busy machine, in seconds.

The defects that a longer time shows took ten seconds, a minute, or did not end. The times that are
promised are measured by `make faults` and `make motion`.
"""


class Process:
    """A Python program whose output can be waited for; killed at the end if it still runs.

    It has its own process group: the system does not suspend a process whose group is orphaned, as
    that of a test may be.

    Args:
        arguments: What follows `python` on the command line.
        env: Additional environment variables.
        fresh: Whether to start Python itself, for tests about its start or the end of the
            interpreter.

    Attributes:
        started_s: When it was started, by `time.monotonic`.
        lines: Each line so far, with its time.
    """

    def __init__(
        self, *arguments: str, env: dict[str, str] | None = None, fresh: bool = False
    ) -> None:
        self.started_s = time.monotonic()
        self.lines: list[tuple[float, str]] = []
        self._queue: queue.SimpleQueue[tuple[float, str]] = queue.SimpleQueue()
        self._popen = start(
            [*arguments],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            process_group=0,
            cwd=ROOT,
            env={**os.environ, "PYTHONPATH": str(ROOT), **(env or {})},
            fresh=fresh,
        )
        self._reader = threading.Thread(target=self._read)
        self._reader.start()

    @property
    def pid(self) -> int:
        """Its process id."""
        return self._popen.pid

    def _read(self) -> None:
        assert self._popen.stdout is not None
        for line in self._popen.stdout:
            self._queue.put((time.monotonic(), line.rstrip("\n")))

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.send(signal.SIGCONT)
        self._popen.kill()
        self._popen.wait()
        self._reader.join()
        for stream in (self._popen.stdin, self._popen.stdout):
            if stream is not None:
                stream.close()
        if error is not None:
            error.add_note(f"{self._popen.args!r}: {[line for _, line in self.lines]}")

    def expect(self, *texts: str) -> float:
        """Wait until each of `texts` has begun a line; return the time of the last since the start.

        Raises:
            TimeoutError: one did not appear.
        """
        missing = set(texts)
        last_s = 0.0
        for when_s, line in self._all_lines():
            for text in [text for text in missing if line.startswith(text)]:
                missing.discard(text)
                last_s = max(last_s, when_s)
            if not missing:
                return last_s - self.started_s
        raise TimeoutError(f"{missing} did not come, only {[line for _, line in self.lines]}")

    def _all_lines(self) -> Iterator[tuple[float, str]]:
        yield from list(self.lines)
        ends_s = time.monotonic() + PATIENCE_S
        while (left_s := ends_s - time.monotonic()) > 0:
            try:
                entry = self._queue.get(timeout=left_s)
            except queue.Empty:
                return
            self.lines.append(entry)
            yield entry

    def rest_so_far(self) -> list[str]:
        """Return its output so far."""
        while not self._queue.empty():
            self.lines.append(self._queue.get())
        return [line for _, line in self.lines]

    def rest_after(self, wait_s: float) -> list[tuple[float, str]]:
        """Wait, and return its output until then, with the times."""
        time.sleep(wait_s)
        self.rest_so_far()
        return self.lines

    def ask(self, line: str, answer: str) -> str:
        """Send it a line, and return what follows `answer` in the next line that begins with it.

        Raises:
            TimeoutError: there was no such line.
        """
        seen = len(self.rest_so_far())
        self.write(line)
        ends_s = time.monotonic() + PATIENCE_S
        while time.monotonic() < ends_s:
            for text in self.rest_so_far()[seen:]:
                if text.startswith(answer + " "):
                    return text.removeprefix(answer + " ")
            time.sleep(0.005)
        raise TimeoutError(f"{line!r} was not answered with {answer!r}")

    def wait(self) -> int:
        """Wait until it has ended, and return its status."""
        return self._popen.wait(PATIENCE_S)

    def rest(self) -> list[str]:
        """Return the output of a process that has ended."""
        self._reader.join()
        while not self._queue.empty():
            self.lines.append(self._queue.get())
        return [line for _, line in self.lines]

    def write(self, line: str) -> None:
        """Send it a line."""
        assert self._popen.stdin is not None
        self._popen.stdin.write(line + "\n")
        self._popen.stdin.flush()

    def send(self, number: signal.Signals) -> None:
        """Send it a signal, if it still runs."""
        if self._popen.poll() is None:
            self._popen.send_signal(number)

    def stop(self, number: signal.Signals = signal.SIGINT) -> tuple[float, int]:
        """End it with a signal; return how long that took, in seconds, and its status."""
        began_s = time.monotonic()
        self.send(number)
        status = self._popen.wait(PATIENCE_S)
        return time.monotonic() - began_s, status


def member(name: str) -> Process:
    """Return a member of the group."""
    return Process("tests/end_to_end/member.py", name)
