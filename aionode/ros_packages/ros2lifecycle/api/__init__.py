"""Requests of `ros2 lifecycle` to managed nodes."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from lifecycle_msgs.srv import ChangeState, GetAvailableTransitions, GetState

import rclpy
from ros2node.api import NodeName
from ros2node.api import get_node_names as get_all_node_names
from ros2service.api import get_service_names_and_types

__all__ = [
    "call_change_states",
    "call_get_available_transitions",
    "call_get_states",
    "call_get_transition_graph",
    "get_node_names",
]

POLL_SEC = 1.0


def get_node_names(*, node: Any, include_hidden_nodes: bool = False) -> list[NodeName]:
    """Return the managed nodes of the graph."""
    services = dict(
        get_service_names_and_types(node=node, include_hidden_services=include_hidden_nodes)
    )
    return [
        each
        for each in get_all_node_names(node=node, include_hidden_nodes=include_hidden_nodes)
        if "lifecycle_msgs/srv/GetState" in services.get(f"{each.full_name}/get_state", [])
    ]


def answers(node: Any, cls: Any, service: str, requests: Mapping[str, Any]) -> dict[str, Any]:
    """Return the response of each node or the exception, however long it takes.

    Args:
        node: The node that asks.
        cls: The class of the service.
        service: Its name, in each node.
        requests: The request for each node.
    """
    clients = {name: node.create_client(cls, f"{name}/{service}") for name in requests}
    futures: dict[str, Any] = {}
    while len(futures) < len(clients):
        for name in clients.keys() - futures:
            if clients[name].service_is_ready():
                futures[name] = clients[name].call_async(requests[name])
        if len(futures) < len(clients):
            rclpy.spin_once(node, timeout_sec=POLL_SEC)
    for future in futures.values():
        rclpy.spin_until_future_complete(node, future)
    for client in clients.values():
        node.destroy_client(client)
    return {name: futures[name].exception() or futures[name].result() for name in requests}


def call_get_states(*, node: Any, node_names: list[str]) -> dict[str, Any]:
    """Return the state of each node, or the exception."""
    found = answers(node, GetState, "get_state", dict.fromkeys(node_names, GetState.Request()))
    return {name: getattr(answer, "current_state", answer) for name, answer in found.items()}


def call_get_available_transitions(*, node: Any, states: Mapping[str, Any]) -> dict[str, Any]:
    """Return the transitions now available in each node, from a state if one is given."""
    return transitions_of(node, states, "get_available_transitions")


def call_get_transition_graph(*, node: Any, states: Mapping[str, Any]) -> dict[str, Any]:
    """Return all transitions of each node, or those from a state if one is given."""
    return transitions_of(node, states, "get_transition_graph")


def transitions_of(node: Any, states: Mapping[str, Any], service: str) -> dict[str, Any]:
    """Return the transitions that a service of each node lists, or the exception."""
    requests = dict.fromkeys(states, GetAvailableTransitions.Request())
    found = answers(node, GetAvailableTransitions, service, requests)
    return {
        name: [
            transition
            for transition in answer.available_transitions
            if states[name] is None or transition.start_state == states[name]
        ]
        if hasattr(answer, "available_transitions")
        else answer
        for name, answer in found.items()
    }


def call_change_states(*, node: Any, transitions: Mapping[str, Any]) -> dict[str, Any]:
    """Return whether each node made its transition, or the exception."""
    requests = {
        name: ChangeState.Request(transition=transition) for name, transition in transitions.items()
    }
    found = answers(node, ChangeState, "change_state", requests)
    return {name: getattr(answer, "success", answer) for name, answer in found.items()}
