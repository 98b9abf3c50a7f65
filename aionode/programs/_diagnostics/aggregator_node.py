"""``diagnostic_aggregator aggregator_node``: aggregates diagnostics, set up by parameters."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, Final

import aionode
from aionode import Node, Parameter
from aionode.errors import CommandError
from aionode.interfaces.diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from aionode.programs._diagnostics.analyzers import Analyzers, Other, level_of
from aionode.programs._wall_timer import create_wall_timer

__all__ = ["Aggregator", "main"]

ERROR: Final = 2

MAX_WARNINGS: Final = 1000
"""Number of warnings that are remembered so that they are not repeated."""


class Aggregator(Node):
    """Publishes on `/diagnostics_agg` the reports of analyzers on `/diagnostics`.

    Raises:
        CommandError: A parameter is invalid.
    """

    def __init__(self) -> None:
        super().__init__(
            "analyzers",
            allow_undeclared_parameters=True,
            automatically_declare_parameters_from_overrides=True,
        )
        given = self.given()
        rate = given.get("pub_rate", 1.0)
        if not isinstance(rate, int | float) or not 0 < rate < math.inf:
            raise CommandError(f"pub_rate is {rate!r}; use a number above 0")
        self.is_critical = bool(given.get("critical", False))
        path = str(given.get("path", ""))
        base = f"/{path}" if path else ""
        log = self.get_logger().get_child("Aggregator")
        self.base = base
        self.make_analyzers = Analyzers(self.now, log.error).group
        self.group = self.make_analyzers(base, given)
        self.other = Other(base, is_error=bool(given.get("other_as_errors", False)), now=self.now)
        self.log = log
        self.warned: set[str] = set()
        self.last_level: int | None = None
        depth = given.get("history_depth", 1000)
        self.create_subscription(DiagnosticArray, "/diagnostics", self.on_diagnostics, depth)
        self.publisher = self.create_publisher(DiagnosticArray, "/diagnostics_agg", 1)
        self.top = self.create_publisher(DiagnosticStatus, "/diagnostics_toplevel_state", 1)
        create_wall_timer(self, 1.0 / rate, self.publish)
        self.add_post_set_parameters_callback(self.on_parameters)

    def given(self) -> dict[str, Any]:
        """Return the values of all parameters."""
        parameters = self.get_parameters_by_prefix("")
        return {name: parameter.value for name, parameter in parameters.items()}

    def on_parameters(self, parameters: Sequence[Parameter]) -> None:
        """Create the analyzers again if parameters of one were set, as by add_analyzer."""
        if any("." in parameter.name for parameter in parameters):
            self.group = self.make_analyzers(self.base, self.given())

    def now(self) -> float:
        """Return the time, in seconds."""
        return self.get_clock().now().nanoseconds / 1e9

    def on_diagnostics(self, msg: DiagnosticArray) -> None:
        """Pass reported states to the analyzers."""
        if msg.header.stamp.sec == 0:
            names = ", ".join(status.name for status in msg.status)
            text = f"No timestamp set for diagnostic message. Message names: {names}"
            if text not in self.warned and len(self.warned) < MAX_WARNINGS:
                self.warned.add(text)
                self.log.warning(text)
        for status in msg.status:
            if self.is_critical and level_of(status) == ERROR and self.last_level != ERROR:
                self.last_level = ERROR
                self.top.publish(
                    DiagnosticStatus(name="toplevel_state_critical", level=bytes([ERROR]))
                )
            taker: Any = self.group if self.group.match(status.name) else self.other
            taker.analyze(status)

    def publish(self) -> None:
        """Publish all states, and the worst level."""
        msg = DiagnosticArray(status=[*self.group.report(), *self.other.report()])
        msg.header.stamp = self.get_clock().now().to_msg()
        self.publisher.publish(msg)
        levels = [level_of(status) for status in msg.status]
        worst = max(levels, default=ERROR)
        if worst > ERROR and min(levels) <= ERROR:
            worst = ERROR  # stale only if all are
        self.last_level = worst
        self.top.publish(DiagnosticStatus(name="toplevel_state", level=bytes([worst])))


def main() -> None:
    """Run the node until Ctrl-C."""
    aionode.run(Aggregator)
