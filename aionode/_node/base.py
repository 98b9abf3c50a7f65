"""The lifetime, identity and names of a node, and the entities it owns."""

from __future__ import annotations

import asyncio
import sys
from functools import partial, wraps
from typing import TYPE_CHECKING, Any, Self, TypeVar

from aionode import names
from aionode._node.end_record import EndRecord, NodeEnd, failure_text
from aionode._process.concurrency import to_the_end
from aionode.arguments import Arguments, Usage, parse_arguments
from aionode.clock import ROSClock
from aionode.endpoints._core.callback_runner import Callbacks
from aionode.endpoints._core.endpoint import Endpoint
from aionode.endpoints._core.entity import EndStage
from aionode.endpoints._core.node_tasks import OWNER, NodeTasks
from aionode.endpoints._core.shutdown import Shutdown
from aionode.engine.loop_affinity import in_loop_thread
from aionode.errors import EntityDestroyedError
from aionode.logging import get_logger

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from types import TracebackType

    from aionode.clock import Clock
    from aionode.endpoints._core.entity import Entity
    from aionode.engine.context import Context
    from aionode.engine.transport.base import Registration
    from aionode.graph import Graph
    from aionode.logging import RcutilsLogger

__all__ = ["NodeBase"]

EntityT = TypeVar("EntityT", bound="Entity")


class NodeBase:
    """The part of `aionode.Node` that starts, stops, and owns entities.

    `Node` is one class whose methods are spread over base classes, one for each subject:
    `NodeGraphQueries` and `NodeParameters` extend this one, `NodeEndpoints` that with parameters.
    """

    def __init_subclass__(cls, **options: Any) -> None:
        """Have a node whose constructor raises leave its context."""
        super().__init_subclass__(**options)
        if "__init__" in vars(cls):
            cls.__init__ = destroying_on_error(cls.__init__)  # type: ignore[method-assign]

    def __init__(
        self,
        node_name: str,
        namespace: str,
        context: Context,
        cli_args: Sequence[str] | None,
        *,
        use_global_arguments: bool,
        callback_budget_ms: float,
    ) -> None:
        self.context = context
        # The node's own arguments take precedence over the shared ones. Of remap rules the first
        # match wins, so its own come first; of parameters the last value, in `NodeParameters`.
        own = parse_arguments(cli_args or ())
        own.refuse_unknown()
        shared = self.context.arguments if use_global_arguments else Arguments()
        self._own_arguments = own
        self._shared_arguments = shared
        self._uses_global_arguments = use_global_arguments
        self._rules = own.remap_rules + shared.remap_rules
        self._usages = [
            Usage(own),
            self.context._current_usage if use_global_arguments else Usage(shared),
        ]
        for usage in self._usages:
            usage.note_node(node_name)
        node_name = names.remap_node_name(self._rules, node_name)
        namespace = names.remap_namespace(self._rules, node_name, namespace)
        full_name = names.fully_qualified_name(namespace, node_name)
        self._constructed = False  # until the built-in services exist; then come the program's own
        self._warned_about: set[str] = set()  # kinds of timers' third argument
        self._entities: dict[Entity, None] = {}  # in order of creation; destroyed ones leave it
        self._tasks: asyncio.TaskGroup | None = None  # of the entities, once the node has started
        self._node_tasks = NodeTasks(self._end_leases)
        self._node_tasks.enter_constructor()
        self._running = False
        self._destroyed = asyncio.Event()
        self._end_record = EndRecord(f"node {full_name}")
        self._clock = ROSClock(time_base=self.context.time_base)
        self._clock._end_of_wait = self._node_tasks.end_of_wait
        self._logger = get_logger(
            names.logger_name(namespace, node_name), now_ns=self.context.time_base.system_ns
        )
        self._callbacks = Callbacks(
            node=full_name,
            logger=self._logger,
            budget_ns=round(callback_budget_ms * 1e6) if context.seed is None else sys.maxsize,
            slice_ns=context.time_base.slice_ns,
        )
        self._affinity = context._affinity
        self._node_shutdown = Shutdown(self._entities, self._callbacks, self._leave)
        self._stop_rosout: Callable[[], None] | None = None
        self._registrations: list[Registration] = []  # of the node itself, one for each transport
        self._info = self.context._describe_node(
            node_name, namespace, enclave=own.enclave or shared.enclave or "/"
        )

    def __repr__(self) -> str:
        state = "destroyed" if self.destroyed else "running" if self._running else "not running"
        return f"<Node {self.get_fully_qualified_name()} {state} entities={len(self._entities)}>"

    # Lifetime

    async def __aenter__(self) -> Self:
        """Start the node: open its context and begin to call callbacks.

        Raises:
            RuntimeError: the node is already running, or was destroyed.
            TransportError: the context cannot connect.
        """
        if self.destroyed:
            raise EntityDestroyedError(f"node {self.get_fully_qualified_name()}", "run")
        if self._running:
            raise RuntimeError(f"node {self.get_fully_qualified_name()} is already running")
        self._running = True
        try:
            await self.context._acquire()
        except BaseException:
            self._running = False
            raise
        self._end_record.begin()
        self._node_tasks.enter_body()
        self._tasks = await asyncio.TaskGroup().__aenter__()
        for entity in list(self._entities):
            self._start_entity(entity, self._tasks)
        for usage in self._usages:
            usage.begin(self.context.time_base, lambda: not self.destroyed, self._logger.warning)
        return self

    async def __aexit__(
        self,
        exc_type: type[BaseException] | None,
        exc: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """Destroy the node and wait until its callbacks have ended; see `destroy_node`.

        An exception from the body of ``async with`` propagates unchanged, unless callbacks failed
        as well.

        Raises:
            ExceptionGroup: the exceptions of callbacks, together with that of the body, if any.
        """
        tasks = self._tasks
        assert tasks is not None  # noqa: S101  # set by __aenter__
        self._node_tasks.note_error(exc)
        with self._end_record.recorded(exc):
            self.destroy_node()
            try:
                await to_the_end(self._node_shutdown.wait())
            except asyncio.CancelledError as cancelled:
                if exc is None:
                    exc_type, exc, traceback = type(cancelled), cancelled, cancelled.__traceback__
            raising = exc
            try:
                await tasks.__aexit__(exc_type, exc, traceback)
            except BaseExceptionGroup as group:
                if group.exceptions != (exc,):
                    raising = group
                    raise
            finally:
                self._running = False
                await to_the_end(self.context._release(), raising)

    async def run(self) -> None:
        """Run until `destroy_node` is called, which any callback may do.

        Cancelling destroys the node. In a task of its own, ``asyncio.create_task(node.run())``, it
        also logs one ERROR if the node fails, as nobody may await that task.

        Raises:
            ExceptionGroup: the exceptions of callbacks.
            RuntimeError: the node is already running, or was destroyed.
            TransportError: the context cannot connect.
        """
        try:
            async with self:
                await self.until_destroyed()
        except Exception as error:
            self._tell_failure(error)
            raise

    def _tell_failure(self, error: Exception) -> None:
        """Log why the node failed, if a task runs nothing but `run`.

        Such a task may be awaited late or never, and asyncio tells of its exception only when it is
        collected.
        """
        task = asyncio.current_task()
        coroutine = None if task is None else task.get_coro()
        if getattr(coroutine, "cr_code", None) is NodeBase.run.__code__:
            self._logger.error(
                f"the node failed and has ended: {failure_text(error)}. "
                "To get the exception, await the task of run()"
            )

    async def until_destroyed(self) -> None:
        """Wait until `destroy_node` is called, as `run` does inside its ``async with``.

        Cancelling has no effect on the node.
        """
        await self._destroyed.wait()

    async def ended(self) -> NodeEnd:
        """Wait until the node has ended, and return how and why.

        A node has ended when its callbacks have ended and it has released its context: after
        ``async with`` or `run`, or at once if it was destroyed without ever running. Any number of
        tasks may wait, and later calls return the same result at once. The node's own exception is
        returned, never raised. Cancelling has no effect on the node.

        Raises:
            RuntimeError: it is awaited by the task that runs the node, which would wait for itself.
        """
        return await self._end_record.wait()

    @property
    def destroyed(self) -> bool:
        """Whether `destroy_node` was called."""
        return self._destroyed.is_set()

    @property
    def is_running(self) -> bool:
        """Whether the node calls callbacks: `run` or ``async with`` has begun and not ended."""
        return self._running

    def destroy_node(self) -> None:
        """End the node. Calling it again has no effect.

        Subscriptions, services, timers and action servers are destroyed at once, and their
        callbacks cancelled. Publishers, clients and the clock keep working until these callbacks
        have ended, so that a callback can stop a robot in ``finally``; then they are destroyed too,
        and the node leaves the graph. For a node that is not running, all of this has happened when
        the call returns.

        `run` and ``async with`` wait for it, up to 5 s for callbacks and 1 s for action servers to
        confirm the cancelling of goals, and send what was published. The log names callbacks that
        take long.

        It may be called in any thread. Outside the thread of the node's event loop it returns
        before the loop has done the work.
        """
        if self.destroyed:
            return
        if self._affinity.is_other_thread():
            self._affinity.call(self.destroy_node)
            return
        self._destroyed.set()
        self._end_leases()  # at once: callbacks may take seconds to unwind
        self._node_shutdown.begin()

    def _end_leases(self) -> None:
        """Send the stops of the leases that the publishers of this node are held by."""
        node = f"node {self.get_fully_qualified_name()}"
        for entity in self._entities:
            entity._end_lease(lambda: EntityDestroyedError(node))

    def _join_context(self) -> None:
        """Add the node to its context, and announce it on every transport.

        Raises:
            EntityDestroyedError: the context was shut down.
            ForkedProcessError: the context belongs to the parent process.
        """
        self.context._add_node(self)
        self._registrations = self.context._register(
            lambda transport: transport.create_node(self._info)
        )
        self.context.graph.add_node(self._info)

    def _leave(self) -> None:
        """Release what belongs to the node itself, after all entities are destroyed."""
        if self._stop_rosout is not None:
            self._stop_rosout()
        self._clock.destroy()
        for registration in self._registrations:
            registration.close()
        self.context.graph.remove_node(self._info)
        self.context._remove_node(self)
        if not self._running:
            self._end_record.note(NodeEnd("destroyed"))

    def _abandon(self) -> None:
        """Mark the node destroyed without closing anything, as the parent process still uses it.

        Called by the context in a forked child.
        """
        self._destroyed = asyncio.Event()  # a new one: the parent's tasks wait for the old one
        self._destroyed.set()
        self._tasks = None
        for entity in self._entities:
            entity.destroyed = True

    def _call_in_loop(self, action: Callable[[], None]) -> None:
        """Call `action` in the thread of the node's loop: at once if this is it, or none runs."""
        self._affinity.call(action)

    # Identity

    def get_name(self) -> str:
        """Return the name without namespace."""
        return self._info.name

    def get_namespace(self) -> str:
        """Return the namespace, which begins with a slash."""
        return self._info.namespace

    def get_fully_qualified_name(self) -> str:
        """Return the namespace and name, joined by a slash."""
        return self._info.fully_qualified_name

    def get_logger(self) -> RcutilsLogger:
        """Return the node's logger, which is named after the node."""
        return self._logger

    def get_clock(self) -> Clock:
        """Return the node's clock: ROS time, which is system time unless `use_sim_time` is set."""
        return self._clock

    @property
    def graph(self) -> Graph:
        """The nodes and endpoints known now, and ``await node.graph.changed()``."""
        return self.context.graph

    # Names

    def resolve_topic_name(self, topic: str, *, only_expand: bool = False) -> str:
        """Return the full name of a topic of this node, remapped unless `only_expand`.

        Raises:
            InvalidTopicNameException: `topic` is invalid (a ValueError).
        """
        return self._resolve(topic, only_expand=only_expand)

    def resolve_service_name(self, service: str, *, only_expand: bool = False) -> str:
        """Return the full name of a service of this node, remapped unless `only_expand`.

        Raises:
            InvalidServiceNameException: `service` is invalid (a ValueError).
        """
        return self._resolve(service, only_expand=only_expand, is_service=True)

    def _resolve(self, name: str, *, only_expand: bool = False, is_service: bool = False) -> str:
        resolve = partial(names.resolve, is_service=is_service)
        if only_expand:
            return resolve(name, self.get_name(), self.get_namespace())
        for usage in self._usages:
            if not usage.is_over:
                expanded = resolve(name, self.get_name(), self.get_namespace())
                usage.note_name(
                    expanded, self.get_name(), self.get_namespace(), is_service=is_service
                )
        return resolve(name, self.get_name(), self.get_namespace(), self._rules)

    # Entities

    @in_loop_thread
    def _add_entity(self, entity: EntityT) -> EntityT:
        """Own `entity`: enter it into the graph, start it if the node runs, destroy it at the end.

        An action server or client, made of other entities, adds itself here.
        """
        self._entities[entity] = None
        entity._adopt(self._forget_entity, self._affinity, self._node_tasks)
        if isinstance(entity, Endpoint):
            entity._enter_graph()
        if self._tasks is not None:
            self._start_entity(entity, self._tasks)
        return entity

    def _start_entity(self, entity: Entity, tasks: asyncio.TaskGroup) -> None:
        """Start `entity`; the end of the node waits for those that run callbacks."""
        task = entity._start(tasks)
        if task is not None and entity._stage is EndStage.CALLBACKS:
            self._node_shutdown.watch(task)

    def _forget_entity(self, entity: Entity) -> None:
        self._entities.pop(entity, None)

    def _entities_of(self, kind: type[EntityT]) -> list[EntityT]:
        return [entity for entity in self._entities if isinstance(entity, kind)]

    def _expect_at_end(self, answer: asyncio.Future[Any]) -> None:
        """Have the end of the node wait for `answer`, up to 1 s, before it destroys clients.

        Action clients use it: their requests to cancel goals have to reach the servers.
        """
        self._node_shutdown.expect(answer)

    def _refuse_if_destroyed(self, wanted: str) -> None:
        if self.destroyed:
            raise EntityDestroyedError(
                f"node {self.get_fully_qualified_name()}", f"create {wanted}"
            )


def destroying_on_error(constructor: Callable[..., None]) -> Callable[..., None]:
    """Return a constructor that destroys the node if it raises.

    Otherwise a node that the program never got would stay in its context, and the next one that a
    supervisor makes would join it there.
    """

    @wraps(constructor)
    def construct(self: NodeBase, *args: Any, **options: Any) -> None:
        owner = OWNER.get()
        try:
            constructor(self, *args, **options)
        except BaseException:
            if hasattr(self, "_info"):  # else the name was rejected: there is nothing to destroy
                self.destroy_node()
            raise
        finally:
            if type(self).__init__ is construct:  # else the one of a subclass goes on
                OWNER.set(owner)

    return construct
