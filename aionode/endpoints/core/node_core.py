"""The core of a node: its names and arguments, tasks, entities, and end."""

from __future__ import annotations

import asyncio
import sys
from functools import partial, wraps
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

from aionode import names
from aionode._process.concurrency import to_the_end
from aionode.arguments import Arguments, Usage, parse_arguments
from aionode.clock import ROSClock
from aionode.endpoints.core.callback_runner import Callbacks
from aionode.endpoints.core.end_record import EndRecord, NodeEnd
from aionode.endpoints.core.endpoint import Endpoint
from aionode.endpoints.core.entity import EndStage
from aionode.endpoints.core.node_tasks import NodeTasks
from aionode.endpoints.core.shutdown import Shutdown
from aionode.engine.membership import (
    acquire,
    affinity_of,
    describe_node,
    join,
    release,
    usage_of,
)
from aionode.errors import EntityDestroyedError
from aionode.logging import get_logger
from aionode.parameter import Parameter, ParameterStore

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from types import TracebackType

    from aionode.endpoints.core.entity import Entity
    from aionode.endpoints.publisher import Publisher
    from aionode.endpoints.subscription import Subscription
    from aionode.engine.context import Context, ContextNode
    from aionode.engine.observation import NodeReport

__all__ = ["HasCore", "NodeCore", "core_of", "in_loop_thread", "in_thread_of_node", "is_named"]

EntityT = TypeVar("EntityT", bound="Entity")
TopicT = TypeVar("TopicT", "Publisher[Any]", "Subscription[Any]")
MethodT = TypeVar("MethodT", bound="Callable[..., Any]")


class HasCore(Protocol):
    """A node; its core is the only attribute that aionode keeps on it.

    A user's subclass may use any other name, even a mangled one, as this one belongs to no class.
    """

    _aionode__core: NodeCore


def core_of(node: HasCore) -> NodeCore:
    """Return the core of a node."""
    return node._aionode__core


def is_named(node: object) -> bool:
    """Return whether the constructor of a node got as far as naming it and creating its core."""
    return hasattr(node, "_aionode__core")


class NodeClock(ROSClock):
    """The clock of a node; the node's end ends sleeps like its other waits."""

    _node_tasks: NodeTasks

    def _end_of_wait(self) -> BaseException:
        return self._node_tasks.end_of_wait(repr(self))


class NodeCore:
    """A node's state, start and end, which the methods of `aionode.Node` use.

    Args:
        node: The node, whose `destroy_node` a subclass may have replaced.
        node_name: Its name, before it is remapped.
        namespace: Its namespace, before it is remapped.
        context: The context that it joins.
        cli_args: Arguments for this node only.
        use_global_arguments: Whether those of the context apply to it too.
        callback_budget_ms: How long a callback may block the event loop.
        parameter_overrides: Values that take precedence over those of arguments.
        allow_undeclared_parameters: Whether parameters can be set without being declared.

    Attributes:
        context: The context.
        info: The node's entry in the graph.
        own_arguments: The arguments in `cli_args`.
        shared_arguments: The context's arguments, or none.
        uses_global_arguments: Whether the context's arguments apply.
        usages: Which of these arguments had an effect.
        parameters: The parameters.
        clock: The clock of the node.
        logger: The logger of the node.
        callbacks: How the node runs callbacks.
        affinity: The event loop that the node runs in.
        tasks: The node's own tasks.
        shutdown: Ends the node in stages.
        record: How and why the node ended.
        entities: What the node owns, in order of creation; destroyed entities are removed.
        running: Whether the node calls callbacks.
        ending: Set once the node is destroyed.
        constructed: Whether the built-in services exist, so that further entities are the
            program's.
        warned_about: Kinds of third arguments of timers that were already logged.
        at_end: Called when all entities are destroyed, newest first.
    """

    def __init__(
        self,
        node: ContextNode,
        node_name: str,
        namespace: str,
        context: Context,
        cli_args: Sequence[str] | None,
        *,
        use_global_arguments: bool,
        callback_budget_ms: float,
        parameter_overrides: Sequence[Parameter],
        allow_undeclared_parameters: bool,
    ) -> None:
        self._node = node
        self.context = context
        # The node's own arguments take precedence over the shared ones: the first matching remap
        # rule wins, and the last value of a parameter.
        own = parse_arguments(cli_args or ())
        own.refuse_unknown()
        shared = context.arguments if use_global_arguments else Arguments()
        self.own_arguments = own
        self.shared_arguments = shared
        self.uses_global_arguments = use_global_arguments
        self._rules = own.remap_rules + shared.remap_rules
        self.usages = [
            Usage(own),
            usage_of(context) if use_global_arguments else Usage(shared),
        ]
        for usage in self.usages:
            usage.note_node(node_name)
        node_name = names.remap_node_name(self._rules, node_name)
        namespace = names.remap_namespace(self._rules, node_name, namespace)
        full_name = names.fully_qualified_name(namespace, node_name)
        self.constructed = False
        self.warned_about: set[str] = set()
        self.entities: dict[Entity, None] = {}
        self.tasks = NodeTasks(self.end_leases)
        self.tasks.enter_constructor()
        self._group: asyncio.TaskGroup | None = None  # for the entities, once the node has started
        self.running = False
        self.ending = asyncio.Event()
        self.record = EndRecord(f"node {full_name}")
        self.clock = NodeClock(time_base=context.time_base)
        self.clock._node_tasks = self.tasks
        self.logger = get_logger(
            names.logger_name(namespace, node_name), now_ns=context.time_base.system_ns
        )
        self.callbacks = Callbacks(
            node=full_name,
            logger=self.logger,
            budget_ns=round(callback_budget_ms * 1e6) if context.seed is None else sys.maxsize,
            slice_ns=context.time_base.slice_ns,
        )
        self.affinity = affinity_of(context)
        self.shutdown = Shutdown(self.entities, self.callbacks, self._leave)
        self.at_end: list[Callable[[], None]] = []
        self.info = describe_node(
            context, node_name, namespace, enclave=own.enclave or shared.enclave or "/"
        )
        self.parameters = ParameterStore(
            full_name,
            overrides=[  # the last value of a name wins
                *parameters_from(shared.parameters_for(full_name)),
                *parameters_from(own.parameters_for(full_name)),
                *parameter_overrides,
            ],
            allow_undeclared=allow_undeclared_parameters,
        )

    @property
    def subject(self) -> str:
        """The node, for errors."""
        return f"node {self.info.fully_qualified_name}"

    # Lifetime

    def join(self) -> None:
        """Add the node to its context, and announce it on every transport.

        Raises:
            EntityDestroyedError: the context was shut down.
            ForkedProcessError: the context belongs to the parent process.
        """
        self.at_end.append(join(self.context, self._node, self.info, self._abandon))
        self.at_end.append(self.context.add_reporter(self, self._report))

    def _report(self) -> NodeReport:
        """Return the report of the node for tools."""
        # Nobody may ever ask.
        from aionode.endpoints.core.reports import entity_reports
        from aionode.engine.observation import NodeReport

        name, unfinished = self.info.fully_qualified_name, len(self.callbacks.waiting)
        return NodeReport(name, self.running, unfinished, entity_reports(self.entities))

    async def start(self) -> None:
        """Open the context and start calling callbacks.

        Raises:
            RuntimeError: the node is already running, or was destroyed.
            TransportError: the context cannot connect.
        """
        if self.ending.is_set():
            raise EntityDestroyedError(self.subject, "run")
        if self.running:
            raise RuntimeError(f"{self.subject} is already running")
        self.running = True
        try:
            await acquire(self.context)
        except BaseException:
            self.running = False
            raise
        self.record.begin()
        self.tasks.enter_body()
        self._group = await asyncio.TaskGroup().__aenter__()
        for entity in list(self.entities):
            self._start_entity(entity, self._group)
        for usage in self.usages:
            usage.begin(
                self.context.time_base, lambda: not self.ending.is_set(), self.logger.warning
            )

    async def finish(
        self,
        exc_type: type[BaseException] | None,
        exc: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """Destroy the node and wait until its callbacks have ended.

        Raises:
            ExceptionGroup: the exceptions of callbacks, together with that of the body, if any.
        """
        group = self._group
        assert group is not None  # noqa: S101  # set by `start`
        self.tasks.note_error(exc)
        with self.record.recorded(exc):
            self._node.destroy_node()
            try:
                await to_the_end(self.shutdown.wait())
            except asyncio.CancelledError as cancelled:
                if exc is None:
                    exc_type, exc, traceback = type(cancelled), cancelled, cancelled.__traceback__
            raising = exc
            try:
                await group.__aexit__(exc_type, exc, traceback)
            except BaseExceptionGroup as errors:
                if errors.exceptions != (exc,):
                    raising = errors
                    raise
            finally:
                self.running = False
                await to_the_end(release(self.context, asyncio.current_task()), raising)

    def destroy(self) -> None:
        """End the node: at once if it is not running; otherwise `finish` waits for the end."""
        if self.ending.is_set():
            return
        if self.affinity.is_other_thread():
            self.affinity.call(self._node.destroy_node)
            return
        self.ending.set()
        self.end_leases()  # first, as callbacks may take seconds to unwind
        self.shutdown.begin()

    def end_leases(self) -> None:
        """Send the stops of open leases on this node's publishers."""
        for entity in self.entities:
            entity._end_lease(lambda: EntityDestroyedError(self.subject))

    def _leave(self) -> None:
        """Release what belongs to the node itself, after all entities are destroyed."""
        for action in reversed(self.at_end):
            action()
        self.clock.destroy()
        if not self.running:
            self.record.note(NodeEnd("destroyed"))

    def _abandon(self) -> None:
        """Mark the node destroyed without closing anything that the parent process still uses.

        Called by the context in a forked child.
        """
        self.ending = asyncio.Event()  # a new one: the parent's tasks wait for the old one
        self.ending.set()
        self._group = None
        for entity in self.entities:
            entity.destroyed = True

    def refuse_if_destroyed(self, wanted: str) -> None:
        """Raise EntityDestroyedError if the node is destroyed and `wanted` cannot be created."""
        if self.ending.is_set():
            raise EntityDestroyedError(self.subject, f"create {wanted}")

    # Names

    def resolve(self, name: str, *, only_expand: bool = False, is_service: bool = False) -> str:
        """Return the full name of a topic or service, remapped unless `only_expand`."""
        own, namespace = self.info.name, self.info.namespace
        resolve = partial(names.resolve, is_service=is_service)
        if only_expand:
            return resolve(name, own, namespace)
        for usage in self.usages:
            if not usage.is_over:
                expanded = resolve(name, own, namespace)
                usage.note_name(expanded, own, namespace, is_service=is_service)
        return resolve(name, own, namespace, self._rules)

    # Entities

    def add(self, entity: EntityT) -> EntityT:
        """Own `entity`: add it to the graph, start it if the node runs, destroy it at the end.

        Action servers and clients, which are composed of other entities, add themselves here.
        """
        if self.affinity.is_other_thread():
            return self.affinity.wait_for(partial(self.add, entity))
        self.entities[entity] = None
        entity._adopt(self._forget, self.affinity, self.tasks)
        if isinstance(entity, Endpoint):
            entity._enter_graph()
        if self._group is not None:
            self._start_entity(entity, self._group)
        return entity

    def add_with_events(self, endpoint: TopicT) -> TopicT:
        """Own a publisher or subscription, and the task that calls its event callbacks."""
        self.add(endpoint)
        monitor = endpoint._monitor
        if monitor is not None and monitor.handler is not None:
            self.add(monitor.handler)
        return endpoint

    def _start_entity(self, entity: Entity, group: asyncio.TaskGroup) -> None:
        """Start `entity`; the shutdown of the node waits for those that run callbacks."""
        task = entity._start(group)
        if task is not None and entity._stage is EndStage.CALLBACKS:
            self.shutdown.watch(task)

    def _forget(self, entity: Entity) -> None:
        self.entities.pop(entity, None)

    def entities_of(self, kind: type[EntityT]) -> list[EntityT]:
        """Return the entities of one class."""
        return [entity for entity in self.entities if isinstance(entity, kind)]

    def destroy_entity(self, entity: Entity) -> bool:
        """Destroy `entity`; return whether it belonged to this node."""
        if entity not in self.entities:
            return False
        entity.destroy()
        return True


def parameters_from(values: Mapping[str, object]) -> list[Parameter]:
    """Convert plain values to parameters."""
    return [Parameter(name, value=value) for name, value in values.items()]


# The thread of a node


def in_loop_thread(method: MethodT) -> MethodT:
    """Make a method of a node run in the thread of the node's loop while its caller waits.

    Entities are created there, since the graph, the transports and Zenoh's session are not locked.
    """

    @wraps(method)
    def call(self: HasCore, *args: Any, **options: Any) -> Any:
        affinity = core_of(self).affinity
        if affinity.is_other_thread():
            return affinity.wait_for(partial(method, self, *args, **options))
        return method(self, *args, **options)

    return call  # type: ignore[return-value]  # it has the same signature


def in_thread_of_node(constructor: MethodT) -> MethodT:
    """Make a constructor whose first argument is a node run in the thread of the node's loop."""

    @wraps(constructor)
    def construct(self: Any, node: HasCore, *args: Any, **options: Any) -> None:
        affinity = core_of(node).affinity
        if affinity.is_other_thread():
            affinity.wait_for(partial(constructor, self, node, *args, **options))
        else:
            constructor(self, node, *args, **options)

    return construct  # type: ignore[return-value]  # it has the same signature
