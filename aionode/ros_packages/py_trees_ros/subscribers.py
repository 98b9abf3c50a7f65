"""Behaviours that receive messages: a callback keeps the last one, and ticks read it."""

from __future__ import annotations

import operator
import threading
from collections.abc import Callable
from typing import Any

import py_trees
from py_trees.common import Access, ClearingPolicy, Status
from std_msgs.msg import Empty

from py_trees_ros.utilities import node_among

__all__ = ["CheckData", "EventToBlackboard", "Handler", "ToBlackboard", "WaitForData"]


class Handler(py_trees.behaviour.Behaviour):
    """Subscribes and keeps the last message; the base of the behaviours that interpret it.

    Args:
        name: The behaviour's name.
        topic_name: The topic.
        topic_type: The class of its messages.
        qos_profile: The profile of the subscription.
        clearing_policy: When a received message is forgotten.
    """

    def __init__(
        self,
        name: str,
        topic_name: str,
        topic_type: Any,
        qos_profile: Any,
        clearing_policy: ClearingPolicy = ClearingPolicy.ON_INITIALISE,
    ) -> None:
        super().__init__(name=name)
        self.topic_name = topic_name
        self.topic_type = topic_type
        self.msg: Any = None
        self.subscriber: Any = None
        self.data_guard = threading.Lock()
        self.clearing_policy = clearing_policy
        self.qos_profile = qos_profile
        self.node: Any = None

    def setup(self, **kwargs: Any) -> None:
        """Subscribe.

        Raises:
            KeyError: The argument ``node`` is missing.
        """
        self.node = node_among(kwargs, self)
        self.subscriber = self.node.create_subscription(
            self.topic_type, self.topic_name, self._callback, self.qos_profile
        )

    def initialise(self) -> None:
        """Forget the message if the policy says so."""
        self.logger.debug(f"{type(self).__name__}.initialise()")
        if self.clearing_policy is ClearingPolicy.ON_INITIALISE:
            with self.data_guard:
                self.msg = None

    def _callback(self, msg: Any) -> None:
        with self.data_guard:
            self.msg = msg

    def _forget_on_success(self) -> None:
        if self.clearing_policy is ClearingPolicy.ON_SUCCESS:
            self.msg = None


class CheckData(Handler):
    """Compares a field of the last message with a value.

    Args:
        name: The behaviour's name.
        topic_name: The topic.
        topic_type: The class of its messages.
        qos_profile: The profile of the subscription.
        variable_name: The field, such as ``pose.position.x``.
        expected_value: The value to compare it with.
        comparison_operator: Called with the field and the expected value.
        fail_if_no_data: Whether it fails, rather than runs, until a message arrives.
        fail_if_bad_comparison: Whether it fails, rather than runs, if the comparison is false.
        clearing_policy: When a received message is forgotten.
    """

    def __init__(
        self,
        name: str,
        topic_name: str,
        topic_type: Any,
        qos_profile: Any,
        variable_name: str,
        expected_value: Any,
        comparison_operator: Callable[[Any, Any], bool] = operator.eq,
        fail_if_no_data: bool = False,
        fail_if_bad_comparison: bool = False,
        clearing_policy: ClearingPolicy = ClearingPolicy.ON_INITIALISE,
    ) -> None:
        super().__init__(name, topic_name, topic_type, qos_profile, clearing_policy)
        self.variable_name = variable_name
        self.expected_value = expected_value
        self.comparison_operator = comparison_operator
        self.fail_if_no_data = fail_if_no_data
        self.fail_if_bad_comparison = fail_if_bad_comparison

    def update(self) -> Status:
        """Compare the field with the value."""
        self.logger.debug(f"{type(self).__name__}.update()")
        with self.data_guard:
            msg = self.msg
        if msg is None:
            self.feedback_message = "have not yet received any messages"
            return Status.FAILURE if self.fail_if_no_data else Status.RUNNING
        try:
            value = operator.attrgetter(self.variable_name)(msg)
        except AttributeError:
            self.feedback_message = f"variable name not found [{self.variable_name}]"
            self.node.get_logger().error(f"Behaviour [{self.name}]: {self.feedback_message}")
            return Status.FAILURE
        success = self.comparison_operator(value, self.expected_value)
        how = "succeeded" if success else "failed"
        self.feedback_message = (
            f"'{self.variable_name}' comparison {how} [v: {value}][e: {self.expected_value}]"
        )
        if success:
            with self.data_guard:
                self._forget_on_success()
            return Status.SUCCESS
        return Status.FAILURE if self.fail_if_bad_comparison else Status.RUNNING


class WaitForData(Handler):
    """Runs until a message arrives, whatever it contains; takes the arguments of `Handler`."""

    def update(self) -> Status:
        """Check whether a message has arrived."""
        self.logger.debug(f"{type(self).__name__}.update()")
        with self.data_guard:
            if self.msg is None:
                self.feedback_message = "no message received yet"
                return Status.RUNNING
            self.feedback_message = "got incoming"
            self._forget_on_success()
            return Status.SUCCESS


class ToBlackboard(Handler):
    """Writes the last message, or fields of it, to the blackboard; runs until one arrives.

    Args:
        name: The behaviour's name.
        topic_name: The topic.
        topic_type: The class of its messages.
        qos_profile: The profile of the subscription.
        blackboard_variables: The key for the message; or the field for each key, such as
            ``pose.position``, or None for the whole message.
        initialise_variables: The values of the keys until then; for a single key, its value.
        clearing_policy: When a received message is forgotten.
    """

    def __init__(
        self,
        name: str,
        topic_name: str,
        topic_type: Any,
        qos_profile: Any,
        blackboard_variables: Any = None,
        initialise_variables: Any = None,
        clearing_policy: ClearingPolicy = ClearingPolicy.ON_INITIALISE,
    ) -> None:
        super().__init__(name, topic_name, topic_type, qos_profile, clearing_policy)
        self.blackboard = self.attach_blackboard_client(name=self.name)
        self.logger = py_trees.logging.Logger(self.name)
        variables: Any = {} if blackboard_variables is None else blackboard_variables
        initial = {} if initialise_variables is None else initialise_variables
        if isinstance(variables, str):
            initial = initial if isinstance(initial, dict) else {variables: initial}
            variables = {variables: None}
        elif not isinstance(variables, dict):
            self.logger.error("blackboard_variables is not a dict, please rectify")
            variables, initial = {}, {}
        self.blackboard_variable_mapping: dict[str, str | None] = variables
        self.blackboard_initial_variable_mapping: dict[str, Any] = initial
        for key in variables:
            self.blackboard.register_key(key=key, access=Access.WRITE)
        for key, value in initial.items():
            if not self.blackboard.set(key, value):
                self.logger.error(
                    f"tried to initialise an already initialised blackboard variable '{key}', "
                    f"check that you do not have a conflict with another behaviour [{self.name}]"
                )

    def update(self) -> Status:
        """Write the message if one has arrived."""
        with self.data_guard:
            if self.msg is None:
                self.feedback_message = "no message received yet"
                return Status.RUNNING
            for key, field in self.blackboard_variable_mapping.items():
                value = self.msg if field is None else operator.attrgetter(field)(self.msg)
                self.blackboard.set(key, value, overwrite=True)
            self.feedback_message = "saved incoming message"
            self._forget_on_success()
            return Status.SUCCESS


class EventToBlackboard(Handler):
    """Writes whether an `Empty` has arrived since the last tick; always succeeds.

    Args:
        name: The behaviour's name.
        topic_name: The topic.
        qos_profile: The profile of the subscription.
        variable_name: The key.
    """

    def __init__(self, name: str, topic_name: str, qos_profile: Any, variable_name: str) -> None:
        super().__init__(name, topic_name, Empty, qos_profile, ClearingPolicy.ON_SUCCESS)
        self.variable_name = variable_name
        self.blackboard = self.attach_blackboard_client(name=self.name)
        self.blackboard.register_key(key=self.variable_name, access=Access.WRITE)

    def update(self) -> Status:
        """Write whether one has arrived."""
        self.logger.debug(f"{type(self).__name__}.update()")
        with self.data_guard:
            self.blackboard.set(self.variable_name, self.msg is not None, overwrite=True)
            self._forget_on_success()
        return Status.SUCCESS
