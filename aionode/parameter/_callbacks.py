"""The parameter callbacks of a node."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from aionode.errors import brief
from aionode.interfaces.rcl_interfaces.msg import SetParametersResult
from aionode.parameter._value import Parameter, expect

__all__ = ["OnSetCallback", "ParameterCallbacks", "PostSetCallback", "PreSetCallback"]

PreSetCallback = Callable[[list[Parameter]], list[Parameter]]
OnSetCallback = Callable[[list[Parameter]], SetParametersResult]
PostSetCallback = Callable[[list[Parameter]], None]


class ParameterCallbacks:
    """A node's callbacks for parameter changes; the newest of each kind runs first.

    Attributes:
        pre: The callbacks that run before a change is checked.
        on: The callbacks that check it.
        post: The callbacks that run after it.
    """

    def __init__(self) -> None:
        self.pre: list[PreSetCallback] = []
        self.on: list[OnSetCallback] = []
        self.post: list[PostSetCallback] = []

    def add_pre_set_parameters_callback(self, callback: PreSetCallback) -> None:
        """Add a callback that runs before a change is checked, and returns the parameters to set.

        Raises:
            TypeError: it is not callable.
        """
        self.pre.insert(0, expect_callable(callback))

    def add_on_set_parameters_callback(self, callback: OnSetCallback) -> None:
        """Add a callback that checks changes; the first one that rejects a change decides.

        Raises:
            TypeError: it is not callable.
        """
        self.on.insert(0, expect_callable(callback))

    def add_post_set_parameters_callback(self, callback: PostSetCallback) -> None:
        """Add a callback that runs after each change.

        Raises:
            TypeError: it is not callable.
        """
        self.post.insert(0, expect_callable(callback))

    def remove_pre_set_parameters_callback(self, callback: PreSetCallback) -> None:
        """Remove a callback; a ValueError if it was not added."""
        self.pre.remove(callback)

    def remove_on_set_parameters_callback(self, callback: OnSetCallback) -> None:
        """Remove a callback; a ValueError if it was not added."""
        self.on.remove(callback)

    def remove_post_set_parameters_callback(self, callback: PostSetCallback) -> None:
        """Remove a callback; a ValueError if it was not added."""
        self.post.remove(callback)

    def modified(self, parameters: list[Parameter]) -> list[Parameter]:
        """Return the parameters to set after all pre-set callbacks.

        Raises:
            TypeError: one of them returns no list.
        """
        # As in rclpy, each callback gets the original list, and the results are concatenated.
        if not self.pre:
            return parameters
        result: list[Parameter] = []
        for callback in self.pre:
            returned = callback(parameters)
            expect(returned, Iterable, f"what the pre-set callback {callback!r} returns")
            result.extend(returned)
        return result


def expect_callable(callback: Any) -> Any:
    """Return `callback` if it is callable.

    Raises:
        TypeError: it is not callable.
    """
    if not callable(callback):
        raise TypeError(f"Callback must be callable, got {brief(callback)}")
    return callback
