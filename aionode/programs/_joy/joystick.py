"""Joysticks of Linux as ROS counts their axes and buttons: a device of evdev, and its state."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from contextlib import suppress
from typing import Any, Final, Protocol

from aionode.errors import CommandError

__all__ = ["Device", "Joystick", "input_devices"]

EV_KEY: Final = 0x01
EV_ABS: Final = 0x03
EV_FF: Final = 0x15

FF_RUMBLE: Final = 0x50
RUMBLE_MS: Final = 1000
STRONGEST: Final = 0xFFFF

ABS_X: Final = 0x00
ABS_Y: Final = 0x01
HATS: Final = range(0x10, 0x18)
"""Codes of hats, two for each: the horizontal position, then the vertical one."""

BUTTONS: Final = range(0x120, 0x300)
"""Codes of buttons; lower codes are numbered after these, as in SDL."""

FIRST_BUTTONS: Final = {0x101, 0x120, 0x130}
"""A device with axes and one of these buttons is a joystick, by udev's rule."""

LEAST: Final = -32768
SPAN: Final = 65535
FULL: Final = 32767.0


class Device(Protocol):
    """The part of `evdev.InputDevice` that is used."""

    fd: int
    name: str

    def capabilities(self, verbose: bool = ..., absinfo: bool = ...) -> dict[int, list[Any]]:
        """Return the codes of each type of event, with the limits of axes."""

    def read(self) -> Iterable[Any]:
        """Return the pending events."""

    def upload_effect(self, effect: Any) -> int:
        """Store an effect in the device, and return its number."""

    def write(self, etype: int, code: int, value: int) -> None:
        """Send an event to the device, such as to play an effect several times."""

    def close(self) -> None:
        """Close the device."""


def input_devices() -> Iterator[Device]:
    """Yield the devices of this machine that may be read, in the order of their numbers.

    Raises:
        CommandError: The package evdev is not installed.
    """
    try:
        import evdev
    except ModuleNotFoundError:
        raise CommandError(
            "joysticks need the package evdev, which is not installed: pip install "
            "'aionode[joy]'; it exists for Linux only"
        ) from None
    paths = evdev.list_devices()
    for path in sorted(paths, key=lambda path: (len(path), path)):
        with suppress(OSError):  # it has just gone, or belongs to another user
            yield evdev.InputDevice(path)


class Joystick:
    """The state of a device, as `sensor_msgs/Joy` has it: left and forward are positive.

    Args:
        device: Where the events come from.
        deadzone: The fraction of an axis around its middle that counts as the middle.
        is_sticky: Whether a button changes with each press, and not with its release.

    Attributes:
        axes: The position of each axis, from -1 to 1; those of hats come last.
        buttons: Whether each button is pressed, as 0 or 1.
    """

    def __init__(self, device: Device, deadzone: float, *, is_sticky: bool) -> None:
        self.device = device
        self.deadzone = deadzone
        self.is_sticky = is_sticky
        capabilities = device.capabilities(absinfo=True)
        axes = dict(capabilities.get(EV_ABS, ()))
        keys = capabilities.get(EV_KEY, ())
        sticks = [code for code in sorted(axes) if code not in HATS]
        hats = sorted({code & ~1 for code in axes if code in HATS})
        both = [code for hat in hats for code in (hat, hat + 1)]
        self.limits = {code: (axes[code].min, axes[code].max) for code in sticks}
        self.axis_numbers = {code: at for at, code in enumerate([*sticks, *both])}
        ordered = sorted(keys, key=lambda code: (code not in BUTTONS, code))
        self.button_numbers = {code: at for at, code in enumerate(ordered)}
        self.buttons = [0] * len(ordered)
        self.axes = [0.0] * len(self.axis_numbers)
        for code, now in axes.items():
            self.axes[self.axis_numbers[code]] = self.place(code, now.value)
        self.can_rumble = FF_RUMBLE in capabilities.get(EV_FF, ())
        self.effect: Any = None

    @staticmethod
    def is_one(device: Device) -> bool:
        """Return whether a device is a joystick."""
        capabilities = device.capabilities(absinfo=False)
        axes, keys = set(capabilities.get(EV_ABS, ())), set(capabilities.get(EV_KEY, ()))
        return {ABS_X, ABS_Y} <= axes and not FIRST_BUTTONS.isdisjoint(keys)

    def rumble(self, intensity: float) -> None:
        """Rumble for a second, or until the next call; a device that cannot does nothing.

        Args:
            intensity: How strongly, from 0 to 1.

        Raises:
            OSError: The device is gone, or may not be written to.
        """
        if not self.can_rumble:
            return
        from evdev import ff

        if self.effect is None:
            replay, trigger = ff.Replay(RUMBLE_MS, 0), ff.Trigger(0, 0)
            self.effect = ff.Effect(FF_RUMBLE, -1, 0, trigger, replay, ff.EffectType())
        strength = round(intensity * STRONGEST)
        self.effect.u.ff_rumble_effect = ff.Rumble(strength, strength)
        self.device.write(EV_FF, self.device.upload_effect(self.effect), 1)

    def place(self, code: int, value: int) -> float:
        """Return the position of an axis."""
        if code in HATS:
            return float((value < 0) - (value > 0))
        least, greatest = self.limits[code]
        if greatest <= least:
            return 0.0
        whole = LEAST + math.floor((value - least) * SPAN / (greatest - least) + 0.5)
        part = min(max(whole / FULL, -1.0), 1.0)
        beyond = abs(part) - self.deadzone
        if beyond <= 0:
            return 0.0
        return -math.copysign(beyond / (1.0 - self.deadzone), part)

    def take(self, event: Any) -> tuple[bool, bool]:
        """Process an event; return whether it changed an axis, and whether it changed a button."""
        if event.type == EV_ABS and event.code in self.axis_numbers:
            at = self.axis_numbers[event.code]
            before, self.axes[at] = self.axes[at], self.place(event.code, event.value)
            is_changed = self.axes[at] != before
            return (False, is_changed) if event.code in HATS else (is_changed, False)
        if event.type == EV_KEY and event.code in self.button_numbers and event.value in (0, 1):
            at = self.button_numbers[event.code]
            if not self.is_sticky:
                self.buttons[at] = event.value
            elif event.value:
                self.buttons[at] = 1 - self.buttons[at]
            return False, bool(event.value) or not self.is_sticky
        return False, False
