"""The event loop of tests on asyncio: the checks of its debug mode, without what they cost."""

from __future__ import annotations

import asyncio
import functools
import inspect
import sys
from typing import Any


class CheckingLoop(asyncio.SelectorEventLoop):
    """asyncio's own loop, which reports forgotten coroutines and foreign threads.

    In debug mode, each future, task and handle also records the stack that made it. This takes ten
    times longer than all else that the loop does for it, so they are told that there is no debug
    mode; the loop's own checks do not ask `get_debug`.
    """

    def __init__(self) -> None:
        super().__init__()
        self.slow_callback_duration = 60.0  # measuring is the business of benchmarks

    def set_debug(self, enabled: bool) -> None:
        """Keep the checks: the runner of pytest-asyncio would switch them off."""
        super().set_debug(True)

    def get_debug(self) -> bool:
        """Return False, for futures, tasks and handles."""
        return False

    def _set_coroutine_origin_tracking(self, enabled: bool) -> None:
        """Record of each coroutine the line that created it, and not ten."""
        super()._set_coroutine_origin_tracking(enabled)  # type: ignore[misc]  # of asyncio
        if enabled:
            sys.set_coroutine_origin_tracking_depth(1)

    def _check_callback(self, callback: Any, method: str) -> None:
        """Check only what may be a coroutine or a coroutine function."""
        if (code := getattr(callback, "__code__", None)) is not None:
            suspicious = code.co_flags & inspect.CO_COROUTINE
        else:
            suspicious = isinstance(callback, functools.partial) or not callable(callback)
        if suspicious:
            super()._check_callback(callback, method)  # type: ignore[misc]  # of asyncio
