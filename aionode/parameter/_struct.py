"""Parameters declared by a class: fields with types, defaults and limits, kept up to date.

::

    class Driving(msgspec.Struct):
        frame: str = "base_link"
        speed: Annotated[float, Meta(ge=0.0, le=2.0, description="in m/s")] = 0.5
        mode: Literal["manual", "auto"] = "manual"

    driving = node.declare_struct(Driving)
    driving.speed       # 0.5, or what an override or another node has set it to
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Iterator
from typing import Any, Protocol, TypeVar, get_type_hints

import msgspec
from msgspec import Struct, inspect

from aionode.interfaces.rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
    SetParametersResult,
)
from aionode.parameter._callbacks import OnSetCallback, PostSetCallback
from aionode.parameter._value import PARAMETER_SEPARATOR_STRING, Parameter, ParameterType

__all__ = ["ParameterOwner", "declare_struct"]

StructT = TypeVar("StructT")

INT_MIN, INT_MAX = -(2**63), 2**63 - 1
FLOAT_MAX = sys.float_info.max


class ParameterOwner(Protocol):
    """A node, or another object that declares parameters like one."""

    def declare_parameter(
        self, name: str, value: Any, descriptor: ParameterDescriptor
    ) -> Parameter:
        """Declare a parameter."""

    def get_parameter(self, name: str) -> Parameter:
        """Return a parameter; raise if it has no value."""

    def add_on_set_parameters_callback(self, callback: OnSetCallback) -> None:
        """Check changes with `callback`."""

    def remove_on_set_parameters_callback(self, callback: OnSetCallback) -> None:
        """Stop checking changes with `callback`."""

    def add_post_set_parameters_callback(self, callback: PostSetCallback) -> None:
        """Report changes to `callback`."""


class Leaf(Struct, frozen=True):
    """One parameter of a class.

    Attributes:
        name: Name of the parameter.
        owner: The instance, perhaps nested in another, that holds it.
        attribute: Name of the field there.
        hint: Its annotation, limits included.
        kind: The annotation as a msgspec type, without None and metadata.
        type_: The parameter's type.
        is_optional: Whether it may be None, that is, have no value.
        has_default: Whether it is declared with a value.
        descriptor: Its descriptor.
    """

    name: str
    owner: object
    attribute: str
    hint: Any
    kind: inspect.Type
    type_: ParameterType
    is_optional: bool
    has_default: bool
    descriptor: ParameterDescriptor

    def problem(self, value: object) -> str | None:
        """Return the reason why a value violates the annotation, or None."""
        if isinstance(self.kind, inspect.IntType | inspect.FloatType):
            return open_end_problem(self.kind, value)  # the descriptor checks the rest
        try:
            self.from_ros(value)
        except msgspec.ValidationError as error:
            return str(error)
        return None

    def from_ros(self, value: Any) -> object:
        """Convert a parameter's value to the type of the field."""
        if self.type_ is ParameterType.BYTE_ARRAY and not isinstance(value, bytes):
            value = b"".join(value)
        if isinstance(self.kind, inspect.IntType | inspect.FloatType):
            return value
        return msgspec.convert(value, self.hint)

    def to_ros(self) -> Any:
        """Convert the field's value to the type of the parameter."""
        value = getattr(self.owner, self.attribute)
        if isinstance(self.kind, inspect.FloatType):
            return float(value)
        plain = msgspec.to_builtins(value, builtin_types=(bytes,))
        if plain == []:
            return Parameter(self.name, self.type_, [])
        return plain

    def write(self, value: object) -> None:
        """Set the field from a parameter's value."""
        setattr(self.owner, self.attribute, None if value is None else self.from_ros(value))


def declare_struct(
    owner: ParameterOwner,
    struct_type: type[StructT],
    prefix: str = "",
    *,
    on_change: Callable[[StructT], None] | None = None,
) -> StructT:
    """Declare the fields of a class as parameters, and return an instance that is kept up to date.

    A field becomes a parameter with the field's name, type and default, and with limits (``ge``,
    ``le``, ``gt``, ``lt``, ``multiple_of``) and description from `msgspec.Meta`. A field without a
    default needs an override. ``X | None = None`` may stay without a value. `Literal` and `Enum`
    allow only their values. ``Meta(extra={"read_only": True})`` makes a parameter read-only. A
    field that is itself such a class becomes a group: ``group.name``.

    When a parameter changes, so does the field, before `on_change` is called.

    Args:
        owner: The node.
        struct_type: A `msgspec.Struct` or a dataclass, which must not be frozen.
        prefix: Prepended to all names, with a dot, unless it is empty.
        on_change: Called with the instance after a change.

    Raises:
        TypeError: A field has a type that no parameter can have, or the class is frozen.
        ParameterUninitializedException: A field has neither a default nor an override.
        InvalidParameterValueException: A default or an override is outside its limits.
        ParameterAlreadyDeclaredException: The node already has a parameter of one of the names.
    """
    instance = blank(struct_type)
    start = f"{prefix}{PARAMETER_SEPARATOR_STRING}" if prefix else ""
    leaves = {leaf.name: leaf for leaf in leaves_of(instance, start)}

    def check(parameters: list[Parameter]) -> SetParametersResult:
        for parameter in parameters:
            leaf = leaves.get(parameter.name)
            if leaf is None or parameter.type_ is ParameterType.NOT_SET:
                continue
            if problem := leaf.problem(parameter.value):
                reason = f"Parameter {parameter.name}: {problem}, value: {parameter.value}"
                return SetParametersResult(successful=False, reason=reason)
        return SetParametersResult(successful=True, reason="")

    def update(parameters: list[Parameter]) -> None:
        ours = [parameter for parameter in parameters if parameter.name in leaves]
        for parameter in ours:
            leaves[parameter.name].write(parameter.value)
        if ours and on_change is not None:
            on_change(instance)

    owner.add_on_set_parameters_callback(check)
    try:
        for leaf in leaves.values():
            declare_leaf(owner, leaf)
    except BaseException:
        owner.remove_on_set_parameters_callback(check)
        raise
    owner.add_post_set_parameters_callback(update)
    return instance


def declare_leaf(owner: ParameterOwner, leaf: Leaf) -> None:
    """Declare one parameter, and copy its value to the field."""
    value = leaf.to_ros() if leaf.has_default else leaf.type_
    if isinstance(value, Parameter):
        value = value.get_parameter_value()  # an empty list with a known type
    parameter = owner.declare_parameter(leaf.name, value, leaf.descriptor)
    if not leaf.is_optional:
        parameter = owner.get_parameter(leaf.name)  # raises if it has no value
    leaf.write(parameter.value)


def blank(struct_type: type[StructT]) -> StructT:
    """Return an instance in which fields without a default are None.

    Raises:
        TypeError: It is not a class with fields, or its instances cannot be changed.
    """
    info = inspect.type_info(struct_type)
    if not isinstance(info, inspect.StructType | inspect.DataclassType):
        message = f"{struct_type!r} must be a msgspec.Struct or a dataclass"
        raise TypeError(message)
    frozen = (
        struct_type.__struct_config__.frozen  # type: ignore[attr-defined]  # of a Struct
        if isinstance(info, inspect.StructType)
        else struct_type.__dataclass_params__.frozen  # type: ignore[attr-defined]  # of a dataclass
    )
    if frozen:
        message = f"{struct_type.__name__} is frozen, so it cannot be kept current"
        raise TypeError(message)
    missing = {field.name: None for field in info.fields if field.required}
    for field in info.fields:
        kind = unwrapped(field.type)[0]
        if field.required and isinstance(kind, inspect.StructType | inspect.DataclassType):
            missing[field.name] = blank(kind.cls)
    return struct_type(**missing)


def leaves_of(instance: object, prefix: str) -> Iterator[Leaf]:
    """Return the parameters of an instance and of its nested instances."""
    info = inspect.type_info(type(instance))
    assert isinstance(info, inspect.StructType | inspect.DataclassType)  # noqa: S101 - by blank
    hints = get_type_hints(type(instance), include_extras=True)
    for field in info.fields:
        name = prefix + field.encode_name
        kind, is_optional, metas = unwrapped(field.type)
        value = getattr(instance, field.name)
        if isinstance(kind, inspect.StructType | inspect.DataclassType):
            yield from leaves_of(value, name + PARAMETER_SEPARATOR_STRING)
            continue
        type_ = parameter_type(kind, f"{type(instance).__name__}.{field.name}")
        yield Leaf(
            name=name,
            owner=instance,
            attribute=field.name,
            hint=hints[field.name],
            kind=kind,
            type_=type_,
            is_optional=is_optional,
            has_default=value is not None,
            descriptor=descriptor_of(kind, metas),
        )


def unwrapped(kind: inspect.Type) -> tuple[inspect.Type, bool, list[inspect.Metadata]]:
    """Strip None and metadata from a type; return it, whether it had None, and the metadata."""
    is_optional = False
    metas: list[inspect.Metadata] = []
    while isinstance(kind, inspect.Metadata | inspect.UnionType):
        if isinstance(kind, inspect.Metadata):
            metas.append(kind)
            kind = kind.type
            continue
        others = [type_ for type_ in kind.types if not isinstance(type_, inspect.NoneType)]
        if len(others) != 1 or len(others) == len(kind.types):
            break
        is_optional = True
        kind = others[0]
    return kind, is_optional, metas


SINGLE: dict[type[inspect.Type], ParameterType] = {
    inspect.BoolType: ParameterType.BOOL,
    inspect.IntType: ParameterType.INTEGER,
    inspect.FloatType: ParameterType.DOUBLE,
    inspect.StrType: ParameterType.STRING,
    inspect.BytesType: ParameterType.BYTE_ARRAY,
}
LISTS: dict[ParameterType, ParameterType] = {
    ParameterType.BOOL: ParameterType.BOOL_ARRAY,
    ParameterType.INTEGER: ParameterType.INTEGER_ARRAY,
    ParameterType.DOUBLE: ParameterType.DOUBLE_ARRAY,
    ParameterType.STRING: ParameterType.STRING_ARRAY,
}


def parameter_type(kind: inspect.Type, where: str) -> ParameterType:
    """Return the parameter type for a field.

    Raises:
        TypeError: There is no such parameter type.
    """
    type_: ParameterType | None = SINGLE.get(type(kind))
    if isinstance(kind, inspect.LiteralType | inspect.EnumType):
        types = {ParameterType.from_parameter_value(choice) for choice in choices(kind)}
        type_ = types.pop() if len(types) == 1 else None
    elif isinstance(kind, inspect.ListType | inspect.VarTupleType):
        element = unwrapped(kind.item_type)[0]
        type_ = LISTS.get(parameter_type(element, where))
    if type_ is None:
        message = (
            f"{where}: no parameter holds {kind!r}; fields may be bool, int, float, str, bytes, "
            "lists of the first four, a Literal or Enum of one of them, or another such class"
        )
        raise TypeError(message)
    return type_


def choices(kind: inspect.LiteralType | inspect.EnumType) -> list[Any]:
    """Return the values that a field allows."""
    if isinstance(kind, inspect.LiteralType):
        return list(kind.values)
    return [member.value for member in kind.cls]


def descriptor_of(kind: inspect.Type, metas: Iterable[inspect.Metadata]) -> ParameterDescriptor:
    """Return the descriptor for a field's annotation."""
    descriptor = ParameterDescriptor()
    for meta in metas:
        schema, extra = meta.extra_json_schema or {}, meta.extra or {}
        descriptor.description = schema.get("description", descriptor.description)
        descriptor.read_only = extra.get("read_only", descriptor.read_only)
    if isinstance(kind, inspect.LiteralType | inspect.EnumType):
        words = ", ".join(str(choice) for choice in choices(kind))
        descriptor.additional_constraints = f"one of {words}"
    elif isinstance(kind, inspect.IntType) and is_limited(kind):
        descriptor.integer_range = [integer_range(kind)]
    elif isinstance(kind, inspect.FloatType) and is_limited(kind):
        descriptor.floating_point_range = [float_range(kind)]
    return descriptor


def is_limited(kind: inspect.IntType | inspect.FloatType) -> bool:
    """Return whether an annotation limits a number."""
    limits = (kind.ge, kind.gt, kind.le, kind.lt, kind.multiple_of)
    return any(limit is not None for limit in limits)


def integer_range(kind: inspect.IntType) -> IntegerRange:
    """Return the range of an int."""
    step = kind.multiple_of or 0
    low = kind.ge if kind.ge is not None else INT_MIN if kind.gt is None else kind.gt + 1
    high = kind.le if kind.le is not None else INT_MAX if kind.lt is None else kind.lt - 1
    if step:  # msgspec counts multiples from 0, a range from its lower end
        low, high = -(-low // step) * step, high // step * step
    return IntegerRange(from_value=low, to_value=high, step=step)


def float_range(kind: inspect.FloatType) -> FloatingPointRange:
    """Return the range of a float; open ends are checked by `open_end_problem`.

    Raises:
        TypeError: It has steps, but no lower end to count from.
    """
    step = kind.multiple_of or 0.0
    low = kind.ge if kind.ge is not None else kind.gt
    high = kind.le if kind.le is not None else kind.lt
    if step and low is None:
        message = "multiple_of needs ge, too: the steps of a parameter are counted from there"
        raise TypeError(message)
    return FloatingPointRange(
        from_value=-FLOAT_MAX if low is None else float(low),
        to_value=FLOAT_MAX if high is None else float(high),
        step=float(step),
    )


def open_end_problem(kind: inspect.IntType | inspect.FloatType, value: Any) -> str | None:
    """Return the reason why a number violates an open end of its range, or None."""
    if kind.gt is not None and not value > kind.gt:
        return f"must be > {kind.gt}"
    if kind.lt is not None and not value < kind.lt:
        return f"must be < {kind.lt}"
    return None
