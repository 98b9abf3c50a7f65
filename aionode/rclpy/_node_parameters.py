"""The parameters of a node.

A change passes through the pre-set callbacks, which may change the list, then the descriptors, then
the on-set callbacks, which may reject it; it is stored, published as an event, and shown to the
post-set callbacks. All of that happens in the calling thread.
"""

from __future__ import annotations

import math
import warnings
from typing import TYPE_CHECKING, Any

from aionode.parameter import validate_parameter_name
from aionode.rclpy._impl import messages as msg
from aionode.rclpy._impl.typesupport import ros_name
from aionode.rclpy.exceptions import (
    InvalidParameterTypeException,
    InvalidParameterValueException,
    ParameterAlreadyDeclaredException,
    ParameterImmutableException,
    ParameterNotDeclaredException,
    ParameterUninitializedException,
)
from aionode.rclpy.parameter import PARAMETER_SEPARATOR_STRING, Parameter

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from aionode.rclpy.clock import Clock
    from aionode.rclpy.publisher import Publisher

__all__ = ["NodeParameters"]

EMPTY_LIST = (
    "parameter list cannot be empty, this might be due to pre_set_parameters_callback modifying "
    "the original parameters list."
)

ONLY_A_NAME = (
    "when declaring parameter named '{}', declaring a parameter only providing its name is "
    "deprecated. You have to either:\n"
    '\t- Pass a name and a default value different to "PARAMETER NOT SET" (and optionally a '
    "descriptor).\n"
    "\t- Pass a name and a parameter type.\n"
    "\t- Pass a name and a descriptor with `dynamic_typing=True"
)

NOT_SET: Any = Parameter.Type.NOT_SET


def failure(reason: str) -> Any:
    """Return the result of a change that is rejected."""
    return msg.SetParametersResult(successful=False, reason=reason)


def success() -> Any:
    """Return the result of a change that is accepted."""
    return msg.SetParametersResult(successful=True)


def expect_strings(values: Iterable[Any], what: str) -> None:
    """Raise a TypeError that names `what` unless all are text."""
    if not all(isinstance(value, str) for value in values):
        raise TypeError(f"All {what} must be instances of type str")


class NodeParameters:
    """The part of `Node` that has parameters."""

    PARAM_REL_TOL = 1e-6
    """How near to a limit or a step a float has to be, relative to it."""

    _clock: Clock
    _parameter_event_publisher: Publisher[Any] | None
    get_fully_qualified_name: Callable[[], str]

    def __init__(self, *, allow_undeclared_parameters: bool) -> None:
        self._allow_undeclared_parameters = allow_undeclared_parameters
        self._parameters: dict[str, Parameter[Any]] = {}
        self._descriptors: dict[str, Any] = {}
        self._parameter_overrides: dict[str, Parameter[Any]] = {}
        self._pre_set_parameters_callbacks: list[Callable[[list[Any]], list[Any]]] = []
        self._on_set_parameters_callbacks: list[Callable[[list[Any]], Any]] = []
        self._post_set_parameters_callbacks: list[Callable[[list[Any]], None]] = []

    # Declaring

    def declare_parameter(
        self, name: str, value: Any = None, descriptor: Any = None, ignore_override: bool = False
    ) -> Parameter[Any]:
        """Declare a parameter and return it; an override of its name gives the value.

        Args:
            name: Its name.
            value: Its first value, or its type, `Parameter.Type`.
            descriptor: Its description, ranges, and whether it is read-only.
            ignore_override: Whether overrides do not count.

        Raises:
            ParameterAlreadyDeclaredException: it is declared already.
            InvalidParameterException: the name is invalid.
            InvalidParameterTypeException: the override is of another type.
            InvalidParameterValueException: the descriptor or a callback rejects the value.
        """
        if value is None and descriptor is None:
            return self.declare_parameters("", [(name,)], ignore_override)[0]
        entry = (name, value, msg.ParameterDescriptor() if descriptor is None else descriptor)
        return self.declare_parameters("", [entry], ignore_override)[0]

    def declare_parameters(
        self,
        namespace: str,
        parameters: Sequence[tuple[Any, ...]],
        ignore_override: bool = False,
    ) -> list[Parameter[Any]]:
        """Declare parameters, each as ``(name, value or type, descriptor)``; see above.

        Args:
            namespace: Prefix of the names, with a dot.
            parameters: Tuples of one to three elements.
            ignore_override: Whether overrides do not count.

        Raises:
            TypeError: a tuple has another form.
        """
        declared = [
            self._declaration(namespace, entry, index, ignore_override)
            for index, entry in enumerate(parameters)
        ]
        known = [parameter.name for parameter, _ in declared if parameter.name in self._parameters]
        if known:
            raise ParameterAlreadyDeclaredException(known)
        for parameter, descriptor in declared:
            result = self._set_atomically([parameter], {parameter.name: descriptor}, declaring=True)
            if result.successful:
                continue
            if result.reason.startswith("Wrong parameter type"):
                raise InvalidParameterTypeException(
                    parameter.name,
                    parameter.value,
                    parameter.type_.name,
                    Parameter.Type(descriptor.type).name,
                )
            raise InvalidParameterValueException(parameter.name, parameter.value, result.reason)
        return [self._parameters[parameter.name] for parameter, _ in declared]

    def _declaration(
        self, namespace: str, entry: tuple[Any, ...], index: int, ignore_override: bool
    ) -> tuple[Parameter[Any], Any]:
        if not 1 <= len(entry) <= 3:
            raise TypeError(
                f"Invalid parameter tuple length at index {index} in parameters list: {entry}; "
                "expecting length between 1 and 3"
            )
        name = entry[0]
        if not isinstance(name, str):
            raise TypeError(
                f"First element {name} at index {index} in parameters list is not a str."
            )
        if namespace:
            name = f"{namespace}{PARAMETER_SEPARATOR_STRING}{name}"
        validate_parameter_name(name)
        value = entry[1] if len(entry) > 1 else None
        descriptor = as_descriptor(entry[2] if len(entry) > 2 else None, index)
        if len(entry) == 1:
            warnings.warn(ONLY_A_NAME.format(name), stacklevel=4)
            descriptor.dynamic_typing = True
        value = typed(name, value, descriptor)
        if not ignore_override and name in self._parameter_overrides:
            value = self._parameter_overrides[name].value
        if isinstance(value, msg.ParameterValue):
            raise ValueError(
                "Cannot declare a Parameter from a ParameterValue without it being included in "
                "self._parameter_overrides, and ",
                "ignore_override=False",
            )
        return Parameter(name, value=value), descriptor

    def undeclare_parameter(self, name: str) -> None:
        """Undeclare a parameter.

        Raises:
            ParameterNotDeclaredException: it is not declared.
            ParameterImmutableException: it is read-only.
        """
        if name not in self._parameters:
            raise ParameterNotDeclaredException(name)
        if self._descriptors[name].read_only:
            raise ParameterImmutableException(name)
        del self._parameters[name]
        del self._descriptors[name]

    # Reading

    def has_parameter(self, name: str) -> bool:
        """Return whether a parameter is declared, or set."""
        return name in self._parameters

    def get_parameter_types(self, names: list[str]) -> list[Any]:
        """Return the types of several parameters; see `get_parameter_type`."""
        expect_strings(names, "names")
        return [self.get_parameter_type(name) for name in names]

    def get_parameter_type(self, name: str) -> Any:
        """Return the type of a parameter.

        Raises:
            ParameterNotDeclaredException: it is not declared, and has to be.
        """
        if name in self._parameters:
            return self._parameters[name].type_.value
        if self._allow_undeclared_parameters:
            return NOT_SET
        raise ParameterNotDeclaredException(name)

    def get_parameters(self, names: list[str]) -> list[Parameter[Any]]:
        """Return several parameters; see `get_parameter`."""
        expect_strings(names, "names")
        return [self.get_parameter(name) for name in names]

    def get_parameter(self, name: str) -> Parameter[Any]:
        """Return a parameter.

        Raises:
            ParameterNotDeclaredException: it is not declared, and has to be.
            ParameterUninitializedException: it was declared with a type, and has no value.
        """
        parameter = self._parameters.get(name)
        if parameter is None:
            if self._allow_undeclared_parameters:
                return Parameter(name, NOT_SET)
            raise ParameterNotDeclaredException(name)
        if parameter.type_ is NOT_SET and not self._descriptors[name].dynamic_typing:
            raise ParameterUninitializedException(name)
        return parameter

    def get_parameter_or(
        self, name: str, alternative_value: Parameter[Any] | None = None
    ) -> Parameter[Any]:
        """Return a parameter, or the alternative if it is not declared or has no value."""
        parameter = self._parameters.get(name)
        if parameter is not None and parameter.type_ is not NOT_SET:
            return parameter
        return Parameter(name, NOT_SET) if alternative_value is None else alternative_value

    def get_parameters_by_prefix(self, prefix: str) -> dict[str, Parameter[Any]]:
        """Return the parameters of a group, by their names without its prefix."""
        if prefix:
            prefix += PARAMETER_SEPARATOR_STRING
        return {
            name.removeprefix(prefix): parameter
            for name, parameter in self._parameters.items()
            if name.startswith(prefix)
        }

    def list_parameters(self, prefixes: list[str], depth: int) -> Any:
        """Return the names of parameters, and their groups.

        Args:
            prefixes: The groups whose parameters count; all if empty.
            depth: How many parts the names may have, after the group; 0 for any number.

        Raises:
            TypeError, ValueError: an argument is of another kind.
        """
        if not isinstance(prefixes, list):
            raise TypeError("The prefixes argument must be a list")
        expect_strings(prefixes, "prefixes")
        if not isinstance(depth, int):
            raise TypeError("The depth must be instance of type int")
        if depth < 0:
            raise ValueError("The depth must be greater than or equal to zero")

        def is_shallow(name: str) -> bool:
            return depth == 0 or name.count(PARAMETER_SEPARATOR_STRING) < depth

        def is_listed(name: str) -> bool:
            if not prefixes:
                return is_shallow(name)
            return any(
                name == prefix
                or (
                    name.startswith(prefix + PARAMETER_SEPARATOR_STRING)
                    and is_shallow(name[len(prefix) + 1 :])
                )
                for prefix in prefixes
            )

        names = [name for name in self._parameters if is_listed(name)]
        groups: dict[str, None] = {}
        for name in names:
            group, separator, _ = name.rpartition(PARAMETER_SEPARATOR_STRING)
            if separator:
                groups[group] = None
        return msg.ListParametersResult(names=names, prefixes=list(groups))

    # Setting

    def set_parameters(self, parameter_list: list[Parameter[Any]]) -> list[Any]:
        """Set parameters one by one; return a result for each.

        Raises:
            ParameterNotDeclaredException: one is not declared, and has to be; those before it are
                set.
        """
        return [self._set_with_callbacks([parameter]) for parameter in parameter_list]

    def set_parameters_atomically(self, parameter_list: list[Parameter[Any]]) -> Any:
        """Set all parameters or none; return the result.

        Raises:
            ParameterNotDeclaredException: one is not declared, and has to be.
        """
        return self._set_with_callbacks(parameter_list)

    def _set_with_callbacks(self, parameters: list[Parameter[Any]]) -> Any:
        if self._pre_set_parameters_callbacks:
            modified: list[Parameter[Any]] = []
            for callback in self._pre_set_parameters_callbacks:
                modified.extend(callback(parameters))
            if not modified:
                return failure(EMPTY_LIST)
            parameters = modified
        if not all(isinstance(parameter, Parameter) for parameter in parameters):
            raise TypeError(f"parameter must be instance of type '{Parameter!r}'")
        unknown = [each.name for each in parameters if each.name not in self._parameters]
        if unknown and not self._allow_undeclared_parameters:
            raise ParameterNotDeclaredException(unknown)
        return self._set_atomically(parameters)

    def _set_atomically(
        self,
        parameters: list[Parameter[Any]],
        descriptors: dict[str, Any] | None = None,
        *,
        declaring: bool = False,
    ) -> Any:
        for parameter in parameters:
            descriptor: Any = (self._descriptors if descriptors is None else descriptors).get(
                parameter.name
            )
            if descriptor is not None:
                result = self._apply_descriptor(parameter, descriptor, descriptors is None)
                if not result.successful:
                    return result
        for callback in self._on_set_parameters_callbacks:
            result = callback(parameters)
            if not isinstance(result, msg.SetParametersResult):
                warnings.warn(
                    "Callback returned an invalid type, it should return SetParameterResult.",
                    stacklevel=4,
                )
                result = failure("Callback returned an invalid type")
            if not result.successful:
                return result
        self._store(parameters, descriptors, declaring)
        for post in self._post_set_parameters_callbacks:
            post(parameters)
        return success()

    def _store(
        self,
        parameters: list[Parameter[Any]],
        descriptors: dict[str, Any] | None,
        declaring: bool,
    ) -> None:
        event = msg.ParameterEvent(node=self.get_fully_qualified_name())
        new: list[Any] = []
        changed: list[Any] = []
        deleted: list[Any] = []
        for parameter in parameters:
            name = parameter.name
            if parameter.type_ is NOT_SET and not declaring:
                deleted.append(parameter.to_parameter_msg())
                self._parameters.pop(name, None)
                self._descriptors.pop(name, None)
                continue
            if descriptors is not None:
                self._descriptors[name] = descriptors[name]
            elif name not in self._descriptors:
                self._descriptors[name] = msg.ParameterDescriptor(dynamic_typing=True)
            is_new = self.get_parameter_or(name).type_ is NOT_SET
            (new if is_new else changed).append(parameter.to_parameter_msg())
            self._parameters[name] = parameter
        if self._parameter_event_publisher is not None:
            event.new_parameters = new
            event.changed_parameters = changed
            event.deleted_parameters = deleted
            event.stamp = self._clock.now().to_msg()
            self._parameter_event_publisher.handle.refuse_after_shutdown("Failed to publish")
            self._parameter_event_publisher.publish(event)

    def add_pre_set_parameters_callback(self, callback: Callable[[list[Any]], list[Any]]) -> None:
        """Call `callback` before a change is checked; it returns the parameters to set instead."""
        self._pre_set_parameters_callbacks.insert(0, callback)

    def add_on_set_parameters_callback(self, callback: Callable[[list[Any]], Any]) -> None:
        """Call `callback` to check a change; the newest is called first.

        Raises:
            TypeError: it is not callable.
        """
        if not callable(callback):
            raise TypeError("Callback must be callable, got {}", type(callback))
        self._on_set_parameters_callbacks.insert(0, callback)

    def add_post_set_parameters_callback(self, callback: Callable[[list[Any]], None]) -> None:
        """Call `callback` after a change.

        Raises:
            TypeError: it is not callable.
        """
        if not callable(callback):
            raise TypeError("Callback must be callable, got {}", type(callback))
        self._post_set_parameters_callbacks.insert(0, callback)

    def remove_pre_set_parameters_callback(self, callback: Callable[[list[Any]], Any]) -> None:
        """Remove a callback; a ValueError if it was not added."""
        self._pre_set_parameters_callbacks.remove(callback)

    def remove_on_set_parameters_callback(self, callback: Callable[[list[Any]], Any]) -> None:
        """Remove a callback; a ValueError if it was not added."""
        self._on_set_parameters_callbacks.remove(callback)

    def remove_post_set_parameters_callback(self, callback: Callable[[list[Any]], None]) -> None:
        """Remove a callback; a ValueError if it was not added."""
        self._post_set_parameters_callbacks.remove(callback)

    # Descriptors

    def _apply_descriptor(
        self, parameter: Parameter[Any], descriptor: Any, check_read_only: bool
    ) -> Any:
        """Return whether a value fits a descriptor."""
        descriptor.name = parameter.name
        if check_read_only and descriptor.read_only:
            return failure(f"Trying to set a read-only parameter: {parameter.name}.")
        if descriptor.dynamic_typing:
            descriptor.type = int(parameter.type_)
        elif parameter.type_ is NOT_SET:
            if parameter.name in self._parameters:
                return failure("Static parameter cannot be undeclared")
        elif parameter.type_ != descriptor.type:
            expected = Parameter.Type(descriptor.type)
            return failure(f"Wrong parameter type, expected '{expected}' got '{parameter.type_}'")
        if parameter.type_ is Parameter.Type.INTEGER and descriptor.integer_range:
            return integer_in_range(parameter, descriptor.integer_range[0])
        if parameter.type_ is Parameter.Type.DOUBLE and descriptor.floating_point_range:
            return self._float_in_range(parameter, descriptor.floating_point_range[0])
        return success()

    def _float_in_range(self, parameter: Parameter[Any], limits: Any) -> Any:
        def is_at(limit: float) -> bool:
            return math.isclose(parameter.value, limit, rel_tol=self.PARAM_REL_TOL)

        low, high = sorted((limits.from_value, limits.to_value))
        if is_at(low) or is_at(high):
            return success()
        if not low < parameter.value < high:
            return failure(
                f"Parameter {parameter.name} out of range "
                f"Min: {low}, Max: {high}, value: {parameter.value}"
            )
        steps = round((parameter.value - low) / limits.step) if limits.step else 0
        if limits.step and not is_at(low + steps * limits.step):
            return failure(
                f"The parameter value for {parameter.name} is not close enough to a valid step. "
                f"Min: {low}, max: {high}, value: {parameter.value}, step: {limits.step}"
            )
        return success()

    def describe_parameter(self, name: str) -> Any:
        """Return the descriptor of a parameter; an empty one if it need not be declared.

        Raises:
            ParameterNotDeclaredException: it is not declared, and has to be.
        """
        if name in self._descriptors:
            return self._descriptors[name]
        if self._allow_undeclared_parameters:
            return msg.ParameterDescriptor()
        raise ParameterNotDeclaredException(name)

    def describe_parameters(self, names: list[str]) -> list[Any]:
        """Return several descriptors; see `describe_parameter`."""
        return [self.describe_parameter(name) for name in names]

    def set_descriptor(
        self, name: str, descriptor: Any, alternative_value: Any | None = None
    ) -> Any:
        """Replace the descriptor of a parameter; return the value that it has then.

        Args:
            name: The parameter.
            descriptor: Its new descriptor.
            alternative_value: The value that it gets if its own does not fit, a ParameterValue.

        Raises:
            ParameterNotDeclaredException: it is not declared, and has to be.
            ParameterImmutableException: it is read-only.
            InvalidParameterValueException: neither value fits.
        """
        if name not in self._parameters:
            return self.get_parameter(name).get_parameter_value()
        if self._descriptors[name].read_only:
            raise ParameterImmutableException(name)
        candidates = [self.get_parameter(name)]
        if alternative_value is not None:
            candidates.append(
                Parameter.from_parameter_msg(msg.Parameter(name=name, value=alternative_value))
            )
        for candidate in candidates:
            result: Any = self._apply_descriptor(candidate, descriptor, False)
            if result.successful:
                self._parameters[name] = candidate
                break
        else:
            raise InvalidParameterValueException(name, candidates[-1].value, result.reason)
        self._descriptors[name] = descriptor
        return self.get_parameter(name).get_parameter_value()


def as_descriptor(given: Any, index: int) -> Any:
    """Return a descriptor of rclpy's family.

    Raises:
        TypeError: it is none.
    """
    if given is None:
        return msg.ParameterDescriptor()
    if isinstance(given, msg.ParameterDescriptor):
        return given
    try:
        name = ros_name(type(given))
    except (TypeError, AttributeError):
        name = ""
    if name != "rcl_interfaces/msg/ParameterDescriptor":
        raise TypeError(
            f"Third element {given} at index {index} in parameters list is not a "
            "ParameterDescriptor."
        )
    return msg.ParameterDescriptor(
        name=given.name,
        type=given.type,
        description=given.description,
        additional_constraints=given.additional_constraints,
        read_only=given.read_only,
        dynamic_typing=given.dynamic_typing,
    )


def typed(name: str, value: Any, descriptor: Any) -> Any:
    """Set the type in the descriptor of a declaration, and return the value.

    Raises:
        ValueError: the type cannot be told.
    """
    if isinstance(value, Parameter.Type):
        if value is NOT_SET:
            raise ValueError(
                f"Cannot declare parameter {{{name}}} as statically typed of type NOT_SET"
            )
        if descriptor.dynamic_typing:
            raise ValueError(
                f"When declaring parameter {{{name}}} passing a descriptor with"
                "`dynamic_typing=True` is not allowed when the parameter type is provided"
            )
        descriptor.type = int(value)
        return None
    if not descriptor.dynamic_typing:
        is_message = isinstance(value, msg.ParameterValue)
        descriptor.type = (
            value.type if is_message else int(Parameter.Type.from_parameter_value(value))
        )
        if descriptor.type == NOT_SET:
            raise ValueError(
                "Cannot declare a statically typed parameter with default value of type "
                "PARAMETER_NOT_SET"
            )
    return value


def integer_in_range(parameter: Parameter[Any], limits: Any) -> Any:
    """Return whether an integer is in a range, and on one of its steps."""
    low, high = sorted((limits.from_value, limits.to_value))
    value = parameter.value
    if value in (low, high):
        return success()
    if not low < value < high:
        return failure(
            f"Parameter {parameter.name} out of range. Min: {low}, Max: {high}, value: {value}"
        )
    if limits.step and (value - low) % limits.step:
        return failure(
            f"The parameter value for {parameter.name} is not a valid step. "
            f"Min: {low}, max: {high}, value: {value}, step: {limits.step}"
        )
    return success()
