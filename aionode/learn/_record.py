"""Records demonstrations: each episode is a bag of its own, begun and ended over the network."""

from __future__ import annotations

import asyncio
import json
import os
import re
import shutil
from collections.abc import Iterable
from contextlib import AsyncExitStack, asynccontextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Self

from aionode._process.concurrency import run_in_thread
from aionode.action import CancelResponse
from aionode.bag import Recorder
from aionode.errors import AionodeError, BagWriteError, EpisodeError, escaped
from aionode.interfaces.std_srvs.srv import Trigger
from aionode.learn._metadata import CONTRACT_KEY, OUTCOME_KEY, TASK_KEY
from aionode.message import ActionType, Message, float64, uint64
from aionode.node import Node

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Callable, Coroutine
    from os import PathLike
    from types import TracebackType

    from aionode.action import ServerGoalHandle
    from aionode.bag import TopicStats
    from aionode.engine.context import Context
    from aionode.learn.contract import Contract

__all__ = ["Episode", "Episodes", "RecordEpisode"]

NAME: Final = re.compile(r"episode_(\d{4,9})")

FEEDBACK_SEC: Final = 0.5
"""The interval of feedback to the goal of an episode."""


class RecordEpisode(ActionType, typename="aionode_learn/action/RecordEpisode"):
    """Record an episode until it is ended, its time is over, or the goal is canceled."""

    class Goal(Message):
        """The task, empty for the recorder's; the maximum duration in seconds, 0 for no limit."""

        task: str = ""
        max_sec: float64 = 0.0

    class Result(Message):
        """The folder of the episode, its outcome, and its number of messages."""

        path: str = ""
        outcome: str = ""
        messages: uint64 = 0

    class Feedback(Message):
        """The number of messages so far, and of those lost."""

        messages: uint64 = 0
        lost: uint64 = 0


@dataclass(slots=True)
class Episode:
    """One demonstration.

    Attributes:
        path: The folder of its bag.
        task: What is demonstrated, in words.
        outcome: How it ended: ``success``, ``failure`` or ``discarded``; empty if it has not.
        stats: The numbers of messages recorded and lost, by topic.
    """

    path: Path
    task: str
    outcome: str = ""
    stats: dict[str, TopicStats] = field(default_factory=dict)
    _ended: asyncio.Event = field(default_factory=asyncio.Event)

    def discard(self) -> None:
        """Remove its bag when it ends."""
        self.outcome = "discarded"

    @property
    def messages(self) -> int:
        """The number of messages that were recorded."""
        return sum(each.recorded for each in self.stats.values())

    @property
    def lost(self) -> int:
        """The number of messages that were lost, on the way or by the recorder."""
        return sum(each.lost_in_transport + each.lost_in_recorder for each in self.stats.values())


class Episodes:
    """Records episodes into a folder: ``async with Episodes("runs", contract) as episodes:``.

    Each is a closed bag with its task, contract and outcome in the metadata, so that a copy of it
    is complete. A recorder that is killed loses at most the last second.

    ::

        async with Episodes("runs", Contract.load("contract.yaml")) as episodes:
            async with episodes.record(task="pick the cube") as episode:
                await demonstrate()
                if not robot.holds_cube:
                    episode.discard()

    Its node offers the services ``~/start``, ``~/end``, ``~/fail``, ``~/discard`` and ``~/again``
    (`std_srvs/srv/Trigger`) for pedals, buttons and the page of the gateway, and the action
    ``~/record``, whose goal contains the task.

    Args:
        folder: The folder of the episodes, which are numbered.
        contract: The contract, whose topics are recorded.
        task: The task of episodes that are given none; by default, that of the contract.
        topics: Further topics to record.
        context: The context of its nodes; defaults to `Context.default()`.
        node_name: The name of its node.

    Attributes:
        current: The episode being recorded; None in between.
        node: Its node.
    """

    def __init__(
        self,
        folder: str | PathLike[str],
        contract: Contract,
        *,
        task: str = "",
        topics: Iterable[str] = (),
        context: Context | None = None,
        node_name: str = "episodes",
    ) -> None:
        self.folder = Path(folder)
        self.contract = contract
        self.task = task or contract.task
        self.current: Episode | None = None
        self.node = Node(node_name, context=context)
        self._context = context
        self._topics = [self.node.resolve_topic_name(name) for name in (*contract.topics, *topics)]
        self._recorder: Recorder | None = None
        self._turn = asyncio.Lock()
        self._failed = asyncio.Event()
        self._failure: BagWriteError | None = None
        self._watch: asyncio.Task[None] | None = None
        for name, act in (
            ("start", self.start),
            ("end", self.end),
            ("fail", self.fail),
            ("discard", self.discard),
            ("again", self.again),
        ):
            self.node.create_service(Trigger, f"~/{name}", answering(act))
        self.node.create_action_server(
            RecordEpisode,
            "~/record",
            self._execute,
            cancel_callback=lambda _: CancelResponse.ACCEPT,
            on_client_lost="cancel",
        )

    async def __aenter__(self) -> Self:
        """Create the folder, and get ready to record.

        Raises:
            EpisodeError: the folder cannot be used for episodes (a RuntimeError).
        """
        self._check_folder()
        async with AsyncExitStack() as stack:
            await stack.enter_async_context(self.node)
            self._tasks = await stack.enter_async_context(asyncio.TaskGroup())
            stack.push_async_callback(self._close)
            self._stack = stack.pop_all()
        return self

    async def __aexit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """Close the bag of an episode that has not ended; its outcome stays empty.

        Raises:
            BagWriteError: the disk was full or failed; what was written before is readable.
        """
        await self._stack.__aexit__(None, None, None)

    @asynccontextmanager
    async def record(self, task: str = "") -> AsyncIterator[Episode]:
        """Record an episode during the block; it counts as a failure if the block raises an error.

        Args:
            task: What is shown, in words; by default, the task of the recorder.

        Raises:
            EpisodeError: an episode is being recorded, or there is no task (a RuntimeError).
            BagWriteError: the disk was full or failed; what was written before is readable.
        """
        episode = await self.start(task)
        try:
            yield episode
        except BaseException:
            episode.outcome = episode.outcome or "failure"
            raise
        finally:
            if self.current is episode:
                await self._finish(episode.outcome or "success")
            else:  # another task ends it, and may still be closing its bag
                await episode._ended.wait()

    async def start(self, task: str = "") -> Episode:
        """Begin an episode.

        Raises:
            EpisodeError: an episode is being recorded, or there is no task (a RuntimeError).
            BagWriteError: its bag cannot be created.
        """
        task = task or self.task
        if not task:
            raise EpisodeError("there is no task; give one, such as task='pick the cube'")
        async with self._turn:
            if self.current is not None:
                raise EpisodeError(f"{self.current.path} is being recorded; end it first")
            path = self._next_path()
            recorder = Recorder(
                path,
                topics=self._topics,
                context=self._context,
                node_name=f"{self.node.get_name()}_recorder",
                use_sim_time=self.node.get_parameter("use_sim_time").value,
                custom_data={
                    TASK_KEY: task,
                    CONTRACT_KEY: json.dumps(self.contract.to_dict()),
                },
            )
            await recorder.__aenter__()
            self._recorder = recorder
            self._failed.clear()
            self._watch = self._tasks.create_task(self._wait_for_failure(recorder))
            self.current = Episode(path, task)
            self.node.get_logger().info(f"Recording {path}: {task}")
            return self.current

    async def end(self) -> Episode:
        """End the episode as a success.

        Raises:
            EpisodeError: none is being recorded (a RuntimeError).
            BagWriteError: the disk was full or failed; what was written before is readable.
        """
        return await self._finish("success")

    async def fail(self) -> Episode:
        """End the episode as a failure, which an export leaves out."""
        return await self._finish("failure")

    async def discard(self) -> Episode:
        """End the episode, and remove its bag."""
        return await self._finish("discarded")

    async def again(self) -> Episode:
        """Discard the episode, and begin another one with the same task."""
        return await self.start((await self.discard()).task)

    async def failed(self) -> None:
        """Wait until an episode can no longer be written because the disk is full or fails.

        The episode continues without what is sent from then on, until it is ended, as a failure, or
        discarded.

        Raises:
            BagWriteError: always, at that point.
        """
        await self._failed.wait()
        if self._failure is not None:
            raise self._failure

    # Internals

    async def _wait_for_failure(self, recorder: Recorder) -> None:
        try:
            await recorder.failed()
        except BagWriteError as error:
            self._failure = error
            self._failed.set()

    def _check_folder(self) -> None:
        """Create the folder.

        Raises:
            EpisodeError: it cannot be created or written to (a RuntimeError).
        """
        problem = "a file has its name" if self.folder.is_file() else ""
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            problem = problem or error.strerror or str(error)
        if not problem and not os.access(self.folder, os.W_OK | os.X_OK):
            problem = "it is not writable"
        if problem:
            raise EpisodeError(f"cannot use the folder {self.folder}: {problem}; give another one")

    def _next_path(self) -> Path:
        """Return the folder of the next episode."""
        there = self.folder.iterdir() if self.folder.is_dir() else ()
        numbers = [int(match[1]) for each in there if (match := NAME.fullmatch(each.name))]
        return self.folder / f"episode_{max(numbers, default=-1) + 1:04d}"

    async def _finish(self, outcome: str) -> Episode:
        """End the episode with an outcome, which is empty if nobody said how it ended."""
        async with self._turn:
            episode, recorder = self.current, self._recorder
            if episode is None or recorder is None:
                raise EpisodeError("no episode is being recorded; start one")
            if self._failed.is_set() and outcome == "success":
                outcome = "failure"  # its end is missing
            episode.outcome = "discarded" if episode.outcome == "discarded" else outcome
            if episode.outcome:
                recorder.annotate(OUTCOME_KEY, episode.outcome)
            self.current = self._recorder = None
            if self._watch is not None:
                self._watch.cancel()
            try:
                await recorder.__aexit__(None, None, None)
            except BagWriteError:
                if episode.outcome != "discarded":
                    raise
            finally:
                episode.stats = recorder.stats
                episode._ended.set()
            if episode.outcome == "discarded":
                await run_in_thread(shutil.rmtree, episode.path)
            self.node.get_logger().info(
                f"Ended {episode.path}: {episode.outcome or 'not ended'}, {episode.messages} "
                f"messages, {episode.lost} lost"
            )
            return episode

    async def _close(self) -> None:
        """Close the bag of an episode that has not ended."""
        if self.current is not None:
            await self._finish(self.current.outcome)

    async def _execute(
        self,
        handle: ServerGoalHandle[RecordEpisode.Goal, RecordEpisode.Result, RecordEpisode.Feedback],
    ) -> RecordEpisode.Result:
        """Record an episode for a goal; canceling it discards the episode."""
        goal = handle.request
        clock = self.node.get_clock()
        begun = clock.now().nanoseconds
        async with self.record(goal.task) as episode:
            try:
                while self.current is episode and not self._failed.is_set():
                    is_over = goal.max_sec and clock.now().nanoseconds - begun >= goal.max_sec * 1e9
                    if is_over:
                        break
                    handle.publish_feedback(self._feedback())
                    await clock.sleep(FEEDBACK_SEC)
            except asyncio.CancelledError:
                episode.discard()
                raise
        handle.succeed()
        return RecordEpisode.Result(
            path=str(episode.path), outcome=episode.outcome, messages=episode.messages
        )

    def _feedback(self) -> RecordEpisode.Feedback:
        """Return the progress of the episode."""
        stats = {} if self._recorder is None else self._recorder.stats
        return RecordEpisode.Feedback(
            messages=sum(each.recorded for each in stats.values()),
            lost=sum(each.lost_in_transport + each.lost_in_recorder for each in stats.values()),
        )

    @property
    def text(self) -> str:
        """The current state in one line."""
        if self.current is None:
            return "Not recording"
        told = self._feedback()
        lost = f", {told.lost} lost" if told.lost else ""
        return escaped(
            f"{self.current.path.name}: {self.current.task}: {told.messages} messages{lost}",
            one_line=True,
        )


def answering(
    act: Callable[[], Coroutine[Any, Any, Episode]],
) -> Callable[[Any, Any], Coroutine[Any, Any, Any]]:
    """Return the callback of a service that acts on an episode."""

    async def answer(_: Any, response: Any) -> Any:
        try:
            episode = await act()
        except (AionodeError, OSError) as error:
            response.success, response.message = False, str(error)
            return response
        response.success = True
        response.message = f"{episode.path}: {episode.outcome or 'recording'}"
        return response

    return answer
