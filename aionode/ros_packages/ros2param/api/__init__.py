"""Requests of `ros2 param` to nodes."""

from __future__ import annotations

import sys
from typing import Any

from rcl_interfaces.msg import ParameterType

import rclpy
from rclpy.parameter import (
    get_parameter_value as get_parameter_value,
)
from rclpy.parameter import (
    parameter_dict_from_yaml_file,
    parameter_value_to_python,
)
from rclpy.parameter_client import AsyncParameterClient
from ros2cli.node.direct import DirectNode

__all__ = [
    "ParameterNameCompleter",
    "call_describe_parameters",
    "call_get_parameters",
    "call_list_parameters",
    "call_set_parameters",
    "get_parameter_type_string",
    "get_parameter_value",
    "get_value",
    "load_parameter_file",
]

READY_SEC = 5.0

TYPES = {
    getattr(ParameterType, f"PARAMETER_{name.replace(' ', '_').upper()}"): shown
    for name, shown in (
        ("bool", "boolean"),
        ("integer", "integer"),
        ("double", "double"),
        ("string", "string"),
        ("byte array", "byte array"),
        ("bool array", "boolean array"),
        ("integer array", "integer array"),
        ("double array", "double array"),
        ("string array", "string array"),
        ("not set", "not set"),
    )
}


def client_of(node: Any, node_name: str) -> AsyncParameterClient:
    """Return a client for the parameters of a node, waiting until the node exists.

    Raises:
        RuntimeError: It does not appear in time.
    """
    client = AsyncParameterClient(node, node_name)
    if not client.wait_for_services(timeout_sec=READY_SEC):
        raise RuntimeError(
            f"Wait for service timed out waiting for parameter services for node {node_name}"
        )
    return client


def answer_to(future: Any, node: Any, node_name: str) -> Any:
    """Return the response of a node.

    Raises:
        RuntimeError: There is none.
    """
    rclpy.spin_until_future_complete(node, future)
    if future.exception() is not None or future.result() is None:
        raise RuntimeError(
            f"Exception while calling service of node {node_name}: {future.exception()}"
        )
    return future.result()


def get_value(*, parameter_value: Any) -> Any:
    """Return the value of a `ParameterValue`; print an error and return None if it has none."""
    try:
        return parameter_value_to_python(parameter_value)
    except RuntimeError as error:
        print(f"Runtime error {error} raised")
        return None


def load_parameter_file(
    *, node: Any, node_name: str, parameter_file: str, use_wildcard: bool
) -> None:
    """Set the parameters of a node from a file, and print the result for each.

    Raises:
        RuntimeError: The node does not exist, or does not respond.
    """
    client = client_of(node, node_name)
    names = parameter_dict_from_yaml_file(parameter_file, use_wildcard, [node_name])
    future = client.load_parameter_file(parameter_file, use_wildcard)
    for name, result in zip(names, answer_to(future, node, node_name).results, strict=True):
        how, stream = ("successful", sys.stdout) if result.successful else ("failed", sys.stderr)
        reason = f": {result.reason}" if result.reason else ""
        print(f"Set parameter {name} {how}{reason}", file=stream)


def call_describe_parameters(
    *, node: Any, node_name: str, parameter_names: list[str] | None = None
) -> Any:
    """Return a node's response with the descriptions of parameters.

    Raises:
        RuntimeError: The node does not exist, or does not respond.
    """
    client = client_of(node, node_name)
    return answer_to(client.describe_parameters(parameter_names or []), node, node_name)


def call_get_parameters(*, node: Any, node_name: str, parameter_names: list[str]) -> Any:
    """Return a node's response with the values of parameters.

    Raises:
        RuntimeError: The node does not exist, or does not respond.
    """
    client = client_of(node, node_name)
    return answer_to(client.get_parameters(parameter_names), node, node_name)


def call_set_parameters(*, node: Any, node_name: str, parameters: list[Any]) -> Any:
    """Set parameters of a node, and return its response.

    Raises:
        RuntimeError: The node does not exist, or does not respond.
    """
    client = client_of(node, node_name)
    return answer_to(client.set_parameters(parameters), node, node_name)


def call_list_parameters(*, node: Any, node_name: str, prefixes: list[str] | None = None) -> Any:
    """Return a completed future with a node's response that lists its parameters.

    Returns:
        The future; None if the node does not exist.
    """
    client = AsyncParameterClient(node, node_name)
    if not client.wait_for_services(timeout_sec=READY_SEC):
        return None
    future = client.list_parameters(prefixes=prefixes)
    rclpy.spin_until_future_complete(node, future)
    return future


def get_parameter_type_string(parameter_type: int) -> str:
    """Return the name of a type.

    Raises:
        KeyError: There is no such type.
    """
    return TYPES[parameter_type]


class ParameterNameCompleter:
    """Returns the parameter names of the node given by the argument ``node_name``."""

    def __call__(self, prefix: str, parsed_args: Any, **kwargs: Any) -> list[str]:
        """Return the names."""
        with DirectNode(parsed_args) as node:
            future = call_list_parameters(node=node, node_name=parsed_args.node_name)
            names = [] if future is None else future.result().result.names
        return [name for name in names if name.startswith(prefix or "")]
