"""The signals that shut contexts down."""

from __future__ import annotations

import contextlib
from typing import TYPE_CHECKING

from aionode.rclpy._impl import signals as _signals
from aionode.rclpy._impl.signals import SignalHandlerOptions
from aionode.rclpy.guard_condition import GuardCondition

if TYPE_CHECKING:
    from aionode.rclpy.context import Context

__all__ = [
    "SignalHandlerGuardCondition",
    "SignalHandlerOptions",
    "get_current_signal_handlers_options",
    "install_signal_handlers",
    "uninstall_signal_handlers",
]


def install_signal_handlers(options: SignalHandlerOptions = SignalHandlerOptions.ALL) -> None:
    """Have these signals shut contexts down.

    SIGINT goes on as KeyboardInterrupt in the main thread; SIGTERM lets `spin` end. Only the main
    thread can do that; in others nothing happens.
    """
    _signals.install(options)


def get_current_signal_handlers_options() -> SignalHandlerOptions:
    """Return which signals shut contexts down."""
    return _signals.current_options()


def uninstall_signal_handlers() -> None:
    """Have signals do again what they did before."""
    _signals.uninstall()


class SignalHandlerGuardCondition(GuardCondition):
    """A guard condition that the shutdown by a signal triggers."""

    def __init__(self, context: Context | None = None) -> None:
        super().__init__(callback=None, callback_group=None, context=context)
        _signals.guards[id(self.handle)] = self.handle

    def __del__(self) -> None:
        with contextlib.suppress(Exception):  # it may be destroyed, or half made
            self.destroy()

    def destroy(self) -> None:
        """Destroy it."""
        _signals.guards.pop(id(self.handle), None)
        super().destroy()
