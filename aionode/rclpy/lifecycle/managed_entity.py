"""Entities that take part in the transitions of a managed node."""

from __future__ import annotations

from functools import wraps
from typing import TYPE_CHECKING, Any

from aionode.rclpy._impl.lifecycle import TransitionCallbackReturn

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["ManagedEntity", "SimpleManagedEntity", "TransitionCallbackReturn"]


class ManagedEntity:
    """Base of what is told of transitions; each callback gets the state before it."""

    def on_configure(self, state: Any) -> TransitionCallbackReturn:
        """Handle the transition from unconfigured to inactive."""
        return TransitionCallbackReturn.SUCCESS

    def on_cleanup(self, state: Any) -> TransitionCallbackReturn:
        """Handle the transition from inactive to unconfigured."""
        return TransitionCallbackReturn.SUCCESS

    def on_shutdown(self, state: Any) -> TransitionCallbackReturn:
        """Handle the transition to finalized."""
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state: Any) -> TransitionCallbackReturn:
        """Handle the transition from inactive to active."""
        return TransitionCallbackReturn.SUCCESS

    def on_deactivate(self, state: Any) -> TransitionCallbackReturn:
        """Handle the transition from active to inactive."""
        return TransitionCallbackReturn.SUCCESS

    def on_error(self, state: Any) -> TransitionCallbackReturn:
        """Handle an error in another callback; SUCCESS leads to unconfigured."""
        return TransitionCallbackReturn.SUCCESS


class SimpleManagedEntity(ManagedEntity):
    """Works only while its node is active."""

    def __init__(self) -> None:
        self._enabled = False

    def on_activate(self, state: Any) -> TransitionCallbackReturn:
        """Begin to work."""
        self._enabled = True
        return TransitionCallbackReturn.SUCCESS

    def on_deactivate(self, state: Any) -> TransitionCallbackReturn:
        """Work no longer."""
        self._enabled = False
        return TransitionCallbackReturn.SUCCESS

    @property
    def is_activated(self) -> bool:
        """Whether it works."""
        return self._enabled

    @staticmethod
    def when_enabled(
        wrapped: Callable[..., Any] | None = None,
        *,
        when_not_enabled: Callable[..., Any] | None = None,
    ) -> Any:
        """Return a method that does nothing, or calls `when_not_enabled`, while it does not work.

        To be used as a decorator, with or without arguments.
        """

        def decorate(method: Callable[..., Any]) -> Callable[..., None]:
            @wraps(method)
            def only_when_enabled(self: SimpleManagedEntity, *args: Any, **kwargs: Any) -> None:
                if self._enabled:
                    method(self, *args, **kwargs)
                elif when_not_enabled is not None:
                    when_not_enabled()

            return only_when_enabled

        return decorate if wrapped is None else decorate(wrapped)
