"""Detects that nodes use what differs between runs: the machine's clocks, and random numbers.

Since Python 3.12, `sys.monitoring` reports which functions are called: each call site is looked at
once, which costs next to nothing. A call site that later calls something else goes unnoticed. In
3.11 there is only `sys.setprofile`, which is invoked for every call and interferes with other
tools, so nothing is watched there.
"""

from __future__ import annotations

import datetime as dt
import gc
import os
import random
import sys
import time  # noqa: TID251  # it is looked for, not read
import uuid
import warnings
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Self

if TYPE_CHECKING:
    from types import CodeType

__all__ = ["MachineUse", "MachineUseWarning"]

CLOCKS: Final[tuple[Any, ...]] = (
    *(time.time, time.time_ns, time.monotonic, time.monotonic_ns, time.perf_counter),
    *(time.perf_counter_ns, time.clock_gettime, time.localtime, time.gmtime, time.ctime),
    *(dt.datetime.now, dt.datetime.utcnow, dt.datetime.today),  # noqa: TID251  # as above
    dt.date.today,
)
CHANCE: Final[tuple[Any, ...]] = (
    *(os.urandom, uuid.uuid1, uuid.uuid4),
    *(random.random, random.randint, random.uniform, random.gauss, random.choice),
    *(random.randrange, random.shuffle, random.sample, random.getrandbits),
)
NAMES: Final[dict[Any, str]] = {
    **{
        function: f"{function.__module__ or 'time'}.{function.__qualname__}"
        for function in (*CLOCKS, *CHANCE)
    },
    **{function: f"datetime.{function.__qualname__}" for function in CLOCKS[-4:]},
    **{function: f"random.{function.__name__}" for function in CHANCE[3:]},
}
"""The functions whose results differ between runs, with their names."""

TOOL_NAME: Final = "aionode replay"

OWN: Final = str(Path(__file__).parents[2]) + os.sep
LIBRARY: Final = str(Path(os.__file__).parent) + os.sep


class MachineUseWarning(UserWarning):
    """A node uses the machine's clock, or random numbers, during a replay."""


class MachineUse:
    """Warns once about the machine's clocks, and once about random numbers, in a ``with`` block."""

    def __init__(self) -> None:
        self._open = {CLOCKS: "time", CHANCE: "random"}
        self._tool: int | None = None

    def __enter__(self) -> Self:
        if sys.version_info >= (3, 12):
            self._monitor()
        return self

    def __exit__(self, *_: object) -> None:
        self._end()

    if sys.version_info >= (3, 12):

        def _monitor(self) -> None:
            monitoring = sys.monitoring
            free = [tool for tool in range(5, -1, -1) if monitoring.get_tool(tool) is None]
            if not free:
                return  # debuggers and the like occupy all tool ids
            self._tool = free[0]
            monitoring.use_tool_id(self._tool, TOOL_NAME)
            monitoring.register_callback(self._tool, monitoring.events.CALL, self._on_call)
            monitoring.set_events(self._tool, monitoring.events.CALL)
            monitoring.restart_events()

        def _on_call(self, code: CodeType, _offset: int, function: Any, _argument: Any) -> Any:
            if is_users(code.co_filename) and not is_of_collector(code):
                self._note(function, code.co_filename, sys._getframe(1).f_lineno)
            return sys.monitoring.DISABLE

    def _note(self, function: Any, file: str, line: int) -> None:
        try:
            name = NAMES.get(function)
        except TypeError:  # not hashable
            return
        if name is None:
            return
        kind = CLOCKS if function in CLOCKS else CHANCE
        if self._open.pop(kind, None) is None:
            return
        instead = (
            "use the node's clock, node.get_clock().now()"
            if kind is CLOCKS
            else "use a random.Random with its own seed"
        )
        warnings.warn_explicit(
            f"{name}() is called during a replay, and its result differs between runs; {instead}",
            MachineUseWarning,
            file,
            line,
        )

    def _end(self) -> None:
        if sys.version_info >= (3, 12):
            if self._tool is not None:
                sys.monitoring.set_events(self._tool, sys.monitoring.events.NO_EVENTS)
                sys.monitoring.register_callback(self._tool, sys.monitoring.events.CALL, None)
                sys.monitoring.free_tool_id(self._tool)
                self._tool = None


def is_of_collector(code: CodeType) -> bool:
    """Return whether a function runs during garbage collection, at arbitrary points of nodes."""
    return any(getattr(callback, "__code__", None) is code for callback in gc.callbacks)


@cache
def is_users(file: str) -> bool:
    """Return whether a file belongs to the program, not to aionode or Python's library."""
    if file.startswith(OWN):
        return f"{os.sep}examples{os.sep}" in file
    return not file.startswith(("<frozen", LIBRARY)) or "site-packages" in file
