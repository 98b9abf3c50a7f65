"""The parameters of one node: declaration, checks and changes. Does no I/O.

A change passes through these steps; if one of them rejects it, nothing is changed::

    pre callbacks    may change the list of parameters        not when declaring
    declared?        unless undeclared ones are allowed       not when declaring
    descriptor       read-only, type, range
    on callbacks     may reject
    stored
    event            passed to `publish`
    post callbacks   may act on it
"""

from __future__ import annotations

import copy
import warnings
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from aionode.errors import (
    InvalidParameterTypeException,
    InvalidParameterValueException,
    ParameterAlreadyDeclaredException,
    ParameterImmutableException,
    ParameterNotDeclaredException,
    ParameterUninitializedException,
    brief,
)
from aionode.interfaces.rcl_interfaces import msg as rcl_msg
from aionode.interfaces.rcl_interfaces.msg import (
    ListParametersResult,
    ParameterDescriptor,
    ParameterEvent,
    ParameterValue,
    SetParametersResult,
)
from aionode.parameter._callbacks import OnSetCallback, ParameterCallbacks
from aionode.parameter._constraints import descriptor_violation, type_violation
from aionode.parameter._declaration import (
    first_value,
    refuse_many_ranges,
    split_entry,
    validate_parameter_name,
)
from aionode.parameter._value import (
    PARAMETER_SEPARATOR_STRING,
    Parameter,
    ParameterType,
    expect,
)

__all__ = ["ParameterStore"]

EMPTY_LIST = (
    "parameter list cannot be empty, this might be due to pre_set_parameters_callback "
    "modifying the original parameters list."
)


class ParameterStore:
    """The parameters of one node.

    An API with its own classes derives from it and sets `parameter_class` and `messages`.

    Args:
        node_name: Full name of the node, for its events.
        overrides: Values that take precedence over those given when declaring.
        allow_undeclared: Whether parameters can be set without being declared.
        publish: Called with the event of each change, without a stamp, before the post callbacks.

    Attributes:
        overrides: The overrides, by name.
        asked: Names of the overrides whose parameters have been declared.
        publish: The function for events, which may be replaced.
        callbacks: The callbacks for changes.
        parameter_class: The class of the parameters.
        messages: The message classes, by name; on-set callbacks return its `SetParametersResult`.
    """

    parameter_class: type[Parameter] = Parameter
    messages: Any = rcl_msg

    def __init__(
        self,
        node_name: str,
        *,
        overrides: Iterable[Parameter] | Mapping[str, object] = (),
        allow_undeclared: bool = False,
        publish: Callable[[ParameterEvent], None] | None = None,
    ) -> None:
        self.node_name = node_name
        self.callbacks = ParameterCallbacks()
        self.overrides = as_overrides(overrides)
        self.asked: set[str] = set()
        self.allow_undeclared = allow_undeclared
        self.publish = publish
        # Both by name and with the same keys: the declared parameters, and those that were set
        # undeclared where that is allowed.
        self._parameters: dict[str, Parameter] = {}
        self._descriptors: dict[str, ParameterDescriptor] = {}

    @staticmethod
    def type_text(kind: ParameterType) -> str:
        """Return the name of a type in messages."""
        return f"Type.{kind.name}"

    def names(self) -> list[str]:
        """Return the names of all declared parameters."""
        return list(self._parameters)

    # Declaring

    def declare_parameter(
        self,
        name: str,
        value: Any = None,
        descriptor: ParameterDescriptor | None = None,
        ignore_override: bool = False,
    ) -> Parameter:
        """Declare a parameter and return it; an override takes precedence over `value`.

        Args:
            name: Its name.
            value: Its initial value, or its type (`Parameter.Type`) to declare it without a value.
            descriptor: Description, range, and whether it is read-only. Unless it has
                `dynamic_typing`, the type remains that of `value`.
            ignore_override: Whether to ignore overrides.

        Raises:
            ParameterAlreadyDeclaredException: The parameter is already declared.
            InvalidParameterException: The name is empty.
            InvalidParameterTypeException: The override has a different type than `value`.
            InvalidParameterValueException: The descriptor or a callback rejects the value.
        """
        if value is None and descriptor is None:
            return self.declare_parameters("", [(name,)], ignore_override)[0]
        return self.declare_parameters("", [(name, value, descriptor)], ignore_override)[0]

    def declare_parameters(
        self,
        namespace: str,
        parameters: Iterable[tuple[Any, ...]],
        ignore_override: bool = False,
    ) -> list[Parameter]:
        """Declare parameters, each given as ``(name, value or type, descriptor)``, in order.

        If one is rejected, those before it stay declared. See `declare_parameter`.

        Args:
            namespace: Prepended to the names, with a dot, unless it is empty.
            parameters: A tuple of 1 to 3 elements for each parameter.
            ignore_override: Whether to ignore overrides.

        Raises:
            TypeError: A tuple has another form.
        """
        declarations = [
            self._declaration(namespace, entry, index, ignore_override)
            for index, entry in enumerate(parameters)
        ]
        names = [parameter.name for parameter, _ in declarations]
        known = [name for name in names if name in self._parameters]
        if known:
            raise ParameterAlreadyDeclaredException(known)
        for parameter, descriptor in declarations:
            self._declare(parameter, descriptor)
        return [self._parameters[parameter.name] for parameter, _ in declarations]

    def _declaration(
        self, namespace: str, entry: tuple[Any, ...], index: int, ignore_override: bool
    ) -> tuple[Parameter, ParameterDescriptor]:
        name, value, given = split_entry(entry, index)
        if namespace:
            name = f"{namespace}{PARAMETER_SEPARATOR_STRING}{name}"
        validate_parameter_name(name)
        descriptor = self._own_descriptor(given, index)
        refuse_many_ranges(name, descriptor)
        descriptor.name = name
        if len(entry) == 1:
            warnings.warn(
                f"when declaring parameter named '{name}', declaring a parameter only providing "
                "its name is deprecated. You have to either:\n"
                '\t- Pass a name and a default value different to "PARAMETER NOT SET" (and '
                "optionally a descriptor).\n"
                "\t- Pass a name and a parameter type.\n"
                "\t- Pass a name and a descriptor with `dynamic_typing=True`.",
                stacklevel=4,
            )
            descriptor.dynamic_typing = True
        if name in self.overrides:
            self.asked.add(name)
        parameter = first_value(name, value, descriptor, self.parameter_class, self.messages)
        if not ignore_override and name in self.overrides:
            (parameter,) = self._prepared([self.overrides[name]], {name: descriptor})
        return parameter, descriptor

    def _own_descriptor(self, given: Any, index: int) -> ParameterDescriptor:
        """Return a copy of the descriptor at `index` of a declaration; an empty one for None.

        Raises:
            TypeError: it is not a descriptor.
        """
        wanted = self.messages.ParameterDescriptor
        descriptor: ParameterDescriptor
        if given is None:
            descriptor = wanted()
        else:
            expect(given, wanted, f"Third element at index {index} in parameters list")
            descriptor = copy.deepcopy(given)
        return descriptor

    def _declare(self, parameter: Parameter, descriptor: ParameterDescriptor) -> None:
        if type_violation(parameter, descriptor, declared=False):
            raise InvalidParameterTypeException(
                parameter.name,
                parameter.value,
                parameter.type_.name,
                ParameterType(descriptor.type).name,
            )
        reason = descriptor_violation(parameter, descriptor)
        if reason is None and (rejected := self._rejection([parameter])):
            reason = rejected.reason
        if reason is not None:
            raise InvalidParameterValueException(parameter.name, parameter.value, reason)
        self._descriptors[parameter.name] = descriptor
        self._store([parameter], keep_not_set=True)

    def undeclare_parameter(self, name: str) -> None:
        """Remove a parameter. No callback is called and no event is published.

        Raises:
            ParameterNotDeclaredException: No parameter of this name is declared.
            ParameterImmutableException: It is read-only.
        """
        if name not in self._parameters:
            raise ParameterNotDeclaredException(name)
        if self._descriptors[name].read_only:
            raise ParameterImmutableException(name)
        del self._parameters[name]
        del self._descriptors[name]

    # Reading

    def has_parameter(self, name: str) -> bool:
        """Return whether a parameter is declared."""
        return name in self._parameters

    def get_parameter(self, name: str) -> Parameter:
        """Return a parameter; an unset one if it is undeclared and that is allowed.

        Raises:
            ParameterNotDeclaredException: It is undeclared, and undeclared parameters are not
                allowed.
            ParameterUninitializedException: It was declared without a value and has never been set.
        """
        parameter = self._parameters.get(name)
        if parameter is None:
            if self.allow_undeclared:
                return self.parameter_class(name)
            raise ParameterNotDeclaredException(name)
        if parameter.type_ == ParameterType.NOT_SET and not self._descriptors[name].dynamic_typing:
            raise ParameterUninitializedException(name)
        return parameter

    def get_parameters(self, names: Iterable[str]) -> list[Parameter]:
        """Return several parameters; see `get_parameter`.

        Raises:
            TypeError: A name is not a str.
        """
        return [self.get_parameter(name) for name in expect_names(names)]

    def get_parameter_or(self, name: str, alternative_value: Parameter | None = None) -> Parameter:
        """Return a parameter, or the alternative if it is undeclared or has no value."""
        parameter = self._parameters.get(name)
        if parameter is not None and parameter.type_ != ParameterType.NOT_SET:
            return parameter
        return self.parameter_class(name) if alternative_value is None else alternative_value

    def get_parameter_type(self, name: str) -> ParameterType:
        """Return the type of a parameter; NOT_SET if it is undeclared and that is allowed.

        Raises:
            ParameterNotDeclaredException: It is undeclared, and undeclared parameters are not
                allowed.
        """
        if name in self._parameters:
            return self._parameters[name].type_
        if self.allow_undeclared:
            return self.parameter_class.Type.NOT_SET
        raise ParameterNotDeclaredException(name)

    def get_parameter_types(self, names: Iterable[str]) -> list[ParameterType]:
        """Return several types; see `get_parameter_type`.

        Raises:
            TypeError: A name is not a str.
        """
        return [self.get_parameter_type(name) for name in expect_names(names)]

    def get_parameters_by_prefix(self, prefix: str) -> dict[str, Parameter]:
        """Return the parameters of a group, keyed by their names without the prefix."""
        start = f"{prefix}{PARAMETER_SEPARATOR_STRING}" if prefix else ""
        return {
            name[len(start) :]: parameter
            for name, parameter in self._parameters.items()
            if name.startswith(start)
        }

    def list_parameters(self, prefixes: list[str], depth: int) -> ListParametersResult:
        """Return the names of parameters and of their groups.

        Args:
            prefixes: The names and groups to list; all if it is empty.
            depth: How many levels below each prefix to list; 0 means all.

        Raises:
            TypeError: An argument has the wrong type.
            ValueError: `depth` is negative.
        """
        expect(prefixes, list, "prefixes")
        expect_names(prefixes)
        expect(depth, int, "depth")
        if depth < 0:
            message = f"The depth must be greater than or equal to zero, not {depth}"
            raise ValueError(message)
        result: ListParametersResult = self.messages.ListParametersResult(names=[], prefixes=[])
        wanted = frozenset(prefixes)
        for name in self._parameters:
            if is_listed(name, wanted, depth):
                result.names.append(name)
                group = name.rpartition(PARAMETER_SEPARATOR_STRING)[0]
                if group and group not in result.prefixes:
                    result.prefixes.append(group)
        return result

    # Changing

    def set_parameters(self, parameter_list: Iterable[Parameter]) -> list[SetParametersResult]:
        """Set parameters one by one, and return a result for each, in order.

        Raises:
            ParameterNotDeclaredException: One is undeclared, and undeclared parameters are not
                allowed; those before it stay set.
            TypeError: One is not a Parameter.
        """
        return [self.set_parameters_atomically([parameter]) for parameter in parameter_list]

    def set_parameters_atomically(self, parameter_list: Iterable[Parameter]) -> SetParametersResult:
        """Set all parameters, or none of them. Setting one to NOT_SET undeclares it.

        Raises:
            ParameterNotDeclaredException: One is undeclared, and undeclared parameters are not
                allowed.
            TypeError: One is not a Parameter.
        """
        parameters = self.callbacks.modified(list(parameter_list))
        for parameter in parameters:
            expect(parameter, self.parameter_class, "parameter")
        if self.callbacks.pre and not parameters:
            return self._failure(EMPTY_LIST)
        parameters = self._prepared(parameters, self._descriptors)
        names = [parameter.name for parameter in parameters]
        undeclared = [name for name in names if name not in self._parameters]
        if undeclared and not self.allow_undeclared:
            raise ParameterNotDeclaredException(undeclared)
        if reason := self._violation(parameters):
            return self._failure(reason)
        if rejected := self._rejection(parameters):
            return rejected
        self._store(parameters)
        success: SetParametersResult = self.messages.SetParametersResult(successful=True)
        return success

    def _rejection(self, parameters: list[Parameter]) -> SetParametersResult | None:
        """Return the first result of an on-set callback that rejects a change, if any."""
        for callback in self.callbacks.on:
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

    def _failure(self, reason: str) -> SetParametersResult:
        """Return the result for a rejected change."""
        result: SetParametersResult = self.messages.SetParametersResult(reason=reason)
        return result

    def _prepared(
        self, parameters: list[Parameter], descriptors: Mapping[str, ParameterDescriptor]
    ) -> list[Parameter]:
        """Return parameters in the form in which they are checked and stored.

        If a name occurs several times, as with several pre callbacks, the last value counts. An
        empty list gets the declared type.
        """
        last = {parameter.name: parameter for parameter in parameters}
        return [
            with_declared_type(parameter, descriptors.get(name)) for name, parameter in last.items()
        ]

    def _violation(self, parameters: list[Parameter]) -> str | None:
        for parameter in parameters:
            descriptor = self._descriptors.get(parameter.name)
            if descriptor is None:
                continue
            if descriptor.read_only:
                return f"Trying to set a read-only parameter: {parameter.name}."
            reason = self._misfit(parameter, descriptor)
            if reason is not None:
                return reason
        return None

    def _misfit(self, parameter: Parameter, descriptor: ParameterDescriptor) -> str | None:
        """Return why a value does not fit the descriptor of its parameter, or None if it does."""
        reason = type_violation(parameter, descriptor, declared=True, text_of=self.type_text)
        return reason or descriptor_violation(parameter, descriptor)

    def _store(self, parameters: list[Parameter], *, keep_not_set: bool = False) -> None:
        new: list[Any] = []
        changed: list[Any] = []
        deleted: list[Any] = []
        for parameter in parameters:
            name = parameter.name
            if parameter.type_ == ParameterType.NOT_SET and not keep_not_set:
                deleted.append(parameter.to_parameter_msg())
                self._parameters.pop(name, None)
                self._descriptors.pop(name, None)
                continue
            before = self.get_parameter_or(name).type_
            (new if before == ParameterType.NOT_SET else changed).append(
                parameter.to_parameter_msg()
            )
            descriptor = self._descriptors.setdefault(
                name, self.messages.ParameterDescriptor(name=name, dynamic_typing=True)
            )
            if descriptor.dynamic_typing:
                descriptor.type = int(parameter.type_)
            self._parameters[name] = parameter
        if self.publish is not None:
            self.publish(
                self.messages.ParameterEvent(
                    node=self.node_name,
                    new_parameters=new,
                    changed_parameters=changed,
                    deleted_parameters=deleted,
                )
            )
        for callback in self.callbacks.post:
            callback(parameters)

    # Descriptors

    def describe_parameter(self, name: str) -> ParameterDescriptor:
        """Return the descriptor of a parameter; an empty one if undeclared ones are allowed.

        Raises:
            ParameterNotDeclaredException: It is undeclared, and undeclared parameters are not
                allowed.
        """
        descriptor = self._descriptors.get(name)
        if descriptor is not None:
            return copy.deepcopy(descriptor)
        if self.allow_undeclared:
            empty: ParameterDescriptor = self.messages.ParameterDescriptor()
            return empty
        raise ParameterNotDeclaredException(name)

    def describe_parameters(self, names: Iterable[str]) -> list[ParameterDescriptor]:
        """Return several descriptors; see `describe_parameter`."""
        return [self.describe_parameter(name) for name in names]

    def set_descriptor(
        self,
        name: str,
        descriptor: ParameterDescriptor,
        alternative_value: ParameterValue | None = None,
    ) -> ParameterValue:
        """Replace the descriptor of a parameter, and return its resulting value.

        Args:
            name: Name of the parameter.
            descriptor: The new descriptor; its name is ignored.
            alternative_value: The new value if the current one does not fit.

        Raises:
            ParameterNotDeclaredException: The parameter is undeclared, and undeclared parameters
                are not allowed.
            ParameterImmutableException: It is read-only.
            InvalidParameterValueException: Neither value fits the new descriptor.
        """
        if name not in self._parameters:
            return self.get_parameter(name).get_parameter_value()
        if self._descriptors[name].read_only:
            raise ParameterImmutableException(name)
        new = copy.deepcopy(descriptor)
        new.name = name
        candidates = [self.get_parameter(name)]
        if alternative_value is not None:
            message = self.messages.Parameter(name=name, value=alternative_value)
            candidates.append(self.parameter_class.from_parameter_msg(message))
        reason = ""
        for parameter in candidates:
            reason = self._misfit(parameter, new) or ""
            if not reason:
                if new.dynamic_typing:
                    new.type = int(parameter.type_)
                self._parameters[name] = parameter
                self._descriptors[name] = new
                return parameter.get_parameter_value()
        raise InvalidParameterValueException(name, candidates[-1].value, reason)


def as_overrides(overrides: Iterable[Parameter] | Mapping[str, object]) -> dict[str, Parameter]:
    """Return overrides by name, given parameters or a mapping of names to values."""
    if isinstance(overrides, Mapping):
        return {name: Parameter(name, value=value) for name, value in overrides.items()}
    return {parameter.name: parameter for parameter in overrides}


def expect_names(names: Iterable[str]) -> list[str]:
    """Return names as a list, checked.

    Raises:
        TypeError: One is not a str.
    """
    result = list(names)
    if not all(isinstance(name, str) for name in result):
        message = f"All names must be instances of type str; got {brief(result)}"
        raise TypeError(message)
    return result


def is_listed(name: str, prefixes: frozenset[str], depth: int) -> bool:
    """Return whether `list_parameters` includes a name.

    The name's groups are looked up among the prefixes, and not the reverse, as another node may
    send many prefixes.
    """
    if not prefixes:
        return is_shallow(name, depth)
    if name in prefixes:
        return True
    at = name.find(PARAMETER_SEPARATOR_STRING)
    while at >= 0:
        if name[:at] in prefixes and is_shallow(name[at + 1 :], depth):
            return True
        at = name.find(PARAMETER_SEPARATOR_STRING, at + 1)
    return False


def is_shallow(name: str, depth: int) -> bool:
    """Return whether a name has at most `depth` parts; 0 means any number."""
    return depth == 0 or name.count(PARAMETER_SEPARATOR_STRING) < depth


def with_declared_type(parameter: Parameter, descriptor: ParameterDescriptor | None) -> Parameter:
    """Return `parameter`; an empty list, whose type is ambiguous, gets the declared type."""
    if descriptor is None or descriptor.dynamic_typing:
        return parameter
    wanted = ParameterType(descriptor.type)
    is_empty = parameter.type_ is ParameterType.BYTE_ARRAY and not parameter.value
    if is_empty and wanted > ParameterType.BYTE_ARRAY:
        return Parameter(parameter.name, wanted, [])
    return parameter
