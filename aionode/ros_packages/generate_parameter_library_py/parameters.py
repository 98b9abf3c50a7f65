"""The classes that generate_parameter_library would generate from a YAML file, without a build."""

from __future__ import annotations

import copy
import sys
from collections.abc import Callable, Iterator
from importlib import import_module
from itertools import product
from pathlib import Path
from typing import Any, Final, NamedTuple, Self

from rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
    SetParametersResult,
)
from yaml import YAMLError

from aionode._process.bounded_yaml import loaded_yaml
from generate_parameter_library_py.python_validators import ParameterValidators
from rclpy.clock import Clock
from rclpy.exceptions import InvalidParameterValueException
from rclpy.logging import get_logger
from rclpy.parameter import Parameter
from rclpy.time import Time

__all__ = ["Listener", "Struct", "classes_of"]

Tree = dict[str, "Field | Tree"]
"""A struct: its fields and structs by name; ``__map_X`` is the struct of each entry of X."""

MAP: Final = "__map_"
TYPES: Final = {
    "bool": bool,
    "int": int,
    "double": float,
    "string": str,
}
KEYS: Final = {
    "type",
    "default_value",
    "description",
    "read_only",
    "additional_constraints",
    "validation",
}
INT_LIMITS: Final = (-(2**31) - 1, 2**31 - 1)
"""The default bounds of an integer that is bounded on one side only, as in the original."""


class Field(NamedTuple):
    """A parameter.

    Attributes:
        kind: Its type.
        default: Its value until one is set; None if one has to be set.
        descriptor: The descriptor with which it is declared.
        checks: Functions that take a parameter and return what is wrong with it.
    """

    kind: Any
    default: Any
    descriptor: Any
    checks: tuple[Callable[[Any], str], ...]

    def wrong(self, parameter: Any) -> str:
        """Return what is wrong with a value; an empty text if nothing is."""
        return next(filter(None, (check(parameter) for check in self.checks)), "")


class Struct:
    """Parameters and nested structs as attributes; the base of the class ``Params``."""

    _tree: Tree

    def __init__(self, tree: Tree | None = None) -> None:
        if tree is not None:
            self._tree = tree
        for name, part in self._tree.items():
            if name.startswith(MAP):
                continue
            value = copy.copy(part.default) if isinstance(part, Field) else Struct(part)
            setattr(self, name, value)

    def add_entry(self, name: str) -> Any:
        """Return the struct of an entry of a map, which is created if it is missing."""
        if not hasattr(self, name):
            inner = next(part for key, part in self._tree.items() if key.startswith(MAP))
            setattr(self, name, Struct(inner if isinstance(inner, dict) else {}))
        return getattr(self, name)

    def get_entry(self, name: str) -> Any:
        """Return the struct of an entry of a map."""
        return getattr(self, name)

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        copied = type(self).__new__(type(self))
        for name, value in vars(self).items():
            vars(copied)[name] = value if name == "_tree" else copy.deepcopy(value, memo)
        return copied


class Listener:
    """Declares the parameters of a node and follows their changes; the base of ``ParamListener``.

    Args:
        node: The node.
        prefix: The prefix of the names of the parameters.

    Raises:
        InvalidParameterValueException: A value is not valid.
        ParameterUninitializedException: A value is missing.
    """

    _params_class: type[Struct]
    _namespace: str

    def __init__(self, node: Any, prefix: str = "") -> None:
        self.prefix_ = prefix
        self.params_: Any = self._params_class()
        self.node_ = node
        self.logger_ = get_logger(f"{self._namespace}.{prefix}")
        self.user_callback: Callable[[Any], Any] | None = None
        self.clock_ = Clock()
        self.declare_params()
        node.add_on_set_parameters_callback(self.update)

    def get_params(self) -> Any:
        """Return the current parameters."""
        return copy.deepcopy(self.params_)

    def is_old(self, other_param: Any) -> bool:
        """Return whether parameters have changed since they were last read."""
        return bool(self.params_.stamp_ != other_param.stamp_)

    def unpack_parameter_dict(self, namespace: str, parameter_dict: dict[str, Any]) -> list[Any]:
        """Return the parameters in a dict of dicts.

        Args:
            namespace: The prefix of their names.
            parameter_dict: The dict.
        """
        parameters = []
        for name, value in parameter_dict.items():
            if isinstance(value, dict):
                parameters += self.unpack_parameter_dict(f"{namespace}{name}.", value)
            else:
                parameters.append(Parameter(namespace + name, value=value))
        return parameters

    def set_params_from_dict(self, param_dict: dict[str, Any]) -> None:
        """Set the parameters here, not those of the node, from a dict of dicts."""
        self.update(self.unpack_parameter_dict("", param_dict))

    def set_user_callback(self, callback: Callable[[Any], Any]) -> None:
        """Set the function that is called with the parameters after each change."""
        self.user_callback = callback

    def clear_user_callback(self) -> None:
        """Remove the function that is called after changes."""
        self.user_callback = None

    def refresh_dynamic_parameters(self) -> None:
        """Declare the parameters of new entries of maps."""
        params = self.get_params()
        self._declare(params, self._dynamic(params))
        self.update_internal_params(params)

    def update(self, parameters: list[Any]) -> Any:
        """Accept new values from the node, unless one of them is invalid."""
        params = self.get_params()
        known = {
            name: (place, last, field)
            for name, place, last, field in (*self._static(params), *self._dynamic(params))
        }
        for parameter in parameters:
            if parameter.name not in known:
                continue
            place, last, field = known[parameter.name]
            reason = field.wrong(parameter)
            if reason:
                return SetParametersResult(successful=False, reason=reason)
            setattr(place, last, parameter.value)
            self.logger_.debug(f"{parameter.name}: {parameter.type_.name} = {parameter.value}")
        params.stamp_ = self.clock_.now()
        self.update_internal_params(params)
        if self.user_callback is not None:
            self.user_callback(self.get_params())
        return SetParametersResult(successful=True)

    def update_internal_params(self, updated_params: Any) -> None:
        """Set the parameters that `get_params` returns."""
        self.params_ = updated_params

    def declare_params(self) -> None:
        """Declare all parameters, and read their values."""
        params = self.get_params()
        self._declare(params, self._static(params))
        self._declare(params, self._dynamic(params))
        self.update_internal_params(params)

    def _declare(self, params: Any, fields: Iterator[tuple[str, Any, str, Field]]) -> None:
        found = list(fields)
        for name, place, last, field in found:
            if not self.node_.has_parameter(name):
                default = getattr(place, last)
                value = field.kind if default is None else default
                self.node_.declare_parameter(name, value, copy.deepcopy(field.descriptor))
        for name, place, last, field in found:
            parameter = self.node_.get_parameter(name)
            reason = field.wrong(parameter)
            if reason:
                what = f"Invalid value set during initialization for parameter {name}: {reason}"
                raise InvalidParameterValueException(name, parameter.value, what)
            setattr(place, last, parameter.value)
            self.logger_.debug(f"{name}: {parameter.type_.name} = {parameter.value}")

    def _static(self, params: Any) -> Iterator[tuple[str, Any, str, Field]]:
        """Yield the name, struct, attribute and field of each parameter that is in no map."""
        for path, field in fields_of(params._tree):
            if not any(part.startswith(MAP) for part in path):
                yield self.prefix_ + ".".join(path), walked(params, path[:-1]), path[-1], field

    def _dynamic(self, params: Any) -> Iterator[tuple[str, Any, str, Field]]:
        """Yield the same for the parameters of all map entries."""
        for path, field in fields_of(params._tree):
            maps = [part.removeprefix(MAP) for part in path if part.startswith(MAP)]
            if not maps:
                continue
            above = path[: next(i for i, part in enumerate(path) if part.startswith(MAP))]
            for entries in product(*(entries_of(params, above, name) for name in maps)):
                left = iter(entries)
                named = [next(left) if part.startswith(MAP) else part for part in path]
                place = params
                for part, name in zip(path[:-1], named, strict=False):
                    is_map = part.startswith(MAP)
                    place = place.add_entry(name) if is_map else getattr(place, name)
                yield self.prefix_ + ".".join(named), place, path[-1], field


def walked(params: Any, path: list[str]) -> Any:
    """Return the struct at a path."""
    for part in path:
        params = getattr(params, part)
    return params


def entries_of(params: Any, above: list[str], name: str) -> list[str]:
    """Return the entries of a map: the strings in the nearest parameter of that name above it."""
    for length in range(len(above), -1, -1):
        found = getattr(walked(params, above[:length]), name, None)
        if found is not None and not isinstance(found, Struct):
            return list(found)
    return []


def fields_of(tree: Tree, *above: str) -> Iterator[tuple[list[str], Field]]:
    """Yield each field with the path to it."""
    for name, part in tree.items():
        if isinstance(part, Field):
            yield [*above, name], part
        else:
            yield from fields_of(part, *above, name)


def classes_of(file: Path, validators: str) -> dict[str, Any]:
    """Return the content of a generated module: a class named after the file's only key.

    That class contains the classes ``Params`` and ``ParamListener``.

    Args:
        file: The YAML file that describes the parameters.
        validators: The module with further validators; empty for none.

    Raises:
        ImportError: The file cannot be read, or does not describe parameters.
    """
    try:
        content = loaded_yaml(file.read_bytes())
    except (OSError, ValueError, YAMLError) as error:
        raise ImportError(f"{file}: {error}") from error
    if not isinstance(content, dict) or len(content) != 1:
        raise ImportError(f"{file}: the parameters are not below one name")
    ((namespace, described),) = content.items()
    custom = import_module(validators) if validators else None
    try:
        tree = tree_of(described, custom, namespace)
    except ValueError as error:
        raise ImportError(f"{file}: {error}") from error

    class Params(Struct):
        """The parameters."""

        _tree = tree

        def __init__(self) -> None:
            self.stamp_ = Time()
            super().__init__()

    class ParamListener(Listener):
        __doc__ = Listener.__doc__
        _params_class = Params
        _namespace = namespace

    return {namespace: type(namespace, (), {"Params": Params, "ParamListener": ParamListener})}


def tree_of(described: Any, custom: Any, where: str) -> Tree:
    """Return the struct that a part of a file describes.

    Raises:
        ValueError: It describes none.
    """
    if not isinstance(described, dict):
        raise ValueError(f"{where}: neither a parameter nor a group of them")
    tree: Tree = {}
    for name, part in described.items():
        place = f"{where}.{name}"
        if isinstance(part, dict) and any(isinstance(inner, dict) for inner in part.values()):
            is_field = isinstance(part.get("type"), str)
        else:
            is_field = True
        if not is_field:
            tree[name] = tree_of(part, custom, place)
        elif isinstance(part, dict) and part.get("type") != "none":
            tree[name] = field_of(part, custom, place)
        elif not isinstance(part, dict):
            raise ValueError(f"{place}: neither a parameter nor a group of them")
    return tree


def field_of(described: dict[str, Any], custom: Any, where: str) -> Field:
    """Return the parameter that a part of a file describes.

    Raises:
        ValueError: It describes none.
    """
    unknown = sorted(map(str, described.keys() - KEYS))
    if unknown or not isinstance(described.get("type"), str):
        wrong = f"{unknown[0]!r} is not known" if unknown else "it has no 'type'"
        raise ValueError(f"{where}: {wrong}; a parameter has: {', '.join(sorted(KEYS))}")
    name, _, size = described["type"].partition("_fixed_")
    base = name.removesuffix("_array")
    if base not in TYPES or (size and not size.isdigit()):
        fits = ", ".join(f"{each}, {each}_array" for each in TYPES)
        raise ValueError(f"{where}: no type {described['type']!r}; there are: {fits}")
    validation = dict(described.get("validation") or {})
    if size:
        validation["size_lt<>"] = int(size) + 1
    arguments = {
        key: [] if value is None else value if isinstance(value, list) else [value]
        for key, value in validation.items()
    }
    kind = Parameter.Type[name.replace("int", "integer").upper()]
    descriptor = ParameterDescriptor(
        description=str(described.get("description", "")),
        additional_constraints=str(described.get("additional_constraints", "")),
        read_only=bool(described.get("read_only", False)),
    )
    limits = limits_of(arguments, base)
    if limits is not None and base == "double":
        lower, upper = map(float, limits)
        descriptor.floating_point_range = [FloatingPointRange(from_value=lower, to_value=upper)]
    elif limits is not None:
        descriptor.integer_range = [IntegerRange(from_value=limits[0], to_value=limits[1])]
    return Field(
        kind,
        default_of(described.get("default_value"), base, name != base, where),
        descriptor,
        tuple(check_of(key, values, custom, where) for key, values in arguments.items()),
    )


def default_of(value: Any, base: str, is_array: bool, where: str) -> Any:
    """Return a default; None if there is none.

    Raises:
        ValueError: It has another type.
    """
    if value is None:
        return None
    values = value if is_array and isinstance(value, list) else [value]
    cls = TYPES[base]
    for each in values:
        is_whole = type(each) is int and base == "double"
        if is_array is not isinstance(value, list) or not (type(each) is cls or is_whole):
            raise ValueError(
                f"{where}: the default {value!r} is not of type {base}{'_array' * is_array}"
            )
    converted = [cls(each) for each in values]
    return converted if is_array else converted[0]


def limits_of(arguments: dict[str, list[Any]], base: str) -> tuple[Any, Any] | None:
    """Return the smallest and largest number that validators accept, if they limit it."""
    if base not in {"int", "double"}:
        return None
    step = 1 if base == "int" else sys.float_info.epsilon
    lower, upper = None, None
    for key, values in arguments.items():
        match key.removesuffix("<>"), values:
            case "bounds" | "element_bounds", [low, high]:
                lower, upper = low, high
            case "gt_eq" | "lower_element_bounds", [low]:
                lower = low
            case "gt", [low]:
                lower = low + step
            case "lt_eq" | "upper_element_bounds", [high]:
                upper = high
            case "lt", [high]:
                upper = high - step
    if lower is None and upper is None:
        return None
    least, greatest = INT_LIMITS if base == "int" else (float("-inf"), float("inf"))
    return least if lower is None else lower, greatest if upper is None else upper


def check_of(key: str, arguments: list[Any], custom: Any, where: str) -> Callable[[Any], str]:
    """Return a validator as a function, with its arguments bound.

    Raises:
        ValueError: There is no such validator.
    """
    name = key.removesuffix("<>")
    holder: Any = ParameterValidators
    if "::" in name:
        holder, name = custom, name.rpartition("::")[2]
    function = getattr(holder, name, None)
    if not callable(function):
        raise ValueError(f"{where}: there is no validator {key!r}")
    return lambda parameter: function(parameter, *arguments) or ""
