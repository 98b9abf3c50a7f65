"""What action servers and clients share: their parts, argument checks, stamps, abort reasons."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Awaitable
from typing import TYPE_CHECKING, Any

from aionode.endpoints._core.entity import EndStage, Entity
from aionode.endpoints.client import Client
from aionode.endpoints.service import Service
from aionode.errors import brief, shortened
from aionode.message import ActionType

if TYPE_CHECKING:
    from aionode.clock import Clock
    from aionode.endpoints._core.callback_runner import CallbackContext
    from aionode.endpoints.service_introspection import ServiceIntrospectionState
    from aionode.qos import QoSProfile

__all__ = [
    "AbortReason",
    "ActionEntity",
    "awaited",
    "expect_action_type",
    "in_event_loop",
    "pass_reason",
    "seconds_to_ns",
    "stamp_ns",
]


class ActionEntity(Entity):
    """An action server or client: an entity that is made of other entities, its parts."""

    def __init__(self, subject: str, stage: EndStage = EndStage.CALLBACKS) -> None:
        super().__init__(subject, stage)
        self._parts: list[Entity] = []

    def _part(self, part: Any) -> Any:
        self._parts.append(part)
        return part

    def configure_introspection(
        self,
        clock: Clock,
        service_event_qos_profile: QoSProfile | int,
        introspection_state: ServiceIntrospectionState,
    ) -> None:
        """Publish what the three services of the action send and receive from now on.

        The topics are ``<action>/_action/send_goal/_service_event``, and those of ``cancel_goal``
        and ``get_result``.

        Args:
            clock: Where the time stamps come from, such as ``node.get_clock()``.
            service_event_qos_profile: QoS of the publishers.
            introspection_state: Whether to publish nothing, which requests there are, or their
                contents as well.

        Raises:
            TypeError: `clock` or the profile has the wrong type.
            ValueError: `introspection_state` is unknown.
            EntityDestroyedError: the action server or client was destroyed (a RuntimeError).
        """
        self._refuse_if_destroyed("configure introspection")
        for part in self._parts:
            if isinstance(part, Service | Client):
                part.configure_introspection(clock, service_event_qos_profile, introspection_state)


# Why a goal was aborted


class AbortReason(Exception):  # noqa: N818  # a message to the client, which reads its name
    """Why a goal was aborted, sent to the client as a service error: see `reason_id`."""


def pass_reason(error: Exception, context: CallbackContext) -> None:  # noqa: ARG001  # an OnError
    """Ignore an `AbortReason`, which the client gets, and raise anything else.

    Raises:
        Exception: `error`, if it is not an `AbortReason`.
    """
    if not isinstance(error, AbortReason):
        raise error


# Arguments


def expect_action_type(action_type: object, subject: str) -> None:
    """Raise TypeError unless `action_type` is an action class."""
    if not (isinstance(action_type, type) and issubclass(action_type, ActionType)):
        raise TypeError(
            f"{shortened(subject)}: {brief(action_type)} is no action class; use one such as "
            "aionode.interfaces.example_interfaces.action.Fibonacci, or derive from "
            "aionode.message.ActionType"
        )


def seconds_to_ns(seconds: float, subject: str) -> int:
    """Return seconds, 0 or more, in nanoseconds.

    Raises:
        TypeError: `seconds` is not a number.
        ValueError: it is negative or not finite.
    """
    if not isinstance(seconds, int | float):
        raise TypeError(f"{subject}={brief(seconds)}; a number of seconds is needed")
    if not (math.isfinite(seconds) and seconds >= 0):
        raise ValueError(f"{subject}={seconds}; it must be finite, and 0 or more seconds")
    return round(seconds * 1e9)


def stamp_ns(stamp: Any) -> int:
    """Return a builtin_interfaces/msg/Time in nanoseconds."""
    return int(stamp.sec) * 1_000_000_000 + int(stamp.nanosec)


# Callbacks


async def awaited(outcome: Any) -> Any:
    """Return `outcome`, awaited if it can be: the result of a sync or an async callback."""
    return await outcome if isinstance(outcome, Awaitable) else outcome


def in_event_loop() -> bool:
    """Return whether an event loop runs in this thread."""
    try:
        asyncio.get_running_loop()
    except RuntimeError:
        return False
    return True
