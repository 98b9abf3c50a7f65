"""Entities that follow the state of a managed node."""

from __future__ import annotations

from functools import wraps
from typing import TYPE_CHECKING, Any

from aionode.engine.rules import managed_entity as core
from aionode.engine.rules.lifecycle_states import TransitionCallbackReturn
from aionode.engine.rules.managed_entity import ManagedEntity

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["ManagedEntity", "SimpleManagedEntity", "TransitionCallbackReturn"]


class SimpleManagedEntity(core.SimpleManagedEntity):
    """Works only while its node is active."""

    @staticmethod
    def when_enabled(
        wrapped: Callable[..., Any] | None = None,
        *,
        when_not_enabled: Callable[..., Any] | None = None,
    ) -> Any:
        """Return a method that, while not enabled, does nothing or calls `when_not_enabled`.

        It can be used as a decorator, with or without arguments. As in rclpy, `when_not_enabled`
        gets no arguments, and such a method returns nothing.
        """

        def decorate(method: Callable[..., Any]) -> Callable[..., None]:
            @wraps(method)
            def only_when_enabled(self: SimpleManagedEntity, *args: Any, **kwargs: Any) -> None:
                if self.is_activated:
                    method(self, *args, **kwargs)
                elif when_not_enabled is not None:
                    when_not_enabled()

            return only_when_enabled

        return decorate if wrapped is None else decorate(wrapped)
