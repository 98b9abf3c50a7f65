"""Events of changed parameters, which are published only when somebody hears them."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest
from rcl_interfaces.msg import ParameterEvent

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import qos_profile_parameter_events
from tests.support.peers import isolated_environment

MAX_ROUNDS = 200


@pytest.fixture
def isolated(monkeypatch: pytest.MonkeyPatch) -> None:
    """A domain of its own."""
    for name, value in isolated_environment().items():
        monkeypatch.setenv(name, value)


@pytest.fixture
def context(isolated: None) -> Iterator[rclpy.Context]:
    """The context of the node with parameters."""
    context = rclpy.Context()
    rclpy.init(args=[], context=context)
    yield context
    rclpy.shutdown(context=context)


@pytest.fixture
def other(isolated: None) -> Iterator[rclpy.Context]:
    """A context that communicates with the first as another process does."""
    context = rclpy.Context()
    rclpy.init(args=[], context=context)
    yield context
    rclpy.shutdown(context=context)


class Listener:
    """A subscription to parameter events.

    Attributes:
        names: The new and changed parameters in the events of the node ``/robot``.
    """

    def __init__(self, context: rclpy.Context) -> None:
        self.node = Node("listener", context=context, start_parameter_services=False)
        self.names: list[str] = []
        self._executor = SingleThreadedExecutor(context=context)
        self._executor.add_node(self.node)
        self.node.create_subscription(
            ParameterEvent, "/parameter_events", self._hear, qos_profile_parameter_events
        )

    def _hear(self, event: ParameterEvent) -> None:
        if event.node == "/robot":
            changes = (*event.new_parameters, *event.changed_parameters)
            self.names += [parameter.name for parameter in changes]

    def hears(self, name: str, change: Callable[[], object] = lambda: None) -> bool:
        """Repeat a change until an event about a parameter comes, and return whether it does."""
        for _ in range(MAX_ROUNDS):
            change()
            self._executor.spin_once(timeout_sec=0.1)
            if name in self.names:
                return True
        return False


def test_a_subscription_hears_the_parameters_of_a_later_node(context: rclpy.Context) -> None:
    """It matches before the node declares its first parameter."""
    listener = Listener(context)

    node = Node("robot", context=context)
    node.declare_parameter("speed", 1)

    assert listener.hears("speed")


def test_a_later_subscription_hears_the_next_change(context: rclpy.Context) -> None:
    """Though nobody heard the events before."""
    node = Node("robot", context=context)
    node.declare_parameter("speed", 1)
    listener = Listener(context)

    node.set_parameters([Parameter("speed", value=2)])

    assert listener.hears("speed")


def test_a_later_subscription_of_another_process_hears_changes(
    context: rclpy.Context, other: rclpy.Context
) -> None:
    """Once the two are matched."""
    node = Node("robot", context=context)
    node.declare_parameter("speed", 1)
    listener = Listener(other)

    assert listener.hears("speed", lambda: node.set_parameters([Parameter("speed", value=2)]))
