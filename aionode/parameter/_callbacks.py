"""The parameter callbacks of a node."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from aionode.errors import brief
from aionode.interfaces.rcl_interfaces import msg as rcl_msg
from aionode.interfaces.rcl_interfaces.msg import SetParametersResult
from aionode.parameter._value import Parameter, expect

__all__ = ["OnSetCallback", "ParameterCallbacks", "PostSetCallback", "PreSetCallback"]

PreSetCallback = Callable[[list[Parameter]], list[Parameter]]
OnSetCallback = Callable[[list[Parameter]], SetParametersResult]
PostSetCallback = Callable[[list[Parameter]], None]


class ParameterCallbacks:
    """A node's callbacks for parameter changes; the newest of each kind runs first.

    Attributes:
        messages: The message classes by name; on-set callbacks return its `SetParametersResult`.
    """

    messages: Any = rcl_msg

    def __init__(self) -> None:
        self._pre: list[PreSetCallback] = []
        self._on: list[OnSetCallback] = []
        self._post: list[PostSetCallback] = []

    def add_pre_set_parameters_callback(self, callback: PreSetCallback) -> None:
        """Add a callback that runs before a change is checked, and returns the parameters to set.

        Raises:
            TypeError: it is not callable.
        """
        self._pre.insert(0, expect_callable(callback))

    def add_on_set_parameters_callback(self, callback: OnSetCallback) -> None:
        """Add a callback that checks changes; the first one that rejects a change decides.

        Raises:
            TypeError: it is not callable.
        """
        self._on.insert(0, expect_callable(callback))

    def add_post_set_parameters_callback(self, callback: PostSetCallback) -> None:
        """Add a callback that runs after each change.

        Raises:
            TypeError: it is not callable.
        """
        self._post.insert(0, expect_callable(callback))

    def remove_pre_set_parameters_callback(self, callback: PreSetCallback) -> None:
        """Remove a callback; a ValueError if it was not added."""
        self._pre.remove(callback)

    def remove_on_set_parameters_callback(self, callback: OnSetCallback) -> None:
        """Remove a callback; a ValueError if it was not added."""
        self._on.remove(callback)

    def remove_post_set_parameters_callback(self, callback: PostSetCallback) -> None:
        """Remove a callback; a ValueError if it was not added."""
        self._post.remove(callback)

    def _modified(self, parameters: list[Parameter]) -> list[Parameter]:
        # As in rclpy, each callback gets the original list, and the results are concatenated.
        if not self._pre:
            return parameters
        result: list[Parameter] = []
        for callback in self._pre:
            returned = callback(parameters)
            expect(returned, Iterable, f"what the pre-set callback {callback!r} returns")
            result.extend(returned)
        return result

    def _rejection(self, parameters: list[Parameter]) -> SetParametersResult | None:
        for callback in self._on:
            result = self._checked_result(callback, callback(parameters))
            if not result.successful:
                return result
        return None

    def _checked_result(self, callback: OnSetCallback, result: Any) -> SetParametersResult:
        """Return the result of an on-set callback, checked.

        Raises:
            TypeError: it is not a `SetParametersResult`.
        """
        wanted = self.messages.SetParametersResult
        expect(result, wanted, f"what the on-set callback {callback!r} returns")
        checked: SetParametersResult = result
        return checked


def expect_callable(callback: Any) -> Any:
    """Return `callback` if it is callable.

    Raises:
        TypeError: it is not callable.
    """
    if not callable(callback):
        raise TypeError(f"Callback must be callable, got {brief(callback)}")
    return callback
