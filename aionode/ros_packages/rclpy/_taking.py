"""Finds the ready entities of an executor's nodes, takes their items and calls their callbacks.

Each function takes an item, and returns the function to call then, or None if there is nothing to
do. The result of that call is awaited if it is a coroutine.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

from aionode.clock import MachineTime
from rclpy._impl.causes import noting, party_of, timer_party
from rclpy._impl.errors import InvalidHandle, TimerCancelledError
from rclpy._impl.wait_set import WaitSet
from rclpy.subscription import Subscription

if TYPE_CHECKING:
    from rclpy._impl.destroyable import Arrivals
    from rclpy._protocols import ExecutorLike, NodeLike
    from rclpy.callback_groups import Entity


__all__ = [
    "Ready",
    "Take",
    "await_or_execute",
    "find_ready",
    "is_awaited",
    "is_still_due",
    "wait_set_of",
]


Take = Callable[["ExecutorLike", Any], "Callable[[], Any] | None"]
Ready = tuple["Entity", "NodeLike", Take]

now_ns = MachineTime().system_ns

MESSAGE_ONLY = Subscription.CallbackType.MessageOnly


def find_ready(
    nodes: list[NodeLike], can_execute: Callable[[Entity], bool], context: Any
) -> list[Ready]:
    """Return what is ready now, in the order of a round; note where nothing was."""
    ready: list[Ready] = []
    for node in nodes:
        if node._Node__waitables:  # few nodes have any
            ready += [
                (waitable, node, take_waitable)
                for waitable in tuple(node._Node__waitables)
                if can_execute(waitable) and is_ready(waitable, context)
            ]
    for node in nodes:
        handle = node._Node__handle
        messages, responses, requests = handle.messages, handle.responses, handle.requests
        # One kind after the other, and not in a loop: this is done for each message.
        if node._timers:
            ready += among(node._timers, node, take_timer, can_execute)
        if messages.last is not messages.seen:
            ready += arrived(messages, node._subscriptions, node, take_subscription, can_execute)
        if node._guards:
            ready += among(node._guards, node, take_guard_condition, can_execute)
        if responses.last is not responses.seen:
            ready += arrived(responses, node._clients, node, take_client, can_execute)
        if requests.last is not requests.seen:
            ready += arrived(requests, node._services, node, take_service, can_execute)
    return ready


def among(
    entities: list[Any], node: NodeLike, take: Take, can_execute: Callable[[Entity], bool]
) -> list[Ready]:
    """Return the ready ones of a node's entities of one kind."""
    return [
        (entity, node, take)
        # A copy: another thread may destroy one meanwhile, and the next one would be skipped.
        for entity in tuple(entities)
        if entity._handle.ready() and can_execute(entity)
    ]


def is_still_due(call: Ready) -> bool:
    """Return whether a timer that was ready when the round began is still due; others are."""
    entity: Any = call[0]
    return call[2] is not take_timer or bool(entity._handle.ready())


def arrived(
    arrivals: Arrivals,
    entities: list[Any],
    node: NodeLike,
    take: Take,
    can_execute: Callable[[Entity], bool],
) -> list[Ready]:
    """Return those for which something has arrived; note it if none is ready."""
    last = arrivals.last
    found = False
    ready: list[Ready] = []
    for entity in tuple(entities):  # a copy, as above
        if entity._handle.ready():
            found = True
            if can_execute(entity):
                ready.append((entity, node, take))
    if not found:
        arrivals.seen = last
    return ready


def is_ready(waitable: Any, context: Any) -> bool:
    """Return whether something can be taken from a waitable."""
    wait_set = wait_set_of([waitable], context)
    wait_set.look()
    ready: bool = waitable.is_ready(wait_set)
    return ready


def wait_set_of(waitables: list[Any], context: Any) -> WaitSet:
    """Return a wait set with the handles of waitables, except those being destroyed."""
    wait_set = WaitSet(0, 0, 0, 0, 0, 0, context)
    for waitable in waitables:
        try:
            with waitable:
                waitable.add_to_wait_set(wait_set)
        except InvalidHandle:
            continue
    return wait_set


async def await_or_execute(callback: Callable[..., Any], *args: Any) -> Any:
    """Call `callback`, and await it if it is a coroutine function."""
    if inspect.iscoroutinefunction(callback):
        return await callback(*args)
    return callback(*args)


def take_timer(executor: ExecutorLike, timer: Any) -> Callable[[], Any] | None:
    """Take a call of a timer that is due."""
    try:
        with timer.handle:
            called = timer.handle.call_timer_with_info()
    except (InvalidHandle, TimerCancelledError):
        return None
    callback = timer.callback
    if callback is None:
        return None
    name = timer.info_argument(callback)
    if name is not None:
        callback = partial(callback, **{name: timer.info(called)})
    log = timer.handle.causes
    if log is None:
        return partial(callback)
    owners = (
        node.get_fully_qualified_name() for node in executor.get_nodes() if timer in node._timers
    )
    party = timer_party(timer, next(owners, ""))
    return noting(partial(run, partial(callback)), log, party, "timer", (party.gid, 0))


def take_subscription(executor: ExecutorLike, subscription: Any) -> Callable[[], Any] | None:
    """Take the next message of a subscription."""
    handle = subscription._handle
    if handle._unwanted:
        return None
    taken = handle.take_sample(subscription.msg_type, subscription.raw)
    if taken is None:
        return None
    if subscription._callback_type is MESSAGE_ONLY:
        call = partial(subscription._callback, taken[0])
    else:
        call = partial(subscription._callback, taken[0], handle.info_of(taken))
    if handle.causes is None:
        return call
    party = party_of(subscription, handle.endpoint, subscription._callback)
    _, gid, sequence, _, arrived_ns, _ = taken
    waited_ns = now_ns() - arrived_ns
    return noting(partial(run, call), handle.causes, party, "message", (gid, sequence), waited_ns)


def take_guard_condition(executor: ExecutorLike, guard: Any) -> Callable[[], Any] | None:
    """Take the trigger of a guard condition."""
    guard.handle.take()
    return None if guard.callback is None else partial(guard.callback)


def take_client(executor: ExecutorLike, client: Any) -> Callable[[], Any] | None:
    """Take the next response of a client."""
    try:
        with client.handle:
            header, response = client.handle.take_response(client.srv_type.Response)
    except InvalidHandle:
        return None
    if header is None:
        return None
    try:
        future = client.get_pending_request(header.request_id.sequence_number)
    except KeyError:  # it was given up
        return None

    def complete() -> None:
        future._cause = client.handle.take_cause(header.request_id.sequence_number)
        future._set_executor(executor)
        future.set_result(response)

    return complete


def take_service(executor: ExecutorLike, service: Any) -> Callable[[], Any] | None:
    """Take the next request of a service."""
    try:
        with service.handle:
            request, header = service.handle.service_take_request(service.srv_type.Request)
    except InvalidHandle:
        return None
    if header is None:
        return None

    async def answer() -> None:
        try:
            response = await await_or_execute(
                service.callback, request, service.srv_type.Response()
            )
        except BaseException:
            service.handle.give_up(header.request_id)
            raise
        # A program may put its own function in this place, and answer later.
        service.send_response(response, header)

    log = service.handle.causes
    if log is None:
        return answer
    sequence, gid = header.request_id
    party = party_of(service, service.handle.endpoint, service.callback)
    waited_ns = now_ns() - header.received_timestamp
    return noting(answer, log, party, "request", (gid, sequence), waited_ns)


def take_waitable(executor: ExecutorLike, waitable: Any) -> Callable[[], Any] | None:
    """Take the data of a waitable."""
    data = waitable.take_data()

    async def execute() -> None:
        for future in waitable._futures:
            future._set_executor(executor)
        await waitable.execute(data)

    return execute


def is_awaited(call: Callable[[], Any], result: Any) -> bool:
    """Return whether the result of a call is a coroutine to be awaited.

    As in rclpy, a coroutine that another function than a coroutine function returns is not.
    """
    return inspect.iscoroutine(result) and (
        not isinstance(call, partial) or inspect.iscoroutinefunction(call)
    )


def run(call: Callable[..., Any]) -> Any:
    """Call, and return a coroutine only if it is to be awaited."""
    result = call()
    return result if is_awaited(call, result) else None
