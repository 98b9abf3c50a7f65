"""What is ready in the nodes of an executor."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from aionode.rclpy._impl.errors import InvalidHandle
from aionode.rclpy._impl.wait_set import WaitSet
from aionode.rclpy._taking import (
    take_client,
    take_guard_condition,
    take_service,
    take_subscription,
    take_timer,
    take_waitable,
)

if TYPE_CHECKING:
    from aionode.rclpy._protocols import ExecutorLike, NodeLike
    from aionode.rclpy.callback_groups import Entity

__all__ = ["Ready", "Take", "ready_callbacks", "wait_set_of"]

Take = Callable[["ExecutorLike", Any], "Callable[[], Any] | None"]
Ready = tuple["Entity", "NodeLike", Take]


def ready_callbacks(
    nodes: list[NodeLike], can_execute: Callable[[Entity], bool], context: Any
) -> list[Ready]:
    """Return what is ready now, in the order of a round."""
    found: list[Ready] = []
    for node in nodes:
        found += [
            (waitable, node, take_waitable)
            for waitable in node._waitables
            if can_execute(waitable) and is_ready(waitable, context)
        ]
    for node in nodes:
        for entities, take in (
            (node._timers, take_timer),
            (node._subscriptions, take_subscription),
            (node._guards, take_guard_condition),
            (node._clients, take_client),
            (node._services, take_service),
        ):
            for entity in entities:
                if entity.handle.ready() and can_execute(entity):
                    found.append((entity, node, take))  # few are
    return found


def is_ready(waitable: Any, context: Any) -> bool:
    """Whether something can be taken from a waitable."""
    wait_set = wait_set_of([waitable], context)
    wait_set.look()
    ready: bool = waitable.is_ready(wait_set)
    return ready


def wait_set_of(waitables: list[Any], context: Any) -> WaitSet:
    """Return a wait set with the handles of waitables, without those that are being destroyed."""
    wait_set = WaitSet(0, 0, 0, 0, 0, 0, context)
    for waitable in waitables:
        try:
            with waitable:
                waitable.add_to_wait_set(wait_set)
        except InvalidHandle:
            continue
    return wait_set
