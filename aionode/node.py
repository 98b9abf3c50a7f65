"""`Node`, which a program creates or derives from.

Its parts, and where they decide:

- publishers, subscriptions, services, clients, timers: made in `_node/endpoints.py`; each class is
  in `endpoints/`
- parameters: `_node/parameters.py`; a change is refused in `parameter/_store.py`
- queries of the graph: `_node/graph.py`
- the lifetime: `_node/base.py`; the end in stages: `endpoints/_core/shutdown.py`
"""

from __future__ import annotations

from functools import partial, wraps
from typing import TYPE_CHECKING, Any, Literal, TypeVar

from aionode import names, qos
from aionode._node import builtin_services
from aionode._node.endpoints import NodeEndpoints
from aionode._node.graph import NodeGraphQueries
from aionode._node.time_source import TimeSource
from aionode.engine.context import Context
from aionode.interfaces.rcl_interfaces.msg import ParameterDescriptor
from aionode.message import Message

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from aionode.action import ActionClient, ActionServer, ServerGoalHandle
    from aionode.endpoints._core.callback_runner import OnError
    from aionode.graph import EndpointInfo
    from aionode.message import ActionClass
    from aionode.parameter import Parameter
    from aionode.qos import QoSProfile

__all__ = ["Node"]

GoalT = TypeVar("GoalT", bound=Message)
ResultT = TypeVar("ResultT", bound=Message)
FeedbackT = TypeVar("FeedbackT", bound=Message)
ConstructorT = TypeVar("ConstructorT", bound="Callable[..., None]")


def in_context_thread(constructor: ConstructorT) -> ConstructorT:
    """Have the constructor of `Node` run in the thread of its context's loop, if that is open."""

    @wraps(constructor)
    def construct(self: Node, *args: Any, **options: Any) -> None:
        affinity = (options.get("context") or Context.default())._affinity
        if affinity.is_other_thread():
            affinity.wait_for(partial(constructor, self, *args, **options))
        else:
            constructor(self, *args, **options)

    return construct  # type: ignore[return-value]  # it has the same signature


class Node(NodeEndpoints, NodeGraphQueries):
    """A participant in the ROS graph, with publishers, subscriptions, services, clients and timers.

    A node and its entities can be created at any time, with or without a running event loop, and in
    any thread: outside the thread of the context's event loop the call blocks until the loop has
    created them. Their callbacks are called while the node runs: inside ``async with node:``, or
    during ``await node.run()``. A node runs once; after `destroy_node` every use raises
    EntityDestroyedError.

    An exception in the callback of a subscription or timer ends the node, unless the entity's
    `on_error` says otherwise: all its callbacks are cancelled, and the exception comes out of
    ``async with`` or `run` in an ExceptionGroup, as from an `asyncio.TaskGroup`. Services and
    action servers report it to the caller, log it, and carry on. An exception from the body of
    ``async with`` itself propagates unchanged.

    Args:
        node_name: Letters, digits and underscores, not beginning with a digit.
        namespace: Prefix of the node's relative names; the root by default.
        context: The context to join; `Context.default()` by default.
        cli_args: Arguments for this node alone, as on a command line.
        use_global_arguments: Whether the arguments given to `aionode.run` apply to it too.
        enable_rosout: Whether its log is also published on ``/rosout``.
        rosout_qos_profile: QoS of that publisher.
        start_parameter_services: Whether other nodes can read and set its parameters.
        parameter_overrides: Values that take precedence over those given to `declare_parameter`.
        allow_undeclared_parameters: Whether parameters can be set without being declared.
        automatically_declare_parameters_from_overrides: Whether to declare a parameter for each
            override.
        enable_logger_service: Whether other nodes can read and set its log levels.
        callback_budget_ms: How long, in milliseconds, a callback may block the event loop before
            that is reported.

    Raises:
        InvalidNodeNameException: `node_name` is invalid (a ValueError).
        InvalidNamespaceException: `namespace` is invalid (a ValueError).
        EntityDestroyedError: the context was shut down (a RuntimeError).
    """

    @in_context_thread
    def __init__(
        self,
        node_name: str,
        *,
        namespace: str | None = None,
        context: Context | None = None,
        cli_args: Sequence[str] | None = None,
        use_global_arguments: bool = True,
        enable_rosout: bool = True,
        rosout_qos_profile: QoSProfile | int = qos.qos_profile_rosout_default,
        start_parameter_services: bool = True,
        parameter_overrides: Sequence[Parameter] | None = None,
        allow_undeclared_parameters: bool = False,
        automatically_declare_parameters_from_overrides: bool = False,
        enable_logger_service: bool = False,
        callback_budget_ms: float = 10.0,
    ) -> None:
        names.validate_node_name(node_name)
        namespace = names.normalize_namespace(namespace)
        super().__init__(
            node_name,
            namespace,
            Context.default() if context is None else context,
            cli_args,
            use_global_arguments=use_global_arguments,
            callback_budget_ms=callback_budget_ms,
            parameter_overrides=parameter_overrides or (),
            allow_undeclared_parameters=allow_undeclared_parameters,
        )
        self._Node__join_context()
        shared, own = self._Node__shared_arguments, self._Node__own_arguments
        if enable_rosout and shared.rosout_logs and own.rosout_logs:
            self._Node__stop_rosout = builtin_services.publish_log(self, rosout_qos_profile)
        self._Node__parameter_store.publish = builtin_services.publish_parameter_events(self)
        for usage in self._Node__usages:
            if not usage.is_over:
                usage.note_parameters(self._Node__parameter_store)
        if automatically_declare_parameters_from_overrides:
            dynamic = ParameterDescriptor(dynamic_typing=True)
            for name in self._Node__parameter_store.overrides:
                self.declare_parameter(name, descriptor=dynamic)
        TimeSource(self, self._Node__clock)
        if start_parameter_services:
            builtin_services.serve_parameters(self, self._Node__parameter_store)
        builtin_services.serve_type_descriptions(self)
        if enable_logger_service:
            builtin_services.serve_logger_levels(self)
        self._Node__constructed = True

    def create_action_server(
        self,
        action_type: ActionClass[GoalT, ResultT, FeedbackT],
        action_name: str,
        execute_callback: Callable[[ServerGoalHandle[GoalT, ResultT, FeedbackT]], Any],
        *,
        goal_callback: Callable[[GoalT], Any] | None = None,
        handle_accepted_callback: (
            Callable[[ServerGoalHandle[GoalT, ResultT, FeedbackT]], Any] | None
        ) = None,
        cancel_callback: (
            Callable[[ServerGoalHandle[GoalT, ResultT, FeedbackT]], Any] | None
        ) = None,
        result_timeout: float = 10.0,
        max_goals: int = 1000,
        concurrent: bool | int = True,
        on_error: OnError = "log",
        offload: bool = False,
        on_client_lost: Literal["cancel", "continue"] | None = None,
        client_lost_sec: float = 3.0,
    ) -> ActionServer[GoalT, ResultT, FeedbackT]:
        """Return a server that executes goals; see `aionode.ActionServer` for all arguments."""
        from aionode.action import ActionServer  # nodes without actions start faster

        return ActionServer(
            self,
            action_type,
            action_name,
            execute_callback,
            goal_callback=goal_callback,
            handle_accepted_callback=handle_accepted_callback,
            cancel_callback=cancel_callback,
            result_timeout=result_timeout,
            max_goals=max_goals,
            concurrent=concurrent,
            on_error=on_error,
            offload=offload,
            on_client_lost=on_client_lost,
            client_lost_sec=client_lost_sec,
        )

    def create_action_client(
        self, action_type: ActionClass[GoalT, ResultT, FeedbackT], action_name: str
    ) -> ActionClient[GoalT, ResultT, FeedbackT]:
        """Return a client that sends goals; see `aionode.ActionClient`."""
        from aionode.action import ActionClient  # nodes without actions start faster

        return ActionClient(self, action_type, action_name)

    async def find_type(self, name: str, *, endpoints: Sequence[EndpointInfo] | None = None) -> Any:
        """Return the message, service or action class of a type that is known by its name.

        That is the class of this program or of aionode. If neither has it, or the nodes that use
        the type have another definition of it, the class is made from the description that one of
        these nodes sends: five nodes are asked at most, each for at most 2 s. Such a class is
        accepted only if it has the type hash that the graph shows. Cancelling is safe. The result
        is `Any` to type checkers::

            message = await node.find_type("my_robot_msgs/msg/Words")
            node.create_subscription(message, "/words", print)

        Args:
            name: Its ROS name.
            endpoints: Ask only the nodes of these endpoints; by default of all that use the type.

        Raises:
            InterfaceNotFoundError: the type is not known here, and no node describes it within the
                limits of a description; the text says what was wrong (a LookupError).
            EntityDestroyedError: the node was destroyed (a RuntimeError).
        """
        from aionode._node.type_lookup import find_type  # most programs know their types

        return await find_type(self, name, endpoints)
