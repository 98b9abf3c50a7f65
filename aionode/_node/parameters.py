"""The parameters of a node: declared, read and changed, and the overrides they begin with.

Whether a new value is accepted is decided in `aionode/parameter/_store.py`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeVar

from aionode._node.base import NodeBase
from aionode.parameter import Parameter, ParameterStore, declare_struct

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from aionode.engine.context import Context
    from aionode.interfaces.rcl_interfaces.msg import (
        ListParametersResult,
        ParameterDescriptor,
        ParameterValue,
        SetParametersResult,
    )
    from aionode.parameter import (
        OnSetCallback,
        ParameterType,
        PostSetCallback,
        PreSetCallback,
    )

__all__ = ["NodeParameters", "ParameterMethods"]

StructT = TypeVar("StructT")


class ParameterMethods:
    """The methods of a node over its `ParameterStore`, which describes each step and exception."""

    _Node__parameter_store: ParameterStore

    # Declaring

    def declare_parameter(
        self,
        name: str,
        value: Any = None,
        descriptor: ParameterDescriptor | None = None,
        ignore_override: bool = False,  # rclpy's signature
    ) -> Parameter:
        """Declare a parameter and return it; an override of its name gives the value.

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
        return self._Node__parameter_store.declare_parameter(
            name, value, descriptor, ignore_override
        )

    def declare_parameters(
        self,
        namespace: str,
        parameters: Iterable[tuple[Any, ...]],
        ignore_override: bool = False,  # rclpy's signature
    ) -> list[Parameter]:
        """Declare parameters, each given as ``(name, value or type, descriptor)``, in order."""
        return self._Node__parameter_store.declare_parameters(
            namespace, parameters, ignore_override
        )

    def undeclare_parameter(self, name: str) -> None:
        """Remove a parameter. No callback is called and no event is published."""
        self._Node__parameter_store.undeclare_parameter(name)

    # Reading

    def has_parameter(self, name: str) -> bool:
        """Whether the parameter is declared."""
        return self._Node__parameter_store.has_parameter(name)

    def get_parameter(self, name: str) -> Parameter:
        """Return a parameter.

        Raises:
            ParameterNotDeclaredException: it is undeclared, and undeclared parameters are not
                allowed.
            ParameterUninitializedException: it was declared without a value and never set.
        """
        return self._Node__parameter_store.get_parameter(name)

    def get_parameters(self, names: Sequence[str]) -> list[Parameter]:
        """Return several parameters; see `get_parameter`."""
        return self._Node__parameter_store.get_parameters(names)

    def get_parameter_or(self, name: str, alternative_value: Parameter | None = None) -> Parameter:
        """Return a parameter, or `alternative_value` if it is undeclared or not set."""
        return self._Node__parameter_store.get_parameter_or(name, alternative_value)

    def get_parameter_type(self, name: str) -> ParameterType:
        """Return the type of a parameter."""
        return self._Node__parameter_store.get_parameter_type(name)

    def get_parameter_types(self, names: Sequence[str]) -> list[ParameterType]:
        """Return the types of several parameters."""
        return self._Node__parameter_store.get_parameter_types(names)

    def get_parameters_by_prefix(self, prefix: str) -> dict[str, Parameter]:
        """Return the parameters below `prefix`, keyed by the rest of their names."""
        return self._Node__parameter_store.get_parameters_by_prefix(prefix)

    def list_parameters(self, prefixes: list[str], depth: int) -> ListParametersResult:
        """Return the names below `prefixes`, at most `depth` dots deep; 0 means any depth."""
        return self._Node__parameter_store.list_parameters(prefixes, depth)

    def describe_parameter(self, name: str) -> ParameterDescriptor:
        """Return the descriptor of a parameter."""
        return self._Node__parameter_store.describe_parameter(name)

    def describe_parameters(self, names: Sequence[str]) -> list[ParameterDescriptor]:
        """Return the descriptors of several parameters."""
        return self._Node__parameter_store.describe_parameters(names)

    # Changing

    def set_parameters(self, parameter_list: Sequence[Parameter]) -> list[SetParametersResult]:
        """Set parameters one by one, and return a result for each.

        Raises:
            ParameterNotDeclaredException: one is undeclared, and undeclared parameters are not
                allowed; those before it are set.
        """
        return self._Node__parameter_store.set_parameters(parameter_list)

    def set_parameters_atomically(self, parameter_list: Sequence[Parameter]) -> SetParametersResult:
        """Set all parameters, or none if one is rejected.

        Raises:
            ParameterNotDeclaredException: one is undeclared, and undeclared parameters are not
                allowed.
        """
        return self._Node__parameter_store.set_parameters_atomically(parameter_list)

    def set_descriptor(
        self,
        name: str,
        descriptor: ParameterDescriptor,
        alternative_value: ParameterValue | None = None,
    ) -> ParameterValue:
        """Replace the descriptor of a parameter, and return its resulting value."""
        return self._Node__parameter_store.set_descriptor(name, descriptor, alternative_value)

    # Callbacks

    def add_pre_set_parameters_callback(self, callback: PreSetCallback) -> None:
        """Call `callback` before a change is checked; it returns the parameters to set instead."""
        self._Node__parameter_store.add_pre_set_parameters_callback(callback)

    def add_on_set_parameters_callback(self, callback: OnSetCallback) -> None:
        """Call `callback` to check a change; the first that rejects it decides."""
        self._Node__parameter_store.add_on_set_parameters_callback(callback)

    def add_post_set_parameters_callback(self, callback: PostSetCallback) -> None:
        """Call `callback` after a change."""
        self._Node__parameter_store.add_post_set_parameters_callback(callback)

    def remove_pre_set_parameters_callback(self, callback: PreSetCallback) -> None:
        """Remove a callback; a ValueError if it was not added."""
        self._Node__parameter_store.remove_pre_set_parameters_callback(callback)

    def remove_on_set_parameters_callback(self, callback: OnSetCallback) -> None:
        """Remove a callback; a ValueError if it was not added."""
        self._Node__parameter_store.remove_on_set_parameters_callback(callback)

    def remove_post_set_parameters_callback(self, callback: PostSetCallback) -> None:
        """Remove a callback; a ValueError if it was not added."""
        self._Node__parameter_store.remove_post_set_parameters_callback(callback)


class NodeParameters(ParameterMethods, NodeBase):
    """The part of `aionode.Node` that has parameters."""

    def __init__(
        self,
        node_name: str,
        namespace: str,
        context: Context,
        cli_args: Sequence[str] | None,
        *,
        use_global_arguments: bool,
        callback_budget_ms: float,
        parameter_overrides: Sequence[Parameter],
        allow_undeclared_parameters: bool,
    ) -> None:
        super().__init__(
            node_name,
            namespace,
            context,
            cli_args,
            use_global_arguments=use_global_arguments,
            callback_budget_ms=callback_budget_ms,
        )
        full_name = self.get_fully_qualified_name()
        self._Node__parameter_store = ParameterStore(
            full_name,
            overrides=[  # the last value of a name wins
                *parameters_from(self._Node__shared_arguments.parameters_for(full_name)),
                *parameters_from(self._Node__own_arguments.parameters_for(full_name)),
                *parameter_overrides,
            ],
            allow_undeclared=allow_undeclared_parameters,
        )

    def declare_struct(
        self,
        struct_type: type[StructT],
        prefix: str = "",
        *,
        on_change: Callable[[StructT], None] | None = None,
    ) -> StructT:
        """Declare the fields of a class as parameters; return an instance that follows them.

        Args:
            struct_type: A `msgspec.Struct` or dataclass that is not frozen; `msgspec.Meta` gives
                ranges and descriptions.
            prefix: Prepended to all names, with a dot, unless it is empty.
            on_change: Called with the instance after each change.

        Raises:
            TypeError: a field has a type that parameters do not have, or the class is frozen.
            ParameterUninitializedException: a field has neither a default nor an override.
            InvalidParameterValueException: a default or an override is out of range.
            ParameterAlreadyDeclaredException: one of the names is already declared.
        """
        return declare_struct(self, struct_type, prefix, on_change=on_change)


def parameters_from(values: Mapping[str, object]) -> list[Parameter]:
    """Return plain values as parameters."""
    return [Parameter(name, value=value) for name, value in values.items()]
