"""The shared parts of action servers and clients: argument checks, stamps, reasons."""

from __future__ import annotations

import math
from collections.abc import Awaitable
from typing import TYPE_CHECKING, Any

from aionode.endpoints.client import Client
from aionode.endpoints.core.entity import EndStage, Entity
from aionode.endpoints.service import Service
from aionode.engine.rules.goal import is_sign
from aionode.errors import brief, shortened
from aionode.interfaces import fitting
from aionode.message import ActionType

if TYPE_CHECKING:
    from aionode.clock import Clock
    from aionode.endpoints.core.callback_runner import CallbackContext
    from aionode.endpoints.service_introspection import ServiceIntrospectionState
    from aionode.qos import QoSProfile

__all__ = [
    "AbortReason",
    "ActionEntity",
    "awaited",
    "checked_client_lost",
    "expect_action_type",
    "pass_reason",
    "seconds_to_ns",
    "stamp_ns",
    "uuid_message",
]


MIN_LOSS_NS = 30_000_000


class ActionEntity(Entity):
    """An action server or client: an entity composed of other entities, its parts."""

    def __init__(self, subject: str, stage: EndStage = EndStage.CALLBACKS) -> None:
        super().__init__(subject, stage)
        self._parts: list[Entity] = []
        self._goals: Any = {}  # known goals, by id

    def _part(self, part: Any) -> Any:
        self._parts.append(part)
        return part

    def _is_sign(self, request: Any) -> bool:
        """Return whether a result request is only a sign of life of its client."""
        return is_sign(bytes(request.goal_id.uuid), self._goals)

    def configure_introspection(
        self,
        clock: Clock,
        service_event_qos_profile: QoSProfile | int,
        introspection_state: ServiceIntrospectionState,
    ) -> None:
        """Publish the requests and responses of the action's three services from now on.

        The topics are ``<action>/_action/send_goal/_service_event``, and those of ``cancel_goal``
        and ``get_result``.

        Args:
            clock: The source of time stamps, such as ``node.get_clock()``.
            service_event_qos_profile: QoS of the publishers.
            introspection_state: Whether to publish nothing, metadata only, or contents as well.

        Raises:
            TypeError: `clock` or the profile has the wrong type.
            ValueError: `introspection_state` is unknown.
            EntityDestroyedError: the action server or client was destroyed (a RuntimeError).
        """
        self._refuse_if_destroyed("configure introspection")
        for part in self._parts:
            if isinstance(part, Service | Client):
                part.configure_introspection(clock, service_event_qos_profile, introspection_state)


# Why a goal was rejected or aborted


class AbortReason(Exception):  # noqa: N818  # a message to the client, which checks the name
    """Why a goal was rejected or aborted, as a service error for its client: see `reason_id`."""


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
            f"{shortened(subject)}: {brief(action_type)} is not an action class; "
            f"{fitting(action_type, 'aionode.interfaces.example_interfaces.action.Fibonacci')}, "
            "or derive from aionode.message.ActionType"
        )


def seconds_to_ns(seconds: float, subject: str) -> int:
    """Convert non-negative seconds to nanoseconds.

    Raises:
        TypeError: `seconds` is not a number.
        ValueError: it is negative or not finite.
    """
    if not isinstance(seconds, int | float):
        raise TypeError(f"{subject}={brief(seconds)}; a number of seconds is needed")
    if not (math.isfinite(seconds) and seconds >= 0):
        raise ValueError(f"{subject}={seconds}; it must be finite, and 0 or more seconds")
    return round(seconds * 1e9)


def checked_client_lost(on_client_lost: str | None, client_lost_sec: float, subject: str) -> int:
    """Return the silence in nanoseconds after which a client is lost; 0 for never.

    Raises:
        TypeError: `client_lost_sec` is not a number.
        ValueError: it is too short or not finite, or `on_client_lost` is unknown.
    """
    if on_client_lost not in ("cancel", "continue", None):
        raise ValueError(
            f"{subject}: on_client_lost={brief(on_client_lost)} is unknown; "
            'use "cancel" or "continue"'
        )
    lost_ns = seconds_to_ns(client_lost_sec, f"{subject}: client_lost_sec")
    if lost_ns < MIN_LOSS_NS:
        raise ValueError(
            f"{subject}: client_lost_sec={client_lost_sec}; it must be at least "
            f"{MIN_LOSS_NS / 1e9:g} s, as clients give three signs in that time"
        )
    return lost_ns if on_client_lost == "cancel" else 0


def uuid_message(goal_id: bytes) -> Any:
    """Return 16 bytes as unique_identifier_msgs/msg/UUID."""
    # Imported here, as programs without actions never need them.
    import numpy as np

    from aionode.interfaces.unique_identifier_msgs.msg import UUID

    return UUID(uuid=np.frombuffer(goal_id, np.uint8))


def stamp_ns(stamp: Any) -> int:
    """Return a builtin_interfaces/msg/Time in nanoseconds."""
    return int(stamp.sec) * 1_000_000_000 + int(stamp.nanosec)


# Callbacks


async def awaited(outcome: Any) -> Any:
    """Return the result of a sync or async callback: `outcome`, awaited if awaitable."""
    return await outcome if isinstance(outcome, Awaitable) else outcome
