"""``joy joy_node``: publishes the positions of a joystick's axes and the state of its buttons."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Callable, Iterable
from typing import Final

import aionode
from aionode import Node
from aionode.errors import CommandError
from aionode.interfaces.sensor_msgs.msg import Joy, JoyFeedback
from aionode.interfaces.std_msgs.msg import Header
from aionode.programs._joy.joystick import Device, Joystick, input_devices
from aionode.programs._wall_timer import create_wall_timer

__all__ = ["JoyNode", "main"]

SEARCH_SEC: Final = 0.5
"""How often to search for a joystick while there is none."""

FASTEST_HZ: Final = 1000.0


class JoyNode(Node):
    """Publishes a joystick on `joy` while it is plugged in.

    Args:
        devices: Returns the devices of this machine.

    Raises:
        CommandError: A parameter is invalid.
    """

    joystick: Joystick | None = None

    def __init__(self, devices: Callable[[], Iterable[Device]] = input_devices) -> None:
        super().__init__("joy_node")
        self.number, self.name, coalesce_sec = self.chosen()
        self.deadzone = self.declare_parameter("deadzone", 0.05).value
        if not 0.0 <= self.deadzone < 1.0:
            raise CommandError("Deadzone must be between 0.0 and 1.0")
        rate = self.declare_parameter("autorepeat_rate", 20.0).value
        if not 0.0 <= rate < math.inf:
            raise CommandError("Autorepeat rate must be >= 0.0")
        if rate > FASTEST_HZ:
            raise CommandError("Autorepeat rate must be <= 1000.0")
        self.is_sticky = self.declare_parameter("sticky_buttons", False).value
        self.devices = devices
        self.loop = asyncio.get_running_loop()
        self.has_warned = self.has_failed = False
        self.publisher = self.create_publisher(Joy, "joy", 10)
        self.create_subscription(JoyFeedback, "joy/set_feedback", self.on_feedback, 10)
        self.soon = create_wall_timer(self, coalesce_sec, self.publish_once, autostart=False)
        if rate:
            create_wall_timer(self, 1.0 / rate, self.publish)
        create_wall_timer(self, SEARCH_SEC, self.search)
        self.search()

    def chosen(self) -> tuple[int, str, float]:
        """Return the number of the joystick, its name, and how long changes are collected.

        Raises:
            CommandError: A parameter is invalid.
        """
        number = self.declare_parameter("device_id", 0).value
        name = self.declare_parameter("device_name", "").value
        coalesce_ms = self.declare_parameter("coalesce_interval_ms", 1).value
        if coalesce_ms < 0:
            raise CommandError("coalesce_interval_ms must be positive")
        return number, name, coalesce_ms / 1e3

    def search(self) -> None:
        """Search for the joystick, unless one is open."""
        if self.joystick is not None:
            return
        devices = list(self.devices())
        found = [each for each in devices if Joystick.is_one(each)]
        chosen = [
            each
            for at, each in enumerate(found)
            if (each.name == self.name if self.name else at == self.number)
        ][:1]
        for each in devices:
            if each not in chosen:
                each.close()
        if chosen:
            self.open(chosen[0])
        elif self.name and found and not self.has_warned:
            names = ", ".join(repr(each.name) for each in found)
            self.get_logger().warning(
                f"Could not get joystick with name {self.name!r}; there are {names}"
            )
            self.has_warned = True

    def open(self, device: Device) -> None:
        """Start reading a device."""
        self.joystick = Joystick(device, self.deadzone, is_sticky=self.is_sticky)
        self.loop.add_reader(device.fd, self.read)
        self.get_logger().info(f"Opened joystick: {device.name!r}.  deadzone: {self.deadzone:f}")

    def read(self) -> None:
        """Process the pending events; publish at once if a button has changed."""
        joystick = self.joystick
        if joystick is None:
            return
        try:
            events = list(joystick.device.read())
        except BlockingIOError:
            return
        except OSError as error:
            self.get_logger().warning(f"Lost joystick {joystick.device.name!r}: {error.strerror}")
            self.close()
            return
        for event in events:
            has_moved, is_pressed = joystick.take(event)
            if is_pressed:
                self.publish_once()
            elif has_moved and self.soon.is_canceled():
                self.soon.reset()

    def publish_once(self) -> None:
        """Publish the changes now."""
        self.soon.cancel()
        self.publish()

    def publish(self) -> None:
        """Publish the state of the joystick, if there is one."""
        if self.joystick is not None:
            header = Header(stamp=self.get_clock().now().to_msg(), frame_id="joy")
            axes, buttons = self.joystick.axes, self.joystick.buttons
            self.publisher.publish(Joy(header=header, axes=axes, buttons=buttons))

    def on_feedback(self, feedback: JoyFeedback) -> None:
        """Rumble; a joystick has one rumble motor, number 0, and no other feedback."""
        is_rumble = feedback.type == JoyFeedback.TYPE_RUMBLE and feedback.id == 0
        if self.joystick is None or not is_rumble or not 0.0 <= feedback.intensity <= 1.0:
            return
        try:
            self.joystick.rumble(feedback.intensity)
        except OSError as error:
            if not self.has_failed:
                name = self.joystick.device.name
                self.get_logger().warning(f"Joystick {name!r} does not rumble: {error.strerror}")
            self.has_failed = True

    def close(self) -> None:
        """Stop reading the device."""
        if self.joystick is not None:
            self.loop.remove_reader(self.joystick.device.fd)
            self.joystick.device.close()
            self.joystick = None

    def destroy_node(self) -> None:
        """End the node, and close the device."""
        self.close()
        super().destroy_node()


def main() -> None:
    """Run the node until Ctrl-C."""
    aionode.run(JoyNode)
