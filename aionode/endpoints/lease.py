"""Command leases: the right to publish commands, with a stop that is sent when it ends."""

from __future__ import annotations

import asyncio
import enum
import math
import threading
import traceback
from contextlib import suppress
from functools import partial
from typing import TYPE_CHECKING, Any, Final, Generic, Protocol, Self, TypeVar

from aionode.clock import S_TO_NS, Clock, MachineTime, SilenceAlarm
from aionode.endpoints.core.lease_watch import REPEAT_S, watch
from aionode.engine.loop_affinity import LoopAffinity
from aionode.errors import ForkedProcessError, LeaseExpiredError, brief
from aionode.logging import get_logger

if TYPE_CHECKING:
    from collections.abc import Callable
    from types import TracebackType

    from aionode.clock import TimeBase
    from aionode.engine.transport.base import StopSender

__all__ = ["CommandLease", "send_stops"]

MsgT = TypeVar("MsgT")
LeasedT_contra = TypeVar("LeasedT_contra", contravariant=True)

LOCK_S: Final = 0.05
"""How long another thread waits for a command that is being published."""


def send_stops(within_sec: float = REPEAT_S) -> bool:
    """Send the stops of all open leases of this process now, and give them time to leave.

    For programs that are about to end without their event loop; `aionode.run` does this itself. It
    may be called in any thread and in a signal handler, even while the loop is blocked. The leases
    are expired afterwards. It takes `within_sec` if a lease is open, and no time otherwise.

    Args:
        within_sec: How long it takes, in seconds.

    Returns:
        Whether a lease was open.
    """
    if not watch.stop_all():
        return False
    threading.Event().wait(within_sec)  # meanwhile the stop is sent again
    return True


class LeasedPublisher(Protocol[LeasedT_contra]):
    """What a lease uses of its publisher."""

    _affinity: LoopAffinity

    @property
    def topic_name(self) -> str:
        """The full name of the topic."""

    def _hold(
        self, lease: Any, stop: LeasedT_contra | bytes | bytearray | memoryview | None
    ) -> None:
        """Give `lease` the exclusive right to publish, and prepare its stop, if there is one.

        Raises:
            LeaseHeldError: another lease has it.
        """

    def _let_go(self) -> None:
        """Allow `publish` again."""

    def _publish_leased(
        self, msg: LeasedT_contra | bytes | bytearray | memoryview, source_ns: int
    ) -> None:
        """Publish a command, stamped with a time."""

    def _number_stop(self, step: int) -> tuple[int, int]:
        """Return the sequence number of the stop, `step` after the last one, and its time."""

    def _stop_of(self, stop: LeasedT_contra | bytes | bytearray | memoryview) -> Any:
        """Return a stop as a message that nobody modifies.

        Raises:
            TypeError: it is not of the publisher's type.
        """

    def _prepare_stop(
        self, stop: LeasedT_contra, number: Callable[[], int]
    ) -> tuple[StopSender, ...]:
        """Return the stop senders of a lease, one per transport; `number` numbers the stop."""


class State(enum.Enum):
    """The states of a lease, in order: it never goes back."""

    NEW = enum.auto()
    OPEN = enum.auto()
    SENT = enum.auto()
    """The stop was sent past the event loop, which does the rest when it continues."""
    ENDED = enum.auto()


class CommandLease(Generic[MsgT]):
    """The right to publish commands while its holder is alive. Created by `Publisher.lease`.

    ::

        async with publisher.lease(stop=Twist(), ttl_sec=0.3) as lease:
            while True:
                lease.publish(await next_command())

    The stop is sent once: as soon as the block ends, however it ends; when the holder has published
    nothing for the time to live; when the publisher, its node or its context is destroyed, or the
    node fails. It is also sent when a second Ctrl-C ends `aionode.run` at once, when the
    interpreter exits, and before Ctrl-Z suspends a process whose main thread runs the event loop.
    None of this needs the holder's task to run again, nor, for subscriptions in other processes,
    the event loop.

    Where the stop depends on the command, as for an arm that is to hold its last position, each
    command brings its own: ``lease.publish(command, stop=command)``.

    When the time to live is over, the block is cancelled as by `asyncio.timeout`, and raises
    LeaseExpiredError. `publish` checks the time itself, so a holder that was frozen sends nothing.

    Raises:
        TypeError: `ttl_sec` is not a number, or `clock` not a clock.
        ValueError: `ttl_sec` is not positive and finite.
    """

    # The state, guarded by the lock, decides who sends the stop. The loop's thread holds the lock
    # from the check of the time until the command is written, so that no command follows another
    # thread's stop. The lock is reentrant because a signal handler may run meanwhile.

    def __init__(
        self,
        publisher: LeasedPublisher[MsgT],
        stop: MsgT | bytes | bytearray | memoryview | None,
        ttl_sec: float,
        clock: Clock | None,
        time_base: TimeBase,
        refuse: Callable[[], None] | None = None,
    ) -> None:
        topic = publisher.topic_name
        if isinstance(ttl_sec, bool) or not isinstance(ttl_sec, int | float):
            raise TypeError(
                f"lease of {topic}: ttl_sec={brief(ttl_sec)} is not a number; pass seconds"
            )
        if not 0 < ttl_sec < math.inf:
            raise ValueError(f"lease of {topic}: ttl_sec={ttl_sec}; use more than 0 seconds")
        if clock is not None and not isinstance(clock, Clock):
            raise TypeError(f"lease of {topic}: clock={brief(clock)}; pass a Clock, or None")
        self._publisher = publisher
        self._stop = stop
        self._refuse = refuse
        self._ttl_sec = ttl_sec
        self._clock = clock
        self._time_base = time_base.through_suspend()
        self._silence: SilenceAlarm | None = None  # from the start of the block to the stop
        # Held to act on `_state`, by the loop or a thread past it, so that only one of them sends
        # the stop. Reentrant, as a signal handler may interrupt the holder.
        self._lock = threading.RLock()
        self._state = State.NEW
        self._is_publishing = False
        self._asked = ""  # why another thread is ending it, if one is
        self._numbers = (0, 0)  # the stop's sequence number and time
        self._message: MsgT | None = None  # the stop, if there is one yet; never modified
        self._senders: tuple[StopSender, ...] = ()
        self._refusal: Callable[[], Exception] | None = None  # for `publish` after the end
        # The loop of the publisher's node, or of the block if the node is not running.
        self._loop: asyncio.AbstractEventLoop | None = None
        self._affinity = LoopAffinity()
        # The block: its task, its loop, and whether the expiry has cancelled it.
        self._task: asyncio.Task[Any] | None = None
        self._block_loop: asyncio.AbstractEventLoop | None = None
        self._cancelling = 0
        self._has_expired = False
        self._cancelled = False
        self._left = False

    def __repr__(self) -> str:
        state = self._state.name.lower()
        return f"<CommandLease of {self._publisher.topic_name} {state} ttl_sec={self._ttl_sec:g}>"

    @property
    def held(self) -> bool:
        """Whether commands may be published: it was entered, and its stop has not been sent."""
        return self._state is State.OPEN and not self._is_silent()

    # The block

    async def __aenter__(self) -> Self:
        """Acquire the right to publish, and encode the stop.

        Raises:
            LeaseHeldError: another lease of the publisher is held (a RuntimeError).
            TypeError: the stop is not of the publisher's type.
            MessageError: a value of the stop does not fit its field (a ValueError).
            EntityDestroyedError: the publisher or its node was destroyed (a RuntimeError).
            EntityInactiveError: the publisher's managed node is not active (a RuntimeError).
            RuntimeError: the lease was entered before.
        """
        self._task = asyncio.current_task()
        if self._task is None:
            raise RuntimeError(f"{self!r}: enter it in a task")
        self._cancelling = self._task.cancelling()
        self._block_loop = asyncio.get_running_loop()
        affinity = self._publisher._affinity
        if affinity.is_other_thread():
            affinity.wait_for(self._open)
        else:
            self._open()
        return self

    def _open(self) -> None:
        """Open the lease, on the loop of the publisher's node, which ends it as well."""
        if self._state is not State.NEW:
            raise RuntimeError(f"{self!r}: a lease is entered once; call publisher.lease() again")
        if self._refuse is not None:
            self._refuse()
        self._publisher._hold(self, self._stop)
        self._affinity.attach()
        self._loop = asyncio.get_running_loop()
        self._state = State.OPEN
        self._silence = SilenceAlarm(
            self._time_base, round(self._ttl_sec * S_TO_NS), self._on_silence, self._clock
        )
        self._silence.start()
        watch.add(self)

    def prepare(self, stop: MsgT | None = None) -> None:
        """Encode the stop for each transport, and again when the publisher starts using another."""
        stop = self._message if stop is None else stop
        if stop is not None:
            self._senders = self._publisher._prepare_stop(stop, lambda: self._numbers[0])
            self._message = stop

    async def __aexit__(
        self,
        exc_type: type[BaseException] | None,
        exc: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """Send the stop, unless already sent.

        Raises:
            LeaseExpiredError: the time to live ran out before (a TimeoutError).
        """
        # Nothing is awaited here, as the block may end because its coroutine is closed.
        self._left = True
        if self._state in (State.OPEN, State.SENT) and self._affinity.is_other_thread():
            self._affinity.wait_for(self._end_block)
        else:
            self._end_block()
        if not self._has_expired:
            return
        # As in asyncio.timeout, a cancellation by others propagates.
        is_ours = self._cancelled and self._task is not None
        if is_ours and self._task.uncancel() > self._cancelling:  # type: ignore[union-attr]  # as above
            return
        if exc is None or (is_ours and isinstance(exc, asyncio.CancelledError)):
            raise self._refused() from exc

    def _end_block(self) -> None:
        self.end_for(lambda: LeaseExpiredError(self._publisher.topic_name, "its block has ended"))

    def _cancel_block(self) -> None:
        """Cancel the block, which may run in another loop, after the stop was sent."""
        if self._block_loop is not None and not self._left:
            try:
                self._block_loop.call_soon_threadsafe(self._cancel_task)
            except RuntimeError:  # the loop is closed, and with it the block
                return

    def _cancel_task(self) -> None:
        if not self._left and self._task is not None:
            self._cancelled = True
            self._task.cancel()

    # Commands

    def publish(
        self,
        msg: MsgT | bytes | bytearray | memoryview,
        stop: MsgT | bytes | bytearray | memoryview | None = None,
    ) -> None:
        """Publish a command like `Publisher.publish`, and restart the time to live.

        Like `Publisher.publish`, it may be called from any thread.

        Args:
            msg: The command.
            stop: The stop from this command on; by default it remains as it is. It is validated and
                encoded before the command is sent, and may be the same object.

        Raises:
            LeaseExpiredError: the time to live is over, or the block has ended; only the stop was
                sent (a TimeoutError).
            ValueError: the lease has no stop yet; nothing was sent.
            RuntimeError: the lease was not entered.
            Exception: the exceptions of `Publisher.publish`; the stop is as before, and the time to
                live is not restarted.
        """
        if self._affinity.is_other_thread():
            self._affinity.wait_for(self.publish, msg, stop)
            return
        with self._lock:
            # Both are from before the time to live is checked. So a command of a holder that is
            # frozen in the middle is as old as the check that allowed it: it does not renew the
            # lease, and wheels that have stopped meanwhile ignore it.
            at_ns, source_ns = self._time_base.steady_ns(), self._time_base.system_ns()
            self._look()
            if self._refusal is not None or self._state is not State.OPEN:
                raise self._refused()
            if stop is None and self._message is None:
                raise ValueError(f"{self!r}: it has no stop yet; pass stop= with the first command")
            self._is_publishing = True
            before = self._message, self._senders
            try:
                if stop is not None:
                    self.prepare(self._publisher._stop_of(stop))
                self._publisher._publish_leased(msg, source_ns)
            except BaseException:
                self._message, self._senders = before
                raise
            finally:
                self._is_publishing = False
                self._end_if_refused()
            if self._silence is not None:
                is_first = self._silence.left_ns() is None
                self._silence.note(at_ns)
                if is_first:
                    watch.wake()

    def _refused(self) -> Exception:
        if self._refusal is not None:
            return self._refusal()
        return RuntimeError(f"{self!r}: use `async with publisher.lease(...) as lease`")

    # Time

    def _is_silent(self) -> bool:
        """Return whether the time to live is over; it starts with the first command."""
        left_ns = None if self._silence is None else self._silence.left_ns()
        return left_ns is not None and left_ns <= 0

    def _on_silence(self, periods: int) -> bool:  # noqa: ARG002  # the first one ends it
        """End the lease; the alarm already counts the next period, so `_is_silent` would not do."""
        with self._lock:
            if self._state is State.OPEN:
                self._expire(self._of_silence())
        return False

    def _look(self) -> None:
        """End the lease, on the loop, if its time to live is over or a thread has asked for it."""
        with self._lock:
            if self._state is State.OPEN and (self._asked or self._is_silent()):
                self._expire(self._asked or self._of_silence())

    def _of_silence(self) -> str:
        return f"nothing was published for {self._ttl_sec:g} s"

    def _expire(self, reason: str) -> None:
        """Send the stop, and then end the block."""
        self._has_expired = True
        self.end_for(lambda: LeaseExpiredError(self._publisher.topic_name, reason))
        self._cancel_block()

    # The end, on the loop's thread

    def end_for(self, refusal: Callable[[], Exception]) -> None:
        """Send the stop unless another thread has, and do the rest in either case.

        Args:
            refusal: Creates the exception that `publish`, and perhaps the block, raise from now on.
        """
        with self._lock:
            if self._state is State.OPEN:
                self._refusal = refusal
                if self._is_publishing:  # interrupted by a signal handler: wait for its end
                    return
                self._number(1)
            elif self._state is not State.SENT:
                return
            self._state = State.ENDED
            self._send(lambda sender, *numbers: sender.send(*numbers))
        if self._silence is not None:
            self._silence.stop()
        watch.remove(self)
        self._publisher._let_go()

    def finish(self) -> None:
        """Do the rest now if another thread has sent the stop or the time to live is over."""
        self._look()
        if self._state is State.SENT:
            self._take_over()

    def _end_if_refused(self) -> None:
        """Finish an end that was requested during a publication, after that command."""
        if self._refusal is not None:
            if self._state is State.SENT:
                self._number(2)
            self.end_for(self._refusal)

    def _number(self, step: int) -> None:
        """Number the stop; without one, the gap would look like a lost message."""
        if self._message is not None:
            self._numbers = self._publisher._number_stop(step)

    def _send(self, send: Callable[[StopSender, int, int], None]) -> None:
        """Send the stop through each transport; a failure of one does not affect the others."""
        for sender in self._senders:
            try:
                send(sender, *self._numbers)
            except Exception:  # noqa: BLE001  # logged, as whoever ends a lease could do nothing about it
                get_logger("aionode.lease").error(
                    f"{self._publisher.topic_name}: the stop of a lease was not sent over one "
                    f"transport:\n{traceback.format_exc()}"
                )

    # Past the loop: in any thread

    @property
    def is_sent(self) -> bool:
        """Whether the stop was sent past the loop, which has not yet taken over."""
        return self._state is State.SENT

    @property
    def is_orphaned(self) -> bool:
        """Whether the loop is closed."""
        return self._loop is not None and self._loop.is_closed()

    def left_ns(self) -> int | None:
        """Return the rest of the time to live in nanoseconds; None if it is not running.

        A manual clock of a test ends leases on the loop only.
        """
        if self._silence is None or not isinstance(self._time_base, MachineTime):
            return None
        return self._silence.left_ns()

    def send_past_loop(self, reason: str) -> bool:
        """Send the stop, unless another thread is doing so; see `Watched`."""
        self._asked = reason  # a holder that publishes without pause may never leave the lock free
        is_locked = self._lock.acquire(timeout=LOCK_S)
        if not (is_locked or reason):
            return False  # a command is being published
        try:
            if self._state is not State.OPEN or not (reason or self._is_silent()):
                return False
            expired = partial(LeaseExpiredError, self._publisher.topic_name)
            self._refusal = partial(expired, reason or self._of_silence())
            self._has_expired = True
            self._number(1 + self._is_publishing)
            self._state = State.SENT
            self._send(lambda sender, *numbers: sender.send_past_loop(*numbers))
        finally:
            if is_locked:
                self._lock.release()
        if self._loop is not None:
            with suppress(RuntimeError):  # it is closed
                self._loop.call_soon_threadsafe(self._take_over)
        return True

    def _take_over(self) -> None:
        """Continue on the loop after the stop was sent past it."""
        if self._state is State.SENT and self._refusal is not None:
            self.end_for(self._refusal)
        self._cancel_block()

    def repeat(self) -> None:
        """Send the stop again, unless the loop has taken over."""
        if self._lock.acquire(timeout=LOCK_S):
            try:
                if self._state is State.SENT:
                    self._send(lambda sender, *_: sender.repeat())
            finally:
                self._lock.release()

    def leave_to_parent(self) -> None:
        """Stop sending, in a forked child."""
        self._lock = threading.RLock()
        self._state = State.ENDED
        self._has_expired = False
        self._refusal = lambda: ForkedProcessError(f"lease of {self._publisher.topic_name}")
