"""Managed nodes."""

from __future__ import annotations

from traceback import format_exc
from typing import TYPE_CHECKING, Any, NamedTuple

from aionode.engine.rules.lifecycle_answers import StateAnswers
from rclpy._impl import lifecycle as msg
from rclpy._impl.errors import RCLError
from rclpy._impl.lifecycle import LifecycleStateMachine, TransitionCallbackReturn
from rclpy.lifecycle.managed_entity import ManagedEntity
from rclpy.lifecycle.publisher import LifecyclePublisher
from rclpy.node import Node

if TYPE_CHECKING:
    from collections.abc import Callable

    from rclpy.callback_groups import CallbackGroup
    from rclpy.qos import QoSProfile

__all__ = [
    "LifecycleNode",
    "LifecycleNodeMixin",
    "LifecycleState",
    "TransitionCallbackReturn",
]


class LifecycleState(NamedTuple):
    """A state of a managed node."""

    label: str
    state_id: int


class LifecycleNodeMixin(ManagedEntity):
    """Makes a node a managed node; to be used with `Node`, as in `LifecycleNode`.

    Args:
        enable_communication_interface: Whether others can query and change its state.
        callback_group: The group of those services.
    """

    handle: Any
    create_service: Callable[..., Any]
    default_callback_group: Any
    get_logger: Callable[[], Any]

    def __init__(
        self,
        *,
        enable_communication_interface: bool = True,
        callback_group: CallbackGroup | None = None,
    ) -> None:
        if not isinstance(self, Node):
            raise RuntimeError(  # as rclpy does
                "LifecycleNodeMixin uses Node fields so Node needs to be in the inheritance tree."
            )
        # A dict for its order; rclpy uses a set.
        self._managed_entities: dict[ManagedEntity, None] = {}
        if not isinstance(enable_communication_interface, bool):
            raise TypeError(
                "enable_communication_interface must be a bool, not "
                f"{type(enable_communication_interface).__name__}"
            )
        with self.handle:
            self._state_machine = LifecycleStateMachine(self.handle)
        if enable_communication_interface:
            self._LifecycleNode__serve(callback_group or self.default_callback_group)

    def _LifecycleNode__serve(self, group: CallbackGroup) -> None:
        """Answer the services of the state machine."""
        machine = self._state_machine
        answers = StateAnswers(machine.machine, msg.LifecycleState, msg.TransitionDescription)
        for name, srv_type, callback in (
            ("change_state", msg.ChangeState, self._LifecycleNode__on_change_state),
            ("get_state", msg.GetState, answers.get_state),
            ("get_available_states", msg.GetAvailableStates, answers.get_available_states),
            (
                "get_available_transitions",
                msg.GetAvailableTransitions,
                answers.get_available_transitions,
            ),
            ("get_transition_graph", msg.GetAvailableTransitions, answers.get_transition_graph),
        ):
            service = self.create_service(
                srv_type,
                f"~/{name}",
                self._LifecycleNode__unless_destroyed(callback),
                qos_profile=msg.TEN_MESSAGES,
                callback_group=group,
            )
            setattr(self, f"_service_{name}", service)
            setattr(machine, f"service_{name}", service.handle)

    def _LifecycleNode__unless_destroyed(
        self, callback: Callable[[Any, Any], Any]
    ) -> Callable[[Any, Any], Any]:
        def answer(request: Any, response: Any) -> Any:
            self._LifecycleNode__check_is_initialized()
            return callback(request, response)

        return answer

    # Transitions

    def trigger_configure(self) -> TransitionCallbackReturn:
        """Configure the node; return the result of its callback."""
        return self._LifecycleNode__change_state(1)

    def trigger_cleanup(self) -> TransitionCallbackReturn:
        """Clean the node up; return the result of its callback."""
        return self._LifecycleNode__change_state(2)

    def trigger_activate(self) -> TransitionCallbackReturn:
        """Activate the node; return the result of its callback."""
        return self._LifecycleNode__change_state(3)

    def trigger_deactivate(self) -> TransitionCallbackReturn:
        """Deactivate the node; return the result of its callback."""
        return self._LifecycleNode__change_state(4)

    def trigger_shutdown(self) -> TransitionCallbackReturn:
        """Shut the node down; return the result of its callback.

        Raises:
            RCLError: it is shut down, or in a transition.
        """
        transition = self._state_machine.machine.find("shutdown")
        if transition is None:
            raise RCLError("Shutdown transtion not possible")
        return self._LifecycleNode__change_state(transition.transition_id)

    def _LifecycleNode__change_state(self, transition_id: int) -> TransitionCallbackReturn:
        self._LifecycleNode__check_is_initialized()
        machine = self._state_machine
        number, label = machine.current_state
        before = LifecycleState(label=label, state_id=number)
        try:
            transition = machine.trigger_transition_by_id(transition_id, True)
        except RCLError:
            self.get_logger().error(
                f"Unable to start transition {transition_id} from current state "
                f"{machine.current_state}"
            )
            return TransitionCallbackReturn.ERROR
        outcome = self._LifecycleNode__execute_callback(f"on_{transition.label}", before)
        machine.trigger_transition_by_label(outcome.to_label(), True)
        if outcome is TransitionCallbackReturn.ERROR:
            after_error = self._LifecycleNode__execute_callback("on_error", before)
            machine.trigger_transition_by_label(after_error.to_label(), True)
        return outcome

    def _LifecycleNode__execute_callback(
        self, name: str, before: LifecycleState
    ) -> TransitionCallbackReturn:
        """Call the callback that determines the next state; an exception counts as an error."""
        callback: Callable[[LifecycleState], TransitionCallbackReturn] = getattr(self, name)
        try:
            return callback(before)
        except Exception as error:  # noqa: BLE001  # as rclpy; the state machine goes on with an error
            self.get_logger().error(  # rclpy's loggers have no exception()
                f"{name}() raised {type(error).__name__}: {error}\n{format_exc()}"
            )
            return TransitionCallbackReturn.ERROR

    def _LifecycleNode__check_is_initialized(self) -> None:
        if not self._state_machine.initialized:
            raise RuntimeError(
                "Internal error: got service request while lifecycle state machine is not "
                "initialized."
            )

    # Entities

    def add_managed_entity(self, entity: ManagedEntity) -> None:
        """Notify `entity` of transitions.

        Raises:
            TypeError: it is not a `ManagedEntity`.
        """
        if not isinstance(entity, ManagedEntity):
            raise TypeError("Expected a rclpy.lifecycle.ManagedEntity instance.")
        self._managed_entities[entity] = None

    def _LifecycleNode__tell_entities(
        self, callback_name: str, state: Any
    ) -> TransitionCallbackReturn:
        """Call a callback of all entities, up to the first that does not succeed."""
        for entity in list(self._managed_entities):
            outcome = getattr(entity, callback_name)(state)
            if not isinstance(outcome, TransitionCallbackReturn):
                raise TypeError(
                    f"{callback_name}() return value of class {type(entity)} should be "
                    "`TransitionCallbackReturn`.\n"
                    f"Instance of the class that caused the failure: {entity}"
                )
            if outcome is not TransitionCallbackReturn.SUCCESS:
                return outcome
        return TransitionCallbackReturn.SUCCESS

    def on_configure(self, state: Any) -> TransitionCallbackReturn:
        """Handle the transition from unconfigured to inactive; notifies the managed entities."""
        return self._LifecycleNode__tell_entities("on_configure", state)

    def on_cleanup(self, state: Any) -> TransitionCallbackReturn:
        """Handle the transition from inactive to unconfigured; notifies the managed entities."""
        return self._LifecycleNode__tell_entities("on_cleanup", state)

    def on_shutdown(self, state: Any) -> TransitionCallbackReturn:
        """Handle the transition to finalized; notifies the managed entities."""
        return self._LifecycleNode__tell_entities("on_shutdown", state)

    def on_activate(self, state: Any) -> TransitionCallbackReturn:
        """Handle the transition from inactive to active; notifies the managed entities."""
        return self._LifecycleNode__tell_entities("on_activate", state)

    def on_deactivate(self, state: Any) -> TransitionCallbackReturn:
        """Handle the transition from active to inactive; notifies the managed entities."""
        return self._LifecycleNode__tell_entities("on_deactivate", state)

    def on_error(self, state: Any) -> TransitionCallbackReturn:
        """Handle an error in another callback; notifies the managed entities."""
        return self._LifecycleNode__tell_entities("on_error", state)

    def create_lifecycle_publisher(
        self,
        msg_type: Any,
        topic: str,
        qos_profile: QoSProfile | int,
        *,
        publisher_class: None = None,
        **kwargs: Any,
    ) -> LifecyclePublisher[Any]:
        """Return a publisher that drops messages published while the node is not active.

        Raises:
            TypeError: a `publisher_class` is given.
        """
        if publisher_class:
            raise TypeError(
                "create_publisher() got an unexpected keyword argument 'publisher_class'"
            )
        assert isinstance(self, Node)  # noqa: S101  # checked by the constructor
        publisher: LifecyclePublisher[Any] = Node.create_publisher(
            self, msg_type, topic, qos_profile, publisher_class=LifecyclePublisher, **kwargs
        )
        self._managed_entities[publisher] = None
        return publisher

    def destroy_lifecycle_publisher(self, publisher: LifecyclePublisher[Any]) -> bool:
        """Destroy a publisher; return whether it belonged to this node."""
        self._managed_entities.pop(publisher, None)
        assert isinstance(self, Node)  # noqa: S101  # checked by the constructor
        return self.destroy_publisher(publisher)

    # Services

    def _LifecycleNode__on_change_state(self, request: Any, response: Any) -> Any:
        transition_id = request.transition.id
        if request.transition.label:
            try:
                transition_id = self._state_machine.get_transition_by_label(
                    request.transition.label
                )
            except RCLError:
                response.success = False
                return response
        response.success = (
            self._LifecycleNode__change_state(transition_id) is TransitionCallbackReturn.SUCCESS
        )
        return response


class LifecycleNode(LifecycleNodeMixin, Node):
    """A managed node.

    Args:
        node_name: Its name.
        enable_communication_interface: Whether others can query and change its state.
        options: The options of `Node`.
    """

    def __init__(
        self, node_name: str, *, enable_communication_interface: bool = True, **options: Any
    ) -> None:
        Node.__init__(self, node_name, **options)
        LifecycleNodeMixin.__init__(
            self, enable_communication_interface=enable_communication_interface
        )

    def destroy_node(self) -> None:
        """Destroy its entities, and leave the graph."""
        self._state_machine.destroy()
        super().destroy_node()
