"""Sends a policy's chunks of actions, each action at its time, under leases."""

from __future__ import annotations

from contextlib import AsyncExitStack
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from aionode._process.concurrency import DaemonThread
from aionode.clock import S_TO_NS, Time
from aionode.endpoints.core.callback_runner import accepts
from aionode.endpoints.stats import Distribution
from aionode.errors import (
    ContractError,
    EntityDestroyedError,
    EntityInactiveError,
    LeaseExpiredError,
    MessageError,
    PolicyTooSlowError,
    StaleError,
)
from aionode.learn._inference import infer
from aionode.learn._plan import ActionPlan

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from concurrent.futures import Executor
    from types import TracebackType
    from typing import Self

    import numpy.typing as npt

    from aionode import CommandLease, Node
    from aionode.clock import Alarm
    from aionode.learn._entries import Action
    from aionode.learn._observer import Observations
    from aionode.learn._plan import Numbers

__all__ = ["Actor", "ActorStats"]

QUIET_SEC: Final = 10.0
"""The minimum time between two log lines about the same thing."""


REFUSALS: Final = (
    LeaseExpiredError,
    EntityDestroyedError,
    EntityInactiveError,
    MessageError,
)
"""The exceptions raised by publishing a command after the robot stopped, or if it is invalid."""


class ActorStats:
    """Counts of the actions that an actor has sent, and of those that it has not.

    Attributes:
        latency: How long each inference of `Actor.run` took, by the node's clock.
    """

    def __init__(self, plan: ActionPlan) -> None:
        self._plan = plan
        self.latency = Distribution()

    def __repr__(self) -> str:
        latency = self.latency
        return (
            f"ActorStats(sent={self.sent}, late={self.late}, clamped={self.clamped}, "
            f"underruns={self.underruns}, inferences={latency.count}, "
            f"p50={latency.p50_ns / S_TO_NS:.3f} s, p99={latency.p99_ns / S_TO_NS:.3f} s)"
        )

    @property
    def sent(self) -> int:
        """How many actions were sent."""
        return self._plan.sent

    @property
    def late(self) -> int:
        """How many were dropped because their time had passed."""
        return self._plan.late

    @property
    def clamped(self) -> int:
        """How many of those sent exceeded a limit of the contract and were clamped to it."""
        return self._plan.clamped

    @property
    def underruns(self) -> int:
        """How many periods had no action, from the first action on."""
        return self._plan.underruns


class Actor:
    """Sends actions at their times, and stops the robot when there are none.

    Created by `Contract.act` for ``async with``. While the block is open, it holds a lease on each
    action topic: if no action is sent for the contract's `lease_sec`, the stops are sent and
    the block raises LeaseExpiredError. The time starts with the first action.

    Attributes:
        stats: Counts of what was sent and what was not.
    """

    def __init__(
        self,
        node: Node,
        actions: Sequence[Action],
        fps: float,
        observe: Callable[[], Observations],
        blend_sec: float,
    ) -> None:
        self._node = node
        self._actions = actions
        self._fps = fps
        self._observe = observe
        for action in actions:
            if action.lease_sec <= 1.5 / fps:
                raise ContractError(
                    action.topic,
                    "lease_sec",
                    f"{action.lease_sec:g} s; use more than {1.5 / fps:.3f} s for {fps:g} actions "
                    "a second, which may be half a period late",
                )
        self._clock = node.get_clock()
        self._period_ns = round(S_TO_NS / fps)
        self._labels = [label for action in actions for label in action.labels]
        self._ends = np.cumsum([action.shape[0] for action in actions])[:-1]
        lower, upper = (
            np.concatenate(limits)
            for limits in zip(*(action.limits for action in actions), strict=True)
        )
        self._plan = ActionPlan(self._period_ns, lower, upper, round(blend_sec * S_TO_NS))
        self._leases: list[CommandLease[Any]] = []
        self._stack = AsyncExitStack()
        self._alarm: Alarm | None = None
        self._asked_ns: int | None = None  # when the current inference began
        self._was_slow = False
        self._refusal: Exception | None = None  # once a lease has ended
        self.stats = ActorStats(self._plan)

    async def __aenter__(self) -> Self:
        """Take the leases on the action topics.

        Raises:
            LeaseHeldError: another lease of a publisher is held (a RuntimeError).
            EntityDestroyedError: the node was destroyed (a RuntimeError).
        """
        async with AsyncExitStack() as stack:
            for action in self._actions:
                publisher = self._node.create_publisher(action.message_type, action.topic, 1)
                stack.callback(publisher.destroy)
                lease = publisher.lease(action.stop_message(), action.lease_sec, self._clock)
                self._leases.append(await stack.enter_async_context(lease))
            self._stack = stack.pop_all()
        return self

    async def __aexit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> bool | None:
        """Stop the robot.

        Raises:
            LeaseExpiredError: no action was sent in time, so the robot was stopped before.
            MessageError: a number does not fit its field (a ValueError); the robot was stopped too.
        """
        if self._alarm is not None:
            self._alarm.cancel()
        now_ns = self._clock.now_ns()
        self._plan.note_time(now_ns)
        try:
            return await self._stack.__aexit__(kind, error, traceback)
        except LeaseExpiredError as expired:
            if isinstance(self._refusal, MessageError):
                raise self._refusal from expired
            if self._asked_ns is not None:
                expired.add_note(self._waiting(now_ns))
            raise

    # Chunks

    def plan(self, chunk: npt.ArrayLike, since: Time) -> None:
        """Send the actions of a chunk at their times, replacing what was planned for those times.

        The first action is due one period of the contract after `since`, as in the rows of a data
        set, and each further one a period later. Those whose time has passed are dropped and
        counted.

        Args:
            chunk: A row for each action: the numbers of the contract's actions, in their order.
                A single action may be passed as one row.
            since: The time of the observation that the chunk answers, `Seen.at`.

        Raises:
            ValueError: the chunk has another shape, or numbers that are not finite.
            MessageError: a number of a due action does not fit its field (a ValueError).
            LeaseExpiredError: the robot was stopped (a TimeoutError).
            EntityDestroyedError: the node was destroyed (a RuntimeError).
        """
        self._plan_rows(self._rows(chunk), since)

    def _plan_rows(self, rows: Numbers, since: Time) -> None:
        self._refuse_if_stopped()
        now_ns = self._clock.now_ns()
        if not self._plan.put(rows, since.nanoseconds + self._period_ns, now_ns):
            over_s = (now_ns - since.nanoseconds) / S_TO_NS - (len(rows) + 1) / self._fps
            self._warn(
                f"a chunk of {len(rows)} actions was dropped: its last one ended {over_s:.3f} s ago"
            )
        self._send()
        self._refuse_if_stopped()

    def send(self, action: npt.ArrayLike) -> None:
        """Send one action now, replacing what was planned: for loops that set their own pace.

        Args:
            action: The numbers of the contract's actions in their order, clamped to the limits.

        Raises:
            ValueError: the action has another number of values, or some are not finite.
            MessageError: a number does not fit its field (a ValueError).
            LeaseExpiredError: the robot was stopped (a TimeoutError).
            EntityDestroyedError: the node was destroyed (a RuntimeError).
        """
        (row,) = self._rows(np.asarray(action, np.float64)[np.newaxis])
        self._refuse_if_stopped()
        self._plan.put_now(row, self._clock.now_ns())
        self._send()
        self._refuse_if_stopped()

    def left_over(self, since: Time | None = None) -> Numbers:
        """Return what is planned as a chunk that would answer an observation of a given time.

        For real-time chunking, where policies continue what the robot is about to do.

        Args:
            since: The time, such as `Seen.at`; now by default.
        """
        time_ns = self._clock.now_ns() if since is None else since.nanoseconds
        return self._plan.left_over(time_ns + self._period_ns)

    def _rows(self, chunk: npt.ArrayLike) -> Numbers:
        rows = np.asarray(chunk, dtype=np.float64)
        width = len(self._labels)
        if rows.ndim == 1:
            rows = rows[np.newaxis]
        if rows.ndim != 2 or rows.shape[1] != width or not len(rows):  # rows, columns
            raise ValueError(
                f"chunk: its shape is {np.shape(chunk)}; pass a row of {width} numbers for each "
                f"action: {', '.join(self._labels)}"
            )
        if not np.isfinite(rows).all():
            row, column = np.argwhere(~np.isfinite(rows))[0]
            raise ValueError(
                f"chunk: {self._labels[column]} of action {row} is "
                f"{rows[row, column]}; no action of the chunk is sent"
            )
        return rows

    # Sending

    def _send(self) -> None:
        """Send what is due, and schedule the next call for the next action."""
        if self._alarm is not None:
            self._alarm.cancel()
            self._alarm = None
        now_ns = self._clock.now_ns()
        action = self._plan.take(now_ns)
        if action is not None and not self._publish(action.values):
            return
        next_ns = self._plan.next_ns
        if next_ns is None:  # the next one counts as missing half a period after it would be due
            end_ns = self._plan.end_ns
            if end_ns is None:
                return
            next_ns = end_ns + self._period_ns // 2
            if next_ns <= now_ns:
                self._note_underrun(now_ns)
                return
        self._alarm = self._clock.call_at(next_ns, self._send)

    def _publish(self, values: Numbers) -> bool:
        """Publish an action; return False if the robot was stopped."""
        stamp = self._clock.now().to_msg()
        parts = np.split(values, self._ends)
        try:
            for action, lease, part in zip(self._actions, self._leases, parts, strict=True):
                command = action.message(part, stamp)
                lease.publish(command, stop=command if action.stop == "hold" else None)
        except REFUSALS as error:
            self._refusal = error  # raised in the block when its lease ends, or by its next chunk
            return False
        return True

    def _refuse_if_stopped(self) -> None:
        if self._refusal is not None:
            raise self._refusal

    def _note_underrun(self, now_ns: int) -> None:
        self._plan.note_time(now_ns)
        text = "there is no action to send"
        self._warn(text if self._asked_ns is None else f"{text}: {self._waiting(now_ns)}")

    def _waiting(self, now_ns: int) -> str:
        asked_s = (now_ns - (self._asked_ns or now_ns)) / S_TO_NS
        return f"the policy was asked {asked_s:.3f} s ago and has not answered"

    def _warn(self, text: str) -> None:
        self._node.get_logger().warning(text, throttle_duration_sec=QUIET_SEC)

    # Policies

    async def run(self, policy: Callable[..., Any], *, executor: Executor | None = None) -> None:
        """Observe, ask a policy, and plan its chunks until cancelled or the lease ends.

        The policy is asked again as soon as the remaining plan lasts no longer than it may take to
        answer: the 99th percentile of its latency so far, plus two periods. It is never asked twice
        at the same time.

        After its first answer, before anything moves, its latency is compared with the duration of
        its chunk: if it exceeds half of that, a warning says that actions will be missing. A
        policy slower than its chunk is asked once more, as the first answer may have included
        loading or compiling; if it is too slow again, `run` raises.

        Args:
            policy: Called with the values of an observation, a dict of arrays by feature; if it
                takes two arguments, also with what is left over of its last chunk, from the time of
                the observation on. Returns a chunk; see `plan`. A coroutine function is awaited.
            executor: Where a function is called, such as a ``ProcessPoolExecutor`` that spawns its
                process; by default a thread of its own.

        Raises:
            PolicyTooSlowError: the policy takes longer than its chunk lasts; nothing was sent.
            StaleError: an observation is too old or missing (a TimeoutError).
            Exception: what the policy raised.
        """
        arguments = accepts(
            policy, 1, 2, subject="policy", wanted="(observation) or (observation, left_over)"
        )
        async with AsyncExitStack() as stack:
            if executor is None:
                executor = stack.enter_context(DaemonThread("aionode-policy"))
            observations = await stack.enter_async_context(self._observe())
            while True:
                try:
                    async for seen in observations.at(self._fps):
                        if self._wants_more():
                            given = (seen.values, self.left_over(seen.at))[:arguments]
                            await self._ask(policy, executor, given, seen.at)
                except StaleError as error:
                    if not self._is_moving():
                        raise
                    self._warn(f"the policy is not asked: {error}")
                    await self._clock.sleep(self._period_ns / S_TO_NS)

    def _is_moving(self) -> bool:
        """Return whether an action applies now."""
        end_ns = self._plan.end_ns
        return end_ns is not None and self._clock.now_ns() < end_ns

    def _wants_more(self) -> bool:
        """Return whether the policy has to be asked now so that its answer is not too late."""
        end_ns = self._plan.end_ns
        # One period until the next observation, and one to spare.
        ahead_ns = self.stats.latency.p99_ns + 2 * self._period_ns
        return end_ns is None or end_ns - self._clock.now_ns() <= ahead_ns

    async def _ask(
        self, policy: Callable[..., Any], executor: Executor, given: tuple[Any, ...], at: Time
    ) -> None:
        """Ask a policy and plan its chunk; report one that is too slow before anything moves.

        Raises:
            PolicyTooSlowError: it was too slow the second time.
        """
        self._asked_ns = asked_ns = self._clock.now_ns()
        rows = self._rows(await infer(policy, executor, *given))
        took_ns, lasts_ns = self._clock.now_ns() - asked_ns, len(rows) * self._period_ns
        self._asked_ns = None
        if self.stats.sent == 0:
            if took_ns >= lasts_ns and not self._was_slow:
                self._was_slow = True  # the first answer may have included loading or compiling
                return
            if took_ns >= lasts_ns:
                raise PolicyTooSlowError(took_ns / S_TO_NS, lasts_ns / S_TO_NS)
            if took_ns > lasts_ns / 2:
                self._node.get_logger().warning(
                    f"the policy took {took_ns / S_TO_NS:.3f} s to answer with actions for "
                    f"{lasts_ns / S_TO_NS:.3f} s, more than half of that: actions will be missing"
                )
        self.stats.latency.record(took_ns)
        self._plan_rows(rows, at)
