"""Entities that follow the state of a managed node."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING, Any

from aionode.engine.rules.lifecycle_states import TransitionCallbackReturn

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.engine.rules.lifecycle_states import State

__all__ = ["ManagedEntity", "SimpleManagedEntity"]


class ManagedEntity:
    """Takes part in the transitions of a node; see `LifecycleNode.add_managed_entity`.

    Each method gets the state in which the transition started, and returns its result. The methods
    are not coroutines, and are called in the order in which the entities were added.
    """

    def on_configure(self, state: State) -> TransitionCallbackReturn:  # noqa: ARG002  # for subclasses
        """Take part in `configure`."""
        return TransitionCallbackReturn.SUCCESS

    def on_cleanup(self, state: State) -> TransitionCallbackReturn:  # noqa: ARG002  # the same
        """Take part in `cleanup`."""
        return TransitionCallbackReturn.SUCCESS

    def on_shutdown(self, state: State) -> TransitionCallbackReturn:  # noqa: ARG002  # the same
        """Take part in `shutdown`."""
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state: State) -> TransitionCallbackReturn:  # noqa: ARG002  # the same
        """Take part in `activate`."""
        return TransitionCallbackReturn.SUCCESS

    def on_deactivate(self, state: State) -> TransitionCallbackReturn:  # noqa: ARG002  # the same
        """Take part in `deactivate`."""
        return TransitionCallbackReturn.SUCCESS

    def on_error(self, state: State) -> TransitionCallbackReturn:  # noqa: ARG002  # the same
        """Take part in error processing."""
        return TransitionCallbackReturn.SUCCESS


class SimpleManagedEntity(ManagedEntity):
    """A managed entity that is enabled while its node is active, and does nothing else."""

    def __init__(self) -> None:
        self._SimpleManagedEntity__activated = False

    @property
    def is_activated(self) -> bool:
        """Whether it is enabled."""
        return self._SimpleManagedEntity__activated

    def on_activate(self, state: State) -> TransitionCallbackReturn:  # noqa: ARG002  # as inherited
        """Enable the entity."""
        self._SimpleManagedEntity__activated = True
        return TransitionCallbackReturn.SUCCESS

    def on_deactivate(self, state: State) -> TransitionCallbackReturn:  # noqa: ARG002  # the same
        """Disable the entity."""
        self._SimpleManagedEntity__activated = False
        return TransitionCallbackReturn.SUCCESS

    @staticmethod
    def when_enabled(
        wrapped: Callable[..., Any] | None = None,
        *,
        when_not_enabled: Callable[..., Any] | None = None,
    ) -> Callable[..., Any]:
        """Decorate a method so that it runs only while its entity is enabled.

        Args:
            wrapped: The method.
            when_not_enabled: Called instead, with the same arguments except the entity; by default
                the call returns None.
        """

        def decorate(method: Callable[..., Any]) -> Callable[..., Any]:
            @functools.wraps(method)
            def only_when_enabled(self: SimpleManagedEntity, *args: Any, **options: Any) -> Any:
                if self.is_activated:
                    return method(self, *args, **options)
                return None if when_not_enabled is None else when_not_enabled(*args, **options)

            return only_when_enabled

        return decorate if wrapped is None else decorate(wrapped)
