"""The base of controllers: managed nodes that turn states of the hardware into commands."""

from __future__ import annotations

from typing import Any

from aionode import Time
from aionode.lifecycle import LifecycleNode
from aionode.programs._ros2_control.hardware import Hardware

__all__ = ["Controller"]


class Controller(LifecycleNode):
    """A controller, which the controller manager updates while it is active.

    Args:
        name: The name of its node.
        hardware: The hardware that it reads and writes.
        options: The other arguments of `LifecycleNode`.

    Attributes:
        hardware: The hardware that it reads and writes.
        command_names: The interfaces that it writes, once it is configured.
        state_names: The interfaces that it reads, once it is configured.
        update_rate: How often per second it is updated; 0 means at the manager's rate.
    """

    def __init__(self, name: str, hardware: Hardware, **options: Any) -> None:
        # Only the manager changes its state, since it also has to release the interfaces.
        super().__init__(name, enable_communication_interface=False, **options)
        self.hardware = hardware
        self.command_names: list[str] = []
        self.state_names: list[str] = []
        self.update_rate: int = self.declare_parameter("update_rate", 0).value

    def update(self, now: Time, period_sec: float) -> None:
        """Read states and write commands.

        Args:
            now: The time of this update.
            period_sec: The time since the last one.
        """
        raise NotImplementedError
