"""The parameter methods of nodes, shared by aionode's and rclpy's."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeVar, overload

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from aionode.interfaces.rcl_interfaces.msg import (
        ListParametersResult,
        ParameterDescriptor,
        ParameterValue,
        SetParametersResult,
    )
    from aionode.parameter._callbacks import OnSetCallback, PostSetCallback, PreSetCallback
    from aionode.parameter._store import ParameterStore
    from aionode.parameter._value import Parameter, ParameterType

__all__ = ["ParameterMethods"]

ScalarT = TypeVar("ScalarT", bool, int, float, str)
"""A value whose type type checkers know; bool comes first, since it is an int to them."""


class ParameterMethods:
    """Methods that delegate to a `ParameterStore`, where each step and exception is described."""

    def __init__(self, store: ParameterStore) -> None:
        self.__store = store

    # Declaring

    @overload
    def declare_parameter(
        self,
        name: str,
        value: ParameterType | None = None,
        descriptor: ParameterDescriptor | None = None,
        ignore_override: bool = False,
    ) -> Parameter: ...
    @overload
    def declare_parameter(
        self,
        name: str,
        value: ScalarT,
        descriptor: ParameterDescriptor | None = None,
        ignore_override: bool = False,
    ) -> Parameter[ScalarT]: ...
    @overload
    def declare_parameter(
        self,
        name: str,
        value: Any = None,
        descriptor: ParameterDescriptor | None = None,
        ignore_override: bool = False,
    ) -> Parameter: ...
    def declare_parameter(
        self,
        name: str,
        value: Any = None,
        descriptor: ParameterDescriptor | None = None,
        ignore_override: bool = False,  # rclpy's signature
    ) -> Parameter:
        """Declare a parameter and return it; an override takes precedence over `value`.

        Args:
            name: Its name.
            value: Its initial value, or its type (`Parameter.Type`) to declare it without a value.
            descriptor: Description, range, and whether it is read-only.
            ignore_override: Whether to ignore overrides.

        Raises:
            ParameterAlreadyDeclaredException: the parameter is already declared.
            InvalidParameterException: the name is empty.
            InvalidParameterTypeException: the override is of another type than `value`.
            InvalidParameterValueException: the descriptor or a callback rejects the value.
        """
        return self.__store.declare_parameter(name, value, descriptor, ignore_override)

    def declare_parameters(
        self,
        namespace: str,
        parameters: Iterable[tuple[Any, ...]],
        ignore_override: bool = False,  # rclpy's signature
    ) -> list[Parameter]:
        """Declare parameters, each given as ``(name, value or type, descriptor)``, in order."""
        return self.__store.declare_parameters(namespace, parameters, ignore_override)

    def undeclare_parameter(self, name: str) -> None:
        """Remove a parameter. No callback is called and no event is published."""
        self.__store.undeclare_parameter(name)

    # Reading

    def has_parameter(self, name: str) -> bool:
        """Whether the parameter is declared."""
        return self.__store.has_parameter(name)

    def get_parameter(self, name: str) -> Parameter:
        """Return a parameter.

        Raises:
            ParameterNotDeclaredException: it is undeclared, and undeclared parameters are not
                allowed.
            ParameterUninitializedException: it was declared without a value and has never been set.
        """
        return self.__store.get_parameter(name)

    def get_parameters(self, names: Sequence[str]) -> list[Parameter]:
        """Return several parameters; see `get_parameter`."""
        return self.__store.get_parameters(names)

    def get_parameter_or(self, name: str, alternative_value: Parameter | None = None) -> Parameter:
        """Return a parameter, or `alternative_value` if it is undeclared or has no value."""
        return self.__store.get_parameter_or(name, alternative_value)

    def get_parameter_type(self, name: str) -> ParameterType:
        """Return the type of a parameter."""
        return self.__store.get_parameter_type(name)

    def get_parameter_types(self, names: Sequence[str]) -> list[ParameterType]:
        """Return the types of several parameters."""
        return self.__store.get_parameter_types(names)

    def get_parameters_by_prefix(self, prefix: str) -> dict[str, Parameter]:
        """Return the parameters below `prefix`, keyed by their names without the prefix."""
        return self.__store.get_parameters_by_prefix(prefix)

    def list_parameters(self, prefixes: list[str], depth: int) -> ListParametersResult:
        """Return the names below `prefixes`, at most `depth` dots deep; 0 means any depth."""
        return self.__store.list_parameters(prefixes, depth)

    def describe_parameter(self, name: str) -> ParameterDescriptor:
        """Return the descriptor of a parameter."""
        return self.__store.describe_parameter(name)

    def describe_parameters(self, names: Sequence[str]) -> list[ParameterDescriptor]:
        """Return the descriptors of several parameters."""
        return self.__store.describe_parameters(names)

    # Changing

    def set_parameters(self, parameter_list: Sequence[Parameter]) -> list[SetParametersResult]:
        """Set parameters one by one, and return a result for each.

        Raises:
            ParameterNotDeclaredException: one is undeclared, and undeclared parameters are not
                allowed; those before it are set.
        """
        return self.__store.set_parameters(parameter_list)

    def set_parameters_atomically(self, parameter_list: Sequence[Parameter]) -> SetParametersResult:
        """Set all parameters, or none if one is rejected.

        Raises:
            ParameterNotDeclaredException: one is undeclared, and undeclared parameters are not
                allowed.
        """
        return self.__store.set_parameters_atomically(parameter_list)

    def set_descriptor(
        self,
        name: str,
        descriptor: ParameterDescriptor,
        alternative_value: ParameterValue | None = None,
    ) -> ParameterValue:
        """Replace the descriptor of a parameter, and return its resulting value."""
        return self.__store.set_descriptor(name, descriptor, alternative_value)

    # Callbacks

    def add_pre_set_parameters_callback(self, callback: PreSetCallback) -> None:
        """Add a callback that runs before a change is checked and returns what to set."""
        self.__store.callbacks.add_pre_set_parameters_callback(callback)

    def add_on_set_parameters_callback(self, callback: OnSetCallback) -> None:
        """Add a callback that checks changes; the first one that rejects a change decides."""
        self.__store.callbacks.add_on_set_parameters_callback(callback)

    def add_post_set_parameters_callback(self, callback: PostSetCallback) -> None:
        """Add a callback that runs after each change."""
        self.__store.callbacks.add_post_set_parameters_callback(callback)

    def remove_pre_set_parameters_callback(self, callback: PreSetCallback) -> None:
        """Remove a callback; a ValueError if it was not added."""
        self.__store.callbacks.remove_pre_set_parameters_callback(callback)

    def remove_on_set_parameters_callback(self, callback: OnSetCallback) -> None:
        """Remove a callback; a ValueError if it was not added."""
        self.__store.callbacks.remove_on_set_parameters_callback(callback)

    def remove_post_set_parameters_callback(self, callback: PostSetCallback) -> None:
        """Remove a callback; a ValueError if it was not added."""
        self.__store.callbacks.remove_post_set_parameters_callback(callback)
