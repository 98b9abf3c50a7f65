"""The handle of a node: its names, its arguments, and its view of the graph."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any, TypeVar

from aionode import errors, names
from aionode.arguments import Arguments
from aionode.clock import MachineTime, Time
from aionode.engine.bare_node import BareNode
from aionode.engine.graph_queries import NamesAndTypes, names_and_types_of
from aionode.engine.log_levels import log_message
from aionode.errors import NameValidationException
from aionode.graph import SERVICE_KINDS, TOPIC_KINDS, EndpointKind
from aionode.interfaces.rcl_interfaces.msg import Log
from aionode.logging import get_logger
from rclpy._impl.context import parsed
from rclpy._impl.destroyable import Arrivals, Destroyable
from rclpy._impl.errors import NodeNameNonExistentError, RCLError
from rclpy._impl.qos import profile_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from aionode.engine.bare_node import BarePublisher
    from aionode.graph import EndpointInfo, Graph, NodeInfo
    from aionode.logging import LogEvent
    from rclpy._impl.context import ContextHandle

__all__ = ["NodeHandle"]

NOUNS = {
    EndpointKind.PUBLISHER: "publisher",
    EndpointKind.SUBSCRIPTION: "subscriber",
    EndpointKind.SERVER: "service",
    EndpointKind.CLIENT: "client",
}
"""rcl's word for each kind of endpoint, in errors."""

T = TypeVar("T")

system_ns = MachineTime().system_ns


class NodeHandle(Destroyable):
    """A node in the graph. The handles of its entities share `signal`.

    Attributes:
        context_handle: Its context.
        io: The thread that works for it.
        bare: The node in the core; used in that thread only.
        messages: Whether messages have arrived for its subscriptions.
        requests: Whether requests have arrived for its service servers.
        responses: Whether responses have arrived for its clients.
    """

    def __init__(
        self,
        node_name: str,
        namespace: str,
        context: ContextHandle,
        cli_args: Sequence[str] | None,
        use_global_arguments: bool,
        enable_rosout: bool,
        rosout_qos_profile: Any = None,
    ) -> None:
        super().__init__()
        self.messages = Arrivals(self.signal)
        self.requests = Arrivals(self.signal)
        self.responses = Arrivals(self.signal)
        self._stop_rosout: Callable[[], None] | None = None
        names.validate_node_name(node_name)
        namespace = names.normalize_namespace(namespace)
        own = parsed(cli_args or ())
        shared = context.arguments if use_global_arguments else Arguments()
        self.context_handle = context
        self.io = context.io
        self._rules = own.remap_rules + shared.remap_rules
        self._name = names.remap_node_name(self._rules, node_name)
        self._namespace = names.remap_namespace(self._rules, node_name, namespace)
        full_name = names.fully_qualified_name(self._namespace, self._name)
        self._overrides = {**shared.parameters_for(full_name), **own.parameters_for(full_name)}
        enclave = own.enclave or shared.enclave or "/"
        self.bare: BareNode = self.io.call(
            BareNode, self.io.context, self._name, self._namespace, enclave
        )
        if enable_rosout and shared.rosout_logs and own.rosout_logs:
            publisher = self.io.call(
                self.bare.create_publisher, Log, "/rosout", profile_of(rosout_qos_profile)
            )
            self._stop_rosout = get_logger(self.logger_name()).add_sink(
                partial(publish_log, self.io.post, publisher)
            )

    # Names

    def get_node_name(self) -> str:
        """Return the name without namespace."""
        return self._name

    def get_namespace(self) -> str:
        """Return the namespace, which starts with a slash."""
        return self._namespace

    def get_fully_qualified_name(self) -> str:
        """Return namespace and name in one."""
        return names.fully_qualified_name(self._namespace, self._name)

    def logger_name(self) -> str:
        """Return the name of the node's logger."""
        return names.logger_name(self._namespace, self._name)

    def resolve(self, name: str, *, only_expand: bool = False, is_service: bool = False) -> str:
        """Return the full name of a topic or service, remapped unless `only_expand`.

        Raises:
            InvalidTopicNameException: the name is invalid.
            InvalidServiceNameException: the name is invalid, and that of a service.
        """
        rules = () if only_expand else self._rules
        return names.resolve(name, self._name, self._namespace, rules, is_service=is_service)

    def get_parameters(self, parameter_class: Any) -> dict[str, Any]:
        """Return the parameters given by arguments, by name."""
        return {name: parameter_class(name, value=value) for name, value in self._overrides.items()}

    # Graph

    def ask(self, failure: str, question: Callable[[Graph], T]) -> T:
        """Return the result of `question`, which is called in the thread of the context.

        Raises:
            InvalidHandle: the node is destroyed.
            RCLError: the context is shut down; the text begins with `failure`.
        """
        with self:
            self.context_handle.refuse_after_shutdown(failure)
            return self.io.call(question, self.io.context.graph)

    def nodes(self) -> list[NodeInfo]:
        """Return all nodes."""
        return self.ask("Failed to get node names", lambda graph: list(graph.nodes()))

    def names_and_types(self, kinds: Iterable[EndpointKind]) -> NamesAndTypes:
        """Return all topics or all services, with their types."""
        noun = "topic" if kinds is TOPIC_KINDS else "service"
        return self.ask(
            f"failed to get {noun} names and types", lambda graph: graph.names_and_types(*kinds)
        )

    def names_and_types_of(
        self, kind: EndpointKind, node_name: str, node_namespace: str
    ) -> NamesAndTypes:
        """Return the names of a node's endpoints of `kind`, with their types.

        Raises:
            NodeNameNonExistentError: there is no node with this name.
            RCLError: the name or the namespace is invalid, or the context is shut down.
        """
        wanted = f"{NOUNS[kind]} names and types"
        failure = f"failed to get {wanted}"
        with self:
            try:
                names.validate_node_name(node_name)
                namespace = names.normalize_namespace(node_namespace)
                full_name = names.fully_qualified_name(namespace, node_name)
                return self.ask(failure, lambda graph: names_and_types_of(graph, kind, full_name))
            except NameValidationException as error:
                raise RCLError(f"{failure}: {error}") from None
            except errors.NodeNameNonExistentError as error:
                raise NodeNameNonExistentError(
                    f"cannot get {wanted} for nonexistent node: {error.node}"
                ) from None

    def count(self, kind: EndpointKind, name: str) -> int:
        """Count the endpoints of `kind` with a name, without remapping it."""
        with self:
            full_name = self._expected(name, only_expand=True, is_service=kind in SERVICE_KINDS)
            return self.ask(
                f"Error in rcl_count_{NOUNS[kind]}s", lambda graph: graph.count(kind, full_name)
            )

    def endpoints(
        self, kind: EndpointKind, topic_name: str, *, is_complete: bool
    ) -> list[EndpointInfo]:
        """Return the endpoints of a topic; its name is expanded unless it `is_complete`."""
        with self:
            is_service = kind in SERVICE_KINDS
            name = topic_name if is_complete else self._expected(topic_name, is_service=is_service)
            what = "service" if is_service else "topic"
            return self.ask(
                f"Failed to get information by {what} for {kind.value}s",
                lambda graph: graph.endpoints(kind, name=name),
            )

    def _expected(self, name: str, *, only_expand: bool = False, is_service: bool = False) -> str:
        """Return the full name of a topic or service.

        Raises:
            ValueError: the name is invalid; the text is rclpy's for graph queries.
        """
        try:
            return self.resolve(name, only_expand=only_expand, is_service=is_service)
        except NameValidationException as error:
            what = "service" if is_service else "topic"
            raise ValueError(f"{what} name is invalid: {error}") from None

    def _destroy(self) -> None:
        if self._stop_rosout is not None:
            self._stop_rosout()
        bare = getattr(self, "bare", None)
        if bare is not None:
            self.io.post(partial(self.io.change_delivery, bare.destroy_node))
        self.signal.notify()


def publish_log(
    post: Callable[[Callable[[], object]], None], publisher: BarePublisher, event: LogEvent
) -> None:
    """Publish one message of the log on ``/rosout``."""
    stamp_ns = system_ns()
    log = log_message(event, Time(nanoseconds=stamp_ns))
    post(partial(publisher.publish, log, stamp_ns))
