"""The parameters of a node: rclpy's methods, over the node's `ParameterStore`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeVar

from aionode.parameter import declare_struct

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from aionode.interfaces.rcl_interfaces.msg import (
        ListParametersResult,
        ParameterDescriptor,
        ParameterValue,
        SetParametersResult,
    )
    from aionode.parameter import (
        OnSetCallback,
        Parameter,
        ParameterStore,
        ParameterType,
        PostSetCallback,
        PreSetCallback,
    )

__all__ = ["NodeParameters"]

StructT = TypeVar("StructT")


class NodeParameters:
    """The part of `Node` that has parameters.

    What each method does, step by step, and what it raises is said in `ParameterStore`.
    """

    _parameters: ParameterStore

    # Declaring

    def declare_parameter(
        self,
        name: str,
        value: Any = None,
        descriptor: ParameterDescriptor | None = None,
        ignore_override: bool = False,  # rclpy's signature
    ) -> Parameter:
        """Declare a parameter and return it, with the value of an override if there is one.

        Args:
            name: Its name.
            value: Its value to begin with, or its type (`Parameter.Type`) if it is to have none.
            descriptor: Description, limits, and whether it is read-only.
            ignore_override: Whether overrides are left aside.

        Raises:
            ParameterAlreadyDeclaredException: it was declared before.
            InvalidParameterException: the name is empty.
            InvalidParameterTypeException: the override is of another type than `value`.
            InvalidParameterValueException: the descriptor or a callback rejects the value.
        """
        return self._parameters.declare_parameter(name, value, descriptor, ignore_override)

    def declare_parameters(
        self,
        namespace: str,
        parameters: Iterable[tuple[Any, ...]],
        ignore_override: bool = False,  # rclpy's signature
    ) -> list[Parameter]:
        """Declare parameters given as ``(name, value or type, descriptor)``, in order."""
        return self._parameters.declare_parameters(namespace, parameters, ignore_override)

    def declare_struct(
        self,
        struct_type: type[StructT],
        prefix: str = "",
        *,
        on_change: Callable[[StructT], None] | None = None,
    ) -> StructT:
        """Declare the fields of a class as parameters; return an instance that is kept current.

        Args:
            struct_type: A `msgspec.Struct` or a dataclass, not frozen; `msgspec.Meta` gives limits
                and descriptions.
            prefix: Put in front of all names, with a dot, unless it is empty.
            on_change: Called with the instance after a change.

        Raises:
            TypeError: a field's type is none that parameters have, or the class is frozen.
            ParameterUninitializedException: a field has neither a default nor an override.
            InvalidParameterValueException: a default or an override is out of its limits.
            ParameterAlreadyDeclaredException: the node has a parameter of one of the names.
        """
        return declare_struct(self, struct_type, prefix, on_change=on_change)

    def undeclare_parameter(self, name: str) -> None:
        """Forget a parameter. Neither callbacks nor an event tell of it."""
        self._parameters.undeclare_parameter(name)

    # Reading

    def has_parameter(self, name: str) -> bool:
        """Whether the parameter is declared."""
        return self._parameters.has_parameter(name)

    def get_parameter(self, name: str) -> Parameter:
        """Return a parameter.

        Raises:
            ParameterNotDeclaredException: it is undeclared, and that is not allowed.
            ParameterUninitializedException: it was declared without a value and never set.
        """
        return self._parameters.get_parameter(name)

    def get_parameters(self, names: Sequence[str]) -> list[Parameter]:
        """Return parameters, as `get_parameter` does each."""
        return self._parameters.get_parameters(names)

    def get_parameter_or(self, name: str, alternative_value: Parameter | None = None) -> Parameter:
        """Return a parameter, or `alternative_value` if it is not set."""
        return self._parameters.get_parameter_or(name, alternative_value)

    def get_parameter_type(self, name: str) -> ParameterType:
        """Return the type of a parameter."""
        return self._parameters.get_parameter_type(name)

    def get_parameter_types(self, names: Sequence[str]) -> list[ParameterType]:
        """Return the types of parameters."""
        return self._parameters.get_parameter_types(names)

    def get_parameters_by_prefix(self, prefix: str) -> dict[str, Parameter]:
        """Return the parameters below `prefix`, by the rest of their names."""
        return self._parameters.get_parameters_by_prefix(prefix)

    def list_parameters(self, prefixes: list[str], depth: int) -> ListParametersResult:
        """Return the names below `prefixes`, at most `depth` dots deep; 0 means any depth."""
        return self._parameters.list_parameters(prefixes, depth)

    def describe_parameter(self, name: str) -> ParameterDescriptor:
        """Return the descriptor of a parameter."""
        return self._parameters.describe_parameter(name)

    def describe_parameters(self, names: Sequence[str]) -> list[ParameterDescriptor]:
        """Return descriptors, as `describe_parameter` does each."""
        return self._parameters.describe_parameters(names)

    # Changing

    def set_parameters(self, parameter_list: Sequence[Parameter]) -> list[SetParametersResult]:
        """Set parameters one by one, and return what became of each.

        Raises:
            ParameterNotDeclaredException: one is undeclared, and that is not allowed; those before
                it are set.
        """
        return self._parameters.set_parameters(parameter_list)

    def set_parameters_atomically(self, parameter_list: Sequence[Parameter]) -> SetParametersResult:
        """Set all parameters or, if one is rejected, none.

        Raises:
            ParameterNotDeclaredException: one is undeclared, and that is not allowed.
        """
        return self._parameters.set_parameters_atomically(parameter_list)

    def set_descriptor(
        self,
        name: str,
        descriptor: ParameterDescriptor,
        alternative_value: ParameterValue | None = None,
    ) -> ParameterValue:
        """Give a parameter another descriptor, and return its value then."""
        return self._parameters.set_descriptor(name, descriptor, alternative_value)

    # Callbacks

    def add_pre_set_parameters_callback(self, callback: PreSetCallback) -> None:
        """Call `callback` before a change is checked: it returns the list to go on with."""
        self._parameters.add_pre_set_parameters_callback(callback)

    def add_on_set_parameters_callback(self, callback: OnSetCallback) -> None:
        """Call `callback` to check a change: the first that rejects it wins."""
        self._parameters.add_on_set_parameters_callback(callback)

    def add_post_set_parameters_callback(self, callback: PostSetCallback) -> None:
        """Call `callback` after a change."""
        self._parameters.add_post_set_parameters_callback(callback)

    def remove_pre_set_parameters_callback(self, callback: PreSetCallback) -> None:
        """Call it no more; a ValueError if it was not added."""
        self._parameters.remove_pre_set_parameters_callback(callback)

    def remove_on_set_parameters_callback(self, callback: OnSetCallback) -> None:
        """Call it no more; a ValueError if it was not added."""
        self._parameters.remove_on_set_parameters_callback(callback)

    def remove_post_set_parameters_callback(self, callback: PostSetCallback) -> None:
        """Call it no more; a ValueError if it was not added."""
        self._parameters.remove_post_set_parameters_callback(callback)
