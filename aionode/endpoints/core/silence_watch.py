"""Detects that a subscription's topic has fallen silent, so that whatever it drives can stop.

Invariants, whatever happens in whichever order:

1. `on_silence` is called once per silence: after a message was passed to the callback, when nothing
   has arrived for `silence_sec` or all who published have left.
2. When it is called, no callback of the subscription is running and nothing is queued.
3. A message published before `on_silence` was called is never passed to the callback afterwards,
   whatever delayed it: a queue or a socket at either end, or a retransmission. Nor is one that a
   transient local publisher has kept for `silence_sec` or longer.
4. Nothing queued is passed to the callback while `on_silence` is due. So the time is checked
   whenever a message arrives or leaves the queue, not only when the alarm fires: an event loop that
   was blocked handles queue, socket and alarm in any order.
"""

from __future__ import annotations

import asyncio
import math
from typing import TYPE_CHECKING, Any

from msgspec import Struct

from aionode._process.concurrency import checkpoint
from aionode._process.later import DelayedCalls
from aionode._process.recent import Recent
from aionode.clock import S_TO_NS, Clock, SilenceAlarm, perf_ns
from aionode.endpoints.core.callback_runner import accepts
from aionode.endpoints.core.node_tasks import create_own_task
from aionode.endpoints.core.subscription_reader import CausalReader
from aionode.engine.rules.missing_messages import REMEMBERED_PUBLISHERS
from aionode.engine.rules.publication_times import PublicationTimes
from aionode.errors import brief
from aionode.qos import DurabilityPolicy

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine

    from aionode.clock import TimeBase
    from aionode.endpoints.core.callback_runner import CallbackRunner
    from aionode.endpoints.core.endpoint import Endpoint
    from aionode.endpoints.core.subscription_reader import SubscriptionReader
    from aionode.engine.transport.base import SampleInfo
    from aionode.graph import EndpointInfo

__all__ = ["SILENCE_SEC", "Silence", "SilenceWatch"]

SILENCE_SEC = 0.3
"""Default for the longest silence of a topic: three commands at 10 Hz."""

NOTICE_S = 0.3
"""Time after which a cancelled callback that delays `on_silence` is named in the log."""

MOMENT_S = 0.05
"""Time after a publisher leaves until it is clear whether its whole process has gone."""

RETURN_S = 1.0
"""Time within which a process with a lost connection may return, since recovery cuts some.

Zenoh reconnects within some tenths of a second, and declares within milliseconds.
"""

ROUTER_S = 2.0
"""A process that leaves this shortly before or after a router may only be unreachable."""


class Silence(Struct, frozen=True):
    """A program's settings for a topic that falls silent.

    Attributes:
        on_silence: Called without arguments, sync or async.
        silence_ns: The longest silence.
        clock: The clock that measures the silence; None for the steady clock.
    """

    on_silence: Callable[[], object]
    silence_ns: int
    clock: Clock | None = None

    @classmethod
    def given(
        cls,
        on_silence: Callable[[], object] | None,
        silence_sec: float,
        clock: Clock | None,
        subject: str,
        *,
        has_callback: bool,
    ) -> Silence | None:
        """Parse the arguments; return None if there is nothing to call.

        Raises:
            CallbackSignatureError: `on_silence` takes arguments (a TypeError).
            TypeError: an argument has the wrong type; there is no callback; or there are settings
                without `on_silence`, so that a robot would not be stopped.
            ValueError: `silence_sec` is not positive, or not finite.
        """
        if on_silence is None:
            if silence_sec != SILENCE_SEC or clock is not None:
                raise TypeError(
                    f"{subject}: silence_sec and clock say when on_silence is called, but there is "
                    "no on_silence; give a function without parameters"
                )
            return None
        accepts(on_silence, 0, subject=f"{subject}, on_silence", wanted="()")
        if not has_callback:
            raise TypeError(
                f"{subject}: on_silence stops what the callback drives, but there is no callback; "
                "give one, or limit the wait: asyncio.timeout around receive()"
            )
        if clock is not None and not isinstance(clock, Clock):
            raise TypeError(
                f"{subject}: clock is {brief(clock)}; give a clock such as node.get_clock(), or "
                "nothing for the steady clock"
            )
        return cls(on_silence, to_silence_ns(silence_sec, subject), clock)


class SilenceWatch:
    """Watches the publishers and messages of one subscription, and passes its messages on.

    Args:
        entity: The subscription.
        reader: Its queue.
        runner: Runs its callback.
        make_runner: Makes the runner of `on_silence`.
        silence: The program's settings.
        time_base: The source of time.
        is_linked: Returns whether a publisher is connected by a link; None if it never was.
    """

    def __init__(
        self,
        entity: Endpoint,
        reader: SubscriptionReader,
        runner: CallbackRunner,
        make_runner: Callable[[Callable[[], object]], CallbackRunner],
        silence: Silence,
        time_base: TimeBase,
        is_linked: Callable[[bytes], bool | None],
    ) -> None:
        self._entity = entity
        self._reader = reader
        self._runner = runner
        self._on_silence = make_runner(silence.on_silence)
        self._is_linked = is_linked
        self._silence_ns = silence.silence_ns
        steady = time_base.through_suspend()
        self._steady_ns = steady.steady_ns
        self._system_ns = time_base.system_ns
        self._clock = silence.clock
        durability = entity._endpoint.qos.resolved().durability
        self._gets_history = durability is DurabilityPolicy.TRANSIENT_LOCAL
        self._alarm = SilenceAlarm(steady, silence.silence_ns, self._on_alarm, silence.clock)
        self._times = PublicationTimes()
        self._enabled = True
        self._runs = False
        # Whether a message was passed to the callback since the last silence.
        self._handed = False
        # The publisher of the newest message since the last silence, and when each publisher that
        # has not left was last heard, the latest last.
        self._newest = b""
        self._newest_ns = 0
        self._heard: Recent[bytes, int] = Recent(REMEMBERED_PUBLISHERS)
        # Whether a silence was detected, and when `on_silence` was last called.
        self._due = False
        self._called_ns: int | None = None
        # Callbacks that are in progress.
        self._running: set[asyncio.Task[None]] = set()
        self._delayed = DelayedCalls()  # what to look at later; nothing, once the watch is reset
        entity._watch(self._note_publisher)

    # Lifetime

    def start(self) -> None:
        """Start watching; the node runs now."""
        self._runs = True
        if self._heard:
            # A node that was not running could not handle them, so they count as fresh.
            self._alarm.note()
        self._alarm.start()

    def close(self) -> None:
        """Stop watching."""
        self._runs = False
        self._due = False
        self._alarm.stop()
        self._forget()

    def enable(self, *, enabled: bool) -> None:
        """Start to watch, or stop and return to the state before the first message."""
        self._enabled = enabled
        if not enabled:
            self._forget()

    def _forget(self) -> None:
        """Return to the state before the first message."""
        self._alarm.forget()
        self._handed = False
        self._newest = b""
        self._heard.clear()
        self._delayed.cancel()

    # Messages

    def admits(self, sample_info: SampleInfo) -> bool:
        """Record an arrived message; return whether to queue it."""
        # In this order, so that a message does not look too old if the process is preempted in
        # between.
        system_ns = self._system_ns()
        now_ns = self._steady_ns()
        system_began_ns = now_ns - system_ns
        arrived_ns = now_ns
        if sample_info.arrived_ns:
            arrived_ns = min(now_ns, sample_info.arrived_ns + system_began_ns)
        gid = sample_info.gid
        published_ns = self._times.published_ns(
            gid, sample_info.source_ns, arrived_ns, system_began_ns
        )
        if not self._enabled:
            return True
        if self._runs and self._alarm.periods():
            if self._waited_in_time(published_ns, now_ns):
                arrived_ns = published_ns
            else:
                self._fire()
        if (
            self._due
            or (self._called_ns is not None and published_ns < self._called_ns)
            or (self._gets_history and self._is_history(published_ns, now_ns))
        ):
            self._reader.stats.dropped += 1
            return False
        self._hear(gid, arrived_ns)
        return True

    def _waited_in_time(self, published_ns: int, now_ns: int) -> bool:
        """Whether a message arrived in time but was read late because the loop was busy.

        It did if neither the silence before it nor its own wait was too long.
        """
        by_ros_time = self._clock is not None and self._clock.ros_time_is_active
        return (
            not by_ros_time
            and published_ns - self._newest_ns < self._silence_ns
            and now_ns - published_ns < self._silence_ns
        )

    def _is_history(self, published_ns: int, now_ns: int) -> bool:
        """Whether a message was kept for late subscriptions until its topic counted as silent."""
        by_ros_time = self._clock is not None and self._clock.ros_time_is_active
        return not by_ros_time and now_ns - published_ns >= self._silence_ns

    def _hear(self, gid: bytes, arrived_ns: int) -> None:
        self._heard.pop(gid, None)  # so that it is forgotten last
        self._heard.put(gid, arrived_ns)
        self._newest = gid
        self._newest_ns = arrived_ns
        self._alarm.note(arrived_ns)

    # Silence

    def _on_alarm(self, _: int) -> bool:
        self._fire()
        return False  # until the next message

    def _fire(self) -> None:
        """Drop and cancel whatever may still move the robot, and schedule `on_silence`."""
        self._forget()
        self._due = True
        self._reader.discard()
        self._reader.wake_writers()
        self._stop_callbacks()
        self._reader.wake_readers()

    def _stop_callbacks(self) -> None:
        """Cancel running callbacks, and log those that `on_silence` has to wait for."""
        if not self._running:
            return
        if self._runner.offload:
            self._say_waiting("runs in a thread, which cannot be cancelled")
            return
        for task in self._running:
            if not task.cancelling():
                task.cancel()
        self._delayed.add(NOTICE_S, lambda: self._say_waiting("was cancelled and has not ended"))

    def _say_waiting(self, why: str) -> None:
        if not (self._due and self._running):
            return
        self._entity._callbacks.logger.warning(
            f"{self._runner.subject} {why}: on_silence waits for its end, though the topic is "
            "silent"
        )

    # Publishers

    def _note_publisher(self, publisher: EndpointInfo, present: bool) -> None:
        """Investigate when a publisher that was heard leaves."""
        if present or publisher.gid not in self._heard:
            return
        if publisher.node.participant == self._entity._endpoint.node.participant:
            self._lose(publisher.gid)
        else:
            self._look_in(MOMENT_S, publisher, perf_ns())

    def _look_in(self, delay_s: float, publisher: EndpointInfo, gone_ns: int) -> None:
        """Check later what became of a publisher; in real time, as networks have no other.

        A killed process and one that was cut off look alike: all their tokens disappear. A
        destroyed publisher leaves its node behind.
        """

        def look() -> None:
            graph = self._entity._graph
            if publisher in graph.opposites(self._entity._endpoint):
                return  # it has returned
            linked = self._is_linked(publisher.gid)
            if linked is False or publisher.node in graph.nodes_named(
                publisher.node.fully_qualified_name
            ):
                self._lose(publisher.gid)
            elif linked:
                return  # only Zenoh has lost it; its messages arrive over the link
            elif delay_s == MOMENT_S:
                self._look_in(RETURN_S, publisher, gone_ns)
            elif gone_ns - graph.router_lost_ns > ROUTER_S * S_TO_NS:
                self._lose(publisher.gid)

        self._delayed.add(delay_s, look)

    def _lose(self, gid: bytes) -> None:
        self._heard.pop(gid, None)
        self._fire_if_deserted()

    def _fire_if_deserted(self) -> None:
        """Fire if the publisher of the newest message has left and no other was heard lately.

        It does not fire before that message was passed to the callback, as a publisher may be
        created for a single message.
        """
        if not (self._handed and self._runs and self._newest) or self._newest in self._heard:
            return
        since_ns = self._steady_ns() - self._silence_ns
        if all(heard_ns <= since_ns for heard_ns in self._heard.values()):
            self._fire()

    # The consumer

    async def consume(
        self,
        handle: Callable[[int, Any], Coroutine[Any, Any, None] | None],
        concurrent: bool | int,  # an int is a number of callbacks, not a bool
    ) -> None:
        """Pass each message to `handle`, and call `on_silence` in between, until cancelled.

        Args:
            handle: Runs what can run at once, and returns the rest to await, if any.
            concurrent: How many of these may run at once, as in `consume` of callbacks.

        Raises:
            Exception: what a callback raised; in a group, if several may run at once.
        """
        limit = None if concurrent is True else max(concurrent, 1)
        try:
            async with asyncio.TaskGroup() as tasks:
                await self._consume(tasks, handle, limit)
        except BaseExceptionGroup as group:
            if concurrent is not False or len(group.exceptions) > 1:
                raise
            raise group.exceptions[0] from None

    async def _consume(
        self,
        tasks: asyncio.TaskGroup,
        handle: Callable[[int, Any], Coroutine[Any, Any, None] | None],
        limit: int | None,
    ) -> None:
        reader, running = self._reader, self._running
        turn_ends_ns = 0
        while True:
            while limit is not None and len(running) >= limit:
                await asyncio.wait(running, return_when=asyncio.FIRST_COMPLETED)
            if not self._due:
                await reader.wait()
            if not self._due and self._enabled and self._alarm.periods():
                self._fire()  # the loop was blocked, or the message has waited too long
            if self._due:
                await self._call_on_silence()
                continue
            if not len(reader):
                continue
            self._go_on(tasks, handle(*reader.pop()))
            self._note_handed()
            if perf_ns() >= turn_ends_ns:
                await checkpoint()
                turn_ends_ns = perf_ns() + reader.slice_ns

    def _go_on(self, tasks: asyncio.TaskGroup, rest: Coroutine[Any, Any, None] | None) -> None:
        """Run the rest of a callback, unless the callback has ended the last publisher."""
        if rest is None:
            return
        if self._due:
            # Python 3.12 and newer keep its awaitable alive until `rest` is freed. Nothing else may
            # refer to it, since garbage is finalized in any order, with a warning for coroutines.
            rest.close()
            return
        task = create_own_task(tasks, rest)
        self._running.add(task)
        task.add_done_callback(self._running.discard)

    def _note_handed(self) -> None:
        if self._enabled and not (self._handed or self._due):
            self._handed = True
            self._fire_if_deserted()

    async def _call_on_silence(self) -> None:
        """Call `on_silence` once no callback is running."""
        if self._running:
            await asyncio.wait(self._running)
        self._called_ns = self._steady_ns()
        self._due = False
        if isinstance(self._reader, CausalReader):
            self._reader.note_silence()
        rest = self._on_silence.run()
        if rest is not None:
            await rest


def to_silence_ns(silence_sec: float, subject: str) -> int:
    """Convert the longest silence to nanoseconds.

    Raises:
        TypeError: it is not a number.
        ValueError: it is not positive, or not finite.
    """
    if isinstance(silence_sec, bool) or not isinstance(silence_sec, int | float):
        raise TypeError(
            f"{subject}: silence_sec={brief(silence_sec)}; a number of seconds is needed, such as "
            "0.3"
        )
    if not (math.isfinite(silence_sec) and 1 <= silence_sec * S_TO_NS < 2**63):
        raise ValueError(
            f"{subject}: silence_sec={silence_sec}; it must be positive and finite, such as 0.3"
        )
    return round(silence_sec * S_TO_NS)
