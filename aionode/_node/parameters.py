"""The parameters of a node: the overrides they begin with, and parameters as a class."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

from aionode._node.base import NodeBase
from aionode._node.parameter_methods import ParameterMethods
from aionode.parameter import Parameter, ParameterStore, declare_struct

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from aionode.context import Context

__all__ = ["NodeParameters"]

StructT = TypeVar("StructT")


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
        self._parameter_store = ParameterStore(
            full_name,
            overrides=[  # the last value of a name wins
                *parameters_from(self._shared_arguments.parameters_for(full_name)),
                *parameters_from(self._own_arguments.parameters_for(full_name)),
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
