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
        self._Node__own_arguments = own
        self._Node__shared_arguments = shared
        self._Node__uses_global_arguments = use_global_arguments
        self._Node__rules = own.remap_rules + shared.remap_rules
        self._Node__usages = [
            Usage(own),
            self.context._current_usage if use_global_arguments else Usage(shared),
        ]
        for usage in self._Node__usages:
            usage.note_node(node_name)
        node_name = names.remap_node_name(self._Node__rules, node_name)
        namespace = names.remap_namespace(self._Node__rules, node_name, namespace)
        full_name = names.fully_qualified_name(namespace, node_name)
        self._Node__constructed = (
            False  # until the built-in services exist; then come the program's own
        )
        self._Node__warned_about: set[str] = set()  # kinds of timers' third argument
        self._Node__entities: dict[
            Entity, None
        ] = {}  # in order of creation; destroyed ones leave it
        self._Node__tasks: asyncio.TaskGroup | None = (
            None  # of the entities, once the node has started
        )
        self._Node__node_tasks = NodeTasks(self._Node__end_leases)
        self._Node__node_tasks.enter_constructor()
        self._Node__running = False
        self._Node__destroyed = asyncio.Event()
        self._Node__end_record = EndRecord(f"node {full_name}")
        self._Node__clock = ROSClock(time_base=self.context.time_base)
        self._Node__clock._end_of_wait = self._Node__node_tasks.end_of_wait
        self._Node__logger = get_logger(
            names.logger_name(namespace, node_name), now_ns=self.context.time_base.system_ns
        )
        self._Node__callbacks = Callbacks(
            node=full_name,
            logger=self._Node__logger,
            budget_ns=round(callback_budget_ms * 1e6) if context.seed is None else sys.maxsize,
            slice_ns=context.time_base.slice_ns,
        )
        self._Node__affinity = context._affinity
        self._Node__node_shutdown = Shutdown(
            self._Node__entities, self._Node__callbacks, self._Node__leave
        )
        self._Node__stop_rosout: Callable[[], None] | None = None
        self._Node__registrations: list[
            Registration
        ] = []  # of the node itself, one for each transport
        self._Node__info = self.context._describe_node(
            node_name, namespace, enclave=own.enclave or shared.enclave or "/"
        )

    def __repr__(self) -> str:
        state = (
            "destroyed" if self.destroyed else "running" if self._Node__running else "not running"
        )
        return (
            f"<Node {self.get_fully_qualified_name()} {state} entities={len(self._Node__entities)}>"
        )

    # Lifetime

    async def __aenter__(self) -> Self:
        """Start the node: open its context and begin to call callbacks.

        Raises:
            RuntimeError: the node is already running, or was destroyed.
            TransportError: the context cannot connect.
        """
        if self.destroyed:
            raise EntityDestroyedError(f"node {self.get_fully_qualified_name()}", "run")
        if self._Node__running:
            raise RuntimeError(f"node {self.get_fully_qualified_name()} is already running")
        self._Node__running = True
        try:
            await self.context._acquire()
        except BaseException:
            self._Node__running = False
            raise
        self._Node__end_record.begin()
        self._Node__node_tasks.enter_body()
        self._Node__tasks = await asyncio.TaskGroup().__aenter__()
        for entity in list(self._Node__entities):
            self._Node__start_entity(entity, self._Node__tasks)
        for usage in self._Node__usages:
            usage.begin(
                self.context.time_base, lambda: not self.destroyed, self._Node__logger.warning
            )
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
        tasks = self._Node__tasks
        assert tasks is not None  # noqa: S101  # set by __aenter__
        self._Node__node_tasks.note_error(exc)
        with self._Node__end_record.recorded(exc):
            self.destroy_node()
            try:
                await to_the_end(self._Node__node_shutdown.wait())
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
                self._Node__running = False
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
            self._Node__tell_failure(error)
            raise

    def _Node__tell_failure(self, error: Exception) -> None:
        """Log why the node failed, if a task runs nothing but `run`.

        Such a task may be awaited late or never, and asyncio tells of its exception only when it is
        collected.
        """
        task = asyncio.current_task()
        coroutine = None if task is None else task.get_coro()
        if getattr(coroutine, "cr_code", None) is NodeBase.run.__code__:
            self._Node__logger.error(
                f"the node failed and has ended: {failure_text(error)}. "
                "To get the exception, await the task of run()"
            )

    async def until_destroyed(self) -> None:
        """Wait until `destroy_node` is called, as `run` does inside its ``async with``.

        Cancelling has no effect on the node.
        """
        await self._Node__destroyed.wait()

    async def ended(self) -> NodeEnd:
        """Wait until the node has ended, and return how and why.

        A node has ended when its callbacks have ended and it has released its context: after
        ``async with`` or `run`, or at once if it was destroyed without ever running. Any number of
        tasks may wait, and later calls return the same result at once. The node's own exception is
        returned, never raised. Cancelling has no effect on the node.

        Raises:
            RuntimeError: it is awaited by the task that runs the node, which would wait for itself.
        """
        return await self._Node__end_record.wait()

    @property
    def destroyed(self) -> bool:
        """Whether `destroy_node` was called."""
        return self._Node__destroyed.is_set()

    @property
    def is_running(self) -> bool:
        """Whether the node calls callbacks: `run` or ``async with`` has begun and not ended."""
        return self._Node__running

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
        if self._Node__affinity.is_other_thread():
            self._Node__affinity.call(self.destroy_node)
            return
        self._Node__destroyed.set()
        self._Node__end_leases()  # at once: callbacks may take seconds to unwind
        self._Node__node_shutdown.begin()

    def _Node__end_leases(self) -> None:
        """Send the stops of the leases that the publishers of this node are held by."""
        node = f"node {self.get_fully_qualified_name()}"
        for entity in self._Node__entities:
            entity._end_lease(lambda: EntityDestroyedError(node))

    def _Node__join_context(self) -> None:
        """Add the node to its context, and announce it on every transport.

        Raises:
            EntityDestroyedError: the context was shut down.
            ForkedProcessError: the context belongs to the parent process.
        """
        self.context._add_node(self)
        self._Node__registrations = self.context._register(
            lambda transport: transport.create_node(self._Node__info)
        )
        self.context.graph.add_node(self._Node__info)

    def _Node__leave(self) -> None:
        """Release what belongs to the node itself, after all entities are destroyed."""
        if self._Node__stop_rosout is not None:
            self._Node__stop_rosout()
        self._Node__clock.destroy()
        for registration in self._Node__registrations:
            registration.close()
        self.context.graph.remove_node(self._Node__info)
        self.context._remove_node(self)
        if not self._Node__running:
            self._Node__end_record.note(NodeEnd("destroyed"))

    def _Node__abandon(self) -> None:
        """Mark the node destroyed without closing anything, as the parent process still uses it.

        Called by the context in a forked child.
        """
        self._Node__destroyed = (
            asyncio.Event()
        )  # a new one: the parent's tasks wait for the old one
        self._Node__destroyed.set()
        self._Node__tasks = None
        for entity in self._Node__entities:
            entity.destroyed = True

    def _Node__call_in_loop(self, action: Callable[[], None]) -> None:
        """Call `action` in the thread of the node's loop: at once if this is it, or none runs."""
        self._Node__affinity.call(action)

    # Identity

    def get_name(self) -> str:
        """Return the name without namespace."""
        return self._Node__info.name

    def get_namespace(self) -> str:
        """Return the namespace, which begins with a slash."""
        return self._Node__info.namespace

    def get_fully_qualified_name(self) -> str:
        """Return the namespace and name, joined by a slash."""
        return self._Node__info.fully_qualified_name

    def get_logger(self) -> RcutilsLogger:
        """Return the node's logger, which is named after the node."""
        return self._Node__logger

    def get_clock(self) -> Clock:
        """Return the node's clock: ROS time, which is system time unless `use_sim_time` is set."""
        return self._Node__clock

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
        return self._Node__resolve(topic, only_expand=only_expand)

    def resolve_service_name(self, service: str, *, only_expand: bool = False) -> str:
        """Return the full name of a service of this node, remapped unless `only_expand`.

        Raises:
            InvalidServiceNameException: `service` is invalid (a ValueError).
        """
        return self._Node__resolve(service, only_expand=only_expand, is_service=True)

    def _Node__resolve(
        self, name: str, *, only_expand: bool = False, is_service: bool = False
    ) -> str:
        resolve = partial(names.resolve, is_service=is_service)
        if only_expand:
            return resolve(name, self.get_name(), self.get_namespace())
        for usage in self._Node__usages:
            if not usage.is_over:
                expanded = resolve(name, self.get_name(), self.get_namespace())
                usage.note_name(
                    expanded, self.get_name(), self.get_namespace(), is_service=is_service
                )
        return resolve(name, self.get_name(), self.get_namespace(), self._Node__rules)

    # Entities

    @in_loop_thread
    def _Node__add_entity(self, entity: EntityT) -> EntityT:
        """Own `entity`: enter it into the graph, start it if the node runs, destroy it at the end.

        An action server or client, made of other entities, adds itself here.
        """
        self._Node__entities[entity] = None
        entity._adopt(self._Node__forget_entity, self._Node__affinity, self._Node__node_tasks)
        if isinstance(entity, Endpoint):
            entity._enter_graph()
        if self._Node__tasks is not None:
            self._Node__start_entity(entity, self._Node__tasks)
        return entity

    def _Node__start_entity(self, entity: Entity, tasks: asyncio.TaskGroup) -> None:
        """Start `entity`; the end of the node waits for those that run callbacks."""
        task = entity._start(tasks)
        if task is not None and entity._stage is EndStage.CALLBACKS:
            self._Node__node_shutdown.watch(task)

    def _Node__forget_entity(self, entity: Entity) -> None:
        self._Node__entities.pop(entity, None)

    def _Node__entities_of(self, kind: type[EntityT]) -> list[EntityT]:
        return [entity for entity in self._Node__entities if isinstance(entity, kind)]

    def _Node__expect_at_end(self, answer: asyncio.Future[Any]) -> None:
        """Have the end of the node wait for `answer`, up to 1 s, before it destroys clients.

        Action clients use it: their requests to cancel goals have to reach the servers.
        """
        self._Node__node_shutdown.expect(answer)

    def _Node__refuse_if_destroyed(self, wanted: str) -> None:
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
            if hasattr(
                self, "_Node__info"
            ):  # else the name was rejected: there is nothing to destroy
                self.destroy_node()
            raise
        finally:
            if type(self).__init__ is construct:  # else the one of a subclass goes on
                OWNER.set(owner)

    return construct
