"""Programs import this as `diagnostic_updater`: `aionode.diagnostics` for nodes of rclpy."""

from __future__ import annotations

import threading
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

from aionode import diagnostics
from aionode.diagnostics import (
    CompositeDiagnosticTask,
    DiagnosedPublisher,
    DiagnosticTask,
    FrequencyStatus,
    FrequencyStatusParam,
    FunctionDiagnosticTask,
    HeaderlessTopicDiagnostic,
    Heartbeat,
    TimeStampStatus,
    TimeStampStatusParam,
    TopicDiagnostic,
)

__all__ = [
    "CompositeDiagnosticTask",
    "DiagnosedPublisher",
    "DiagnosticStatusWrapper",
    "DiagnosticTask",
    "FrequencyStatus",
    "FrequencyStatusParam",
    "FunctionDiagnosticTask",
    "HeaderlessTopicDiagnostic",
    "Heartbeat",
    "TimeStampStatus",
    "TimeStampStatusParam",
    "TopicDiagnostic",
    "Updater",
]


class DiagnosticStatusWrapper(diagnostics.StatusMethods, DiagnosticStatus):  # type: ignore[misc]  # found when it runs
    """A status that tasks fill."""

    _value_class = KeyValue


class Updater(diagnostics.UpdaterBase):
    """Calls tasks periodically, and publishes the status that each of them fills.

    Args:
        node: The node.
        period: The time between two updates, in seconds; a parameter has precedence.
    """

    _wrapper_class = DiagnosticStatusWrapper
    _status_class = DiagnosticStatus
    _array_class = DiagnosticArray

    def __init__(self, node: Any, period: float = 1.0) -> None:
        self.lock = threading.Lock()
        super().__init__(node, period)

    def add(self, *args: Any) -> None:
        """Add a task: a `DiagnosticTask`, or a name and a function."""
        with self.lock:
            super().add(*args)

    def removeByName(self, name: str) -> bool:
        """Remove the first task of a name; return whether there was one."""
        with self.lock:
            return super().removeByName(name)

    def update(self) -> None:
        """Run all tasks, and publish their statuses."""
        statuses = []
        with self.lock:
            for task in self.tasks:
                status = self._begun(task)
                try:
                    filled = task.run(status)
                except Exception as error:  # noqa: BLE001  # the program's task: reported and logged
                    filled = self._failed(task, error)
                statuses.append(status if filled is None else filled)
        self._finish(statuses)

    def force_update(self) -> None:
        """Update now, whatever the period is."""
        self.update()
