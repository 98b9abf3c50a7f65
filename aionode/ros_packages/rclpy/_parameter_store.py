"""The parameters of a node: aionode's store, with rclpy's classes.

A change happens entirely in the calling thread, including its callbacks and its event.
"""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any

from aionode.parameter import ParameterStore
from rclpy._impl import messages as msg
from rclpy._impl.typesupport import type_of
from rclpy.parameter import Parameter
from rosidl_generator_py import decode, encode

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from rclpy.clock import Clock
    from rclpy.publisher import Publisher

__all__ = ["NodeParameterStore", "ParameterEvents"]


class NodeParameterStore(ParameterStore):
    """The parameters of one node, as rclpy keeps them."""

    parameter_class = Parameter
    messages = msg
    type_text = "{0:d}".format

    def tables(self) -> tuple[dict[str, Any], dict[str, Any]]:
        """Return the parameters and their descriptors by name, which programs of rclpy read."""
        return self._parameters, self._descriptors

    def _own_descriptor(self, given: Any, index: int) -> Any:
        """Return a copy of a descriptor, which may be of aionode's class."""
        if type_of(given) == "rcl_interfaces/msg/ParameterDescriptor":
            return decode(msg.ParameterDescriptor, encode(given))
        return super()._own_descriptor(given, index)

    def _prepared(self, parameters: list[Any], descriptors: Mapping[str, Any]) -> list[Any]:
        """Return the given parameters: rclpy sets each of those with the same name."""
        return parameters

    def _checked_result(self, callback: Callable[..., Any], result: Any) -> Any:
        """Return the result of an on-set callback; anything unknown rejects the change."""
        if isinstance(result, msg.SetParametersResult):
            return result
        warnings.warn(
            "Callback returned an invalid type, it should return SetParameterResult.",
            stacklevel=5,
        )
        return self._failure("Callback returned an invalid type")


class ParameterEvents:
    """Publishes changes of parameters.

    Args:
        publisher: Sends the events.
        clock: Their stamps come from it.
    """

    def __init__(self, publisher: Publisher[Any], clock: Clock) -> None:
        self._publisher = publisher
        self._clock = clock

    def __call__(self, event: Any) -> None:
        """Publish one event.

        Raises:
            RCLError: the context is shut down.
        """
        handle = self._publisher.handle
        handle.refuse_after_shutdown("Failed to publish")
        # Each node has one event at its start, when nobody hears it yet: encoding it loads numpy.
        if handle.bare.is_heard():
            event.stamp = self._clock.now().to_msg()
            self._publisher.publish(event)
