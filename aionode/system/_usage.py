"""CPU time and memory of each process, using psutil if it is installed."""

from __future__ import annotations

import importlib
from contextlib import suppress
from typing import Any

__all__ = ["UsageMeter"]


class UsageMeter:
    """Measures processes; the share of a core is measured since the last call."""

    def __init__(self) -> None:
        self._psutil: Any = None
        with suppress(ImportError):
            self._psutil = importlib.import_module("psutil")  # the optional extra `system`
        self._processes: dict[int, Any] = {}

    def of(self, pid: int | None) -> tuple[float | None, int | None]:
        """Return the share of a core in percent, and the resident memory in bytes.

        Both are None without psutil and for a process that has ended. The first share is 0.
        """
        if self._psutil is None or pid is None:
            return None, None
        try:
            process = self._processes.get(pid)
            if process is None or not process.is_running():
                process = self._processes[pid] = self._psutil.Process(pid)
            return process.cpu_percent(), process.memory_info().rss
        except self._psutil.Error:
            self._processes.pop(pid, None)
            return None, None
