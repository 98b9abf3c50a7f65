"""The parameters of one node: declared, checked, changed, without input or output.

A change goes through these steps; the first that objects ends it, with nothing changed::

    pre callbacks    may change the list of parameters      not when declaring
    declared?        or undeclared ones are allowed         not when declaring
    descriptor       read-only, type, range
    on callbacks     may reject
    stored
    event            given to `publish`
    post callbacks   may act on it
"""

from __future__ import annotations

import copy
import warnings
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from aionode.errors import (
    InvalidParameterException,
    InvalidParameterTypeException,
    InvalidParameterValueException,
    ParameterAlreadyDeclaredException,
    ParameterImmutableException,
    ParameterNotDeclaredException,
    ParameterUninitializedException,
    brief,
)
from aionode.interfaces.rcl_interfaces.msg import (
    ListParametersResult,
    ParameterDescriptor,
    ParameterEvent,
    ParameterValue,
    SetParametersResult,
)
from aionode.interfaces.rcl_interfaces.msg import Parameter as ParameterMsg
from aionode.parameter._constraints import descriptor_violation, type_violation
from aionode.parameter._value import (
    PARAMETER_SEPARATOR_STRING,
    Parameter,
    ParameterType,
    expect,
    parameter_value_to_python,
)

__all__ = [
    "OnSetCallback",
    "ParameterCallbacks",
    "ParameterStore",
    "PostSetCallback",
    "PreSetCallback",
    "validate_parameter_name",
]

PreSetCallback = Callable[[list[Parameter]], list[Parameter]]
OnSetCallback = Callable[[list[Parameter]], SetParametersResult]
PostSetCallback = Callable[[list[Parameter]], None]

EMPTY_LIST = (
    "parameter list cannot be empty, this might be due to pre_set_parameters_callback "
    "modifying the original parameters list."
)


def validate_parameter_name(name: str) -> bool:
    """Return True if `name` may be a parameter's: if it is not empty.

    Raises:
        InvalidParameterException: It may not.
    """
    if not name:
        raise InvalidParameterException(name)
    return True


class ParameterCallbacks:
    """The callbacks of a node for changes of its parameters; the newest of each kind runs first."""

    def __init__(self) -> None:
        self._pre: list[PreSetCallback] = []
        self._on: list[OnSetCallback] = []
        self._post: list[PostSetCallback] = []

    def add_pre_set_parameters_callback(self, callback: PreSetCallback) -> None:
        """Call `callback` before a change is checked: it returns the list to go on with."""
        self._pre.insert(0, callback)

    def add_on_set_parameters_callback(self, callback: OnSetCallback) -> None:
        """Call `callback` to check a change: the first that rejects it wins."""
        self._on.insert(0, callback)

    def add_post_set_parameters_callback(self, callback: PostSetCallback) -> None:
        """Call `callback` after a change."""
        self._post.insert(0, callback)

    def remove_pre_set_parameters_callback(self, callback: PreSetCallback) -> None:
        """Call it no more; a ValueError if it was not added."""
        self._pre.remove(callback)

    def remove_on_set_parameters_callback(self, callback: OnSetCallback) -> None:
        """Call it no more; a ValueError if it was not added."""
        self._on.remove(callback)

    def remove_post_set_parameters_callback(self, callback: PostSetCallback) -> None:
        """Call it no more; a ValueError if it was not added."""
        self._post.remove(callback)

    def _modified(self, parameters: list[Parameter]) -> list[Parameter]:
        # As in rclpy, each callback gets the original list, and all answers count.
        if not self._pre:
            return parameters
        result: list[Parameter] = []
        for callback in self._pre:
            returned = callback(parameters)
            expect(returned, list, f"what the pre-set callback {callback!r} returns")
            result.extend(returned)
        return result

    def _rejection(self, parameters: list[Parameter]) -> SetParametersResult | None:
        for callback in self._on:
            result = callback(parameters)
            expect(result, SetParametersResult, f"what the on-set callback {callback!r} returns")
            if not result.successful:
                return result
        return None


class ParameterStore(ParameterCallbacks):
    """The parameters of one node.

    Args:
        node_name: Full name of the node, for its events.
        overrides: Values that win over those given when declaring.
        allow_undeclared: Whether parameters may be set without being declared.
        publish: Called with the event of each change, before the post callbacks; its stamp is not
            set.

    Attributes:
        overrides: The overrides, by name.
        asked: Names of those overrides that were declared at some time.
        publish: As given; may be changed.
    """

    def __init__(
        self,
        node_name: str,
        *,
        overrides: Iterable[Parameter] | Mapping[str, object] = (),
        allow_undeclared: bool = False,
        publish: Callable[[ParameterEvent], None] | None = None,
    ) -> None:
        super().__init__()
        self.node_name = node_name
        self.overrides = as_overrides(overrides)
        self.asked: set[str] = set()
        self.allow_undeclared = allow_undeclared
        self.publish = publish
        self._parameters: dict[str, Parameter] = {}
        self._descriptors: dict[str, ParameterDescriptor] = {}

    def names(self) -> list[str]:
        """Return the names of all parameters that are declared."""
        return list(self._parameters)

    # Declaring

    def declare_parameter(
        self,
        name: str,
        value: Any = None,
        descriptor: ParameterDescriptor | None = None,
        ignore_override: bool = False,
    ) -> Parameter:
        """Declare a parameter and return it, with the value of an override if there is one.

        Args:
            name: Its name.
            value: Its value to begin with, or its type (`Parameter.Type`) if it is to have none.
            descriptor: What is known of it. Without `dynamic_typing` its type stays that of
                `value`.
            ignore_override: Whether overrides are left aside.

        Raises:
            ParameterAlreadyDeclaredException: It was declared before.
            InvalidParameterException: The name is empty.
            InvalidParameterTypeException: The override is of another type than `value`.
            InvalidParameterValueException: The descriptor or a callback rejects the value.
        """
        if value is None and descriptor is None:
            return self.declare_parameters("", [(name,)], ignore_override)[0]
        entry = (name, value, ParameterDescriptor() if descriptor is None else descriptor)
        return self.declare_parameters("", [entry], ignore_override)[0]

    def declare_parameters(
        self,
        namespace: str,
        parameters: Iterable[tuple[Any, ...]],
        ignore_override: bool = False,
    ) -> list[Parameter]:
        """Declare parameters, given as ``(name, value or type, descriptor)``, in order.

        If one is rejected, those before it stay declared. See `declare_parameter`.

        Args:
            namespace: Put in front of the names, with a dot, unless it is empty.
            parameters: One tuple of 1 to 3 elements for each.
            ignore_override: Whether overrides are left aside.

        Raises:
            TypeError: A tuple is none of these.
        """
        declarations = [
            self._declaration(namespace, entry, index, ignore_override)
            for index, entry in enumerate(parameters)
        ]
        known = [each.name for each, _ in declarations if each.name in self._parameters]
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
        descriptor = copy.deepcopy(given)
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
        parameter = first_value(name, value, descriptor)
        if not ignore_override and name in self.overrides:
            parameter = adapted(self.overrides[name], descriptor)
        return parameter, descriptor

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
        """Forget a parameter. Neither callbacks nor an event tell of it.

        Raises:
            ParameterNotDeclaredException: There is none of this name.
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
        """Return a parameter; one that is not set if it is undeclared and that is allowed.

        Raises:
            ParameterNotDeclaredException: It is undeclared, and that is not allowed.
            ParameterUninitializedException: It was declared without a value and has none yet.
        """
        parameter = self._parameters.get(name)
        if parameter is None:
            if self.allow_undeclared:
                return Parameter(name)
            raise ParameterNotDeclaredException(name)
        if parameter.type_ is ParameterType.NOT_SET and not self._descriptors[name].dynamic_typing:
            raise ParameterUninitializedException(name)
        return parameter

    def get_parameters(self, names: Iterable[str]) -> list[Parameter]:
        """Return parameters, as `get_parameter` does each.

        Raises:
            TypeError: A name is no str.
        """
        return [self.get_parameter(name) for name in expect_names(names)]

    def get_parameter_or(self, name: str, alternative_value: Parameter | None = None) -> Parameter:
        """Return a parameter, or the alternative if it is undeclared or not set."""
        parameter = self._parameters.get(name)
        if parameter is not None and parameter.type_ is not ParameterType.NOT_SET:
            return parameter
        return Parameter(name) if alternative_value is None else alternative_value

    def get_parameter_type(self, name: str) -> ParameterType:
        """Return the type of a parameter; NOT_SET if it is undeclared and that is allowed.

        Raises:
            ParameterNotDeclaredException: It is undeclared, and that is not allowed.
        """
        if name in self._parameters:
            return self._parameters[name].type_
        if self.allow_undeclared:
            return ParameterType.NOT_SET
        raise ParameterNotDeclaredException(name)

    def get_parameter_types(self, names: Iterable[str]) -> list[ParameterType]:
        """Return types, as `get_parameter_type` does each.

        Raises:
            TypeError: A name is no str.
        """
        return [self.get_parameter_type(name) for name in expect_names(names)]

    def get_parameters_by_prefix(self, prefix: str) -> dict[str, Parameter]:
        """Return the parameters of a group, by what follows its name and the dot."""
        start = f"{prefix}{PARAMETER_SEPARATOR_STRING}" if prefix else ""
        return {
            name[len(start) :]: parameter
            for name, parameter in self._parameters.items()
            if name.startswith(start)
        }

    def list_parameters(self, prefixes: list[str], depth: int) -> ListParametersResult:
        """Return the names of parameters, and the groups they are in.

        Args:
            prefixes: Only parameters of these names and groups; all if it is empty.
            depth: How many levels below; 0 means all.

        Raises:
            TypeError: An argument is of a wrong kind.
            ValueError: `depth` is negative.
        """
        expect(prefixes, list, "prefixes")
        expect_names(prefixes)
        expect(depth, int, "depth")
        if depth < 0:
            message = f"The depth must be greater than or equal to zero, not {depth}"
            raise ValueError(message)
        result = ListParametersResult(names=[], prefixes=[])
        for name in self._parameters:
            if is_listed(name, prefixes, depth):
                result.names.append(name)
                group = name.rpartition(PARAMETER_SEPARATOR_STRING)[0]
                if group and group not in result.prefixes:
                    result.prefixes.append(group)
        return result

    # Changing

    def set_parameters(self, parameter_list: Iterable[Parameter]) -> list[SetParametersResult]:
        """Set parameters one after the other, and return a result for each, in order.

        Raises:
            ParameterNotDeclaredException: One is undeclared, and that is not allowed; those before
                it stay set.
            TypeError: One is no Parameter.
        """
        return [self.set_parameters_atomically([parameter]) for parameter in parameter_list]

    def set_parameters_atomically(self, parameter_list: Iterable[Parameter]) -> SetParametersResult:
        """Set all parameters, or none of them. Setting one to NOT_SET undeclares it.

        Raises:
            ParameterNotDeclaredException: One is undeclared, and that is not allowed.
            TypeError: One is no Parameter.
        """
        parameters = self._modified(list(parameter_list))
        for parameter in parameters:
            expect(parameter, Parameter, "parameter")
        if self._pre and not parameters:
            return SetParametersResult(successful=False, reason=EMPTY_LIST)
        # Of several for one name, as from several callbacks, the last counts.
        parameters = list({parameter.name: parameter for parameter in parameters}.values())
        parameters = [adapted(each, self._descriptors.get(each.name)) for each in parameters]
        undeclared = [each.name for each in parameters if each.name not in self._parameters]
        if undeclared and not self.allow_undeclared:
            raise ParameterNotDeclaredException(undeclared)
        if reason := self._violation(parameters):
            return SetParametersResult(successful=False, reason=reason)
        if rejected := self._rejection(parameters):
            return rejected
        self._store(parameters)
        return SetParametersResult(successful=True, reason="")

    def _violation(self, parameters: list[Parameter]) -> str | None:
        for parameter in parameters:
            descriptor = self._descriptors.get(parameter.name)
            if descriptor is None:
                continue
            if descriptor.read_only:
                return f"Trying to set a read-only parameter: {parameter.name}."
            reason = type_violation(parameter, descriptor, declared=True)
            if reason := reason or descriptor_violation(parameter, descriptor):
                return reason
        return None

    def _store(self, parameters: list[Parameter], *, keep_not_set: bool = False) -> None:
        new: list[ParameterMsg] = []
        changed: list[ParameterMsg] = []
        deleted: list[ParameterMsg] = []
        for parameter in parameters:
            name = parameter.name
            if parameter.type_ is ParameterType.NOT_SET and not keep_not_set:
                deleted.append(parameter.to_parameter_msg())
                self._parameters.pop(name, None)
                self._descriptors.pop(name, None)
                continue
            before = self.get_parameter_or(name).type_
            (new if before is ParameterType.NOT_SET else changed).append(
                parameter.to_parameter_msg()
            )
            descriptor = self._descriptors.setdefault(
                name, ParameterDescriptor(name=name, dynamic_typing=True)
            )
            if descriptor.dynamic_typing:
                descriptor.type = int(parameter.type_)
            self._parameters[name] = parameter
        if self.publish is not None:
            self.publish(
                ParameterEvent(
                    node=self.node_name,
                    new_parameters=new,
                    changed_parameters=changed,
                    deleted_parameters=deleted,
                )
            )
        for callback in self._post:
            callback(parameters)

    # Descriptors

    def describe_parameter(self, name: str) -> ParameterDescriptor:
        """Return the descriptor of a parameter; an empty one if undeclared ones are allowed.

        Raises:
            ParameterNotDeclaredException: It is undeclared, and that is not allowed.
        """
        descriptor = self._descriptors.get(name)
        if descriptor is not None:
            return copy.deepcopy(descriptor)
        if self.allow_undeclared:
            return ParameterDescriptor()
        raise ParameterNotDeclaredException(name)

    def describe_parameters(self, names: Iterable[str]) -> list[ParameterDescriptor]:
        """Return descriptors, as `describe_parameter` does each."""
        return [self.describe_parameter(name) for name in names]

    def set_descriptor(
        self,
        name: str,
        descriptor: ParameterDescriptor,
        alternative_value: ParameterValue | None = None,
    ) -> ParameterValue:
        """Give a parameter another descriptor, and return its value then.

        Args:
            name: Name of the parameter.
            descriptor: The new descriptor; its name is ignored.
            alternative_value: The parameter's new value if the one it has does not fit.

        Raises:
            ParameterNotDeclaredException: The parameter is undeclared, and that is not allowed.
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
            candidates.append(Parameter(name, value=parameter_value_to_python(alternative_value)))
        reason = ""
        for parameter in candidates:
            reason = (
                type_violation(parameter, new, declared=True)
                or descriptor_violation(parameter, new)
                or ""
            )
            if not reason:
                if new.dynamic_typing:
                    new.type = int(parameter.type_)
                self._parameters[name] = parameter
                self._descriptors[name] = new
                return parameter.get_parameter_value()
        raise InvalidParameterValueException(name, candidates[-1].value, reason)


# Parts of declarations


def as_overrides(overrides: Iterable[Parameter] | Mapping[str, object]) -> dict[str, Parameter]:
    """Return overrides by name, from parameters or from names and values."""
    if isinstance(overrides, Mapping):
        return {name: Parameter(name, value=value) for name, value in overrides.items()}
    return {parameter.name: parameter for parameter in overrides}


def split_entry(entry: tuple[Any, ...], index: int) -> tuple[str, Any, ParameterDescriptor]:
    """Return name, value and descriptor of an entry of `declare_parameters`."""
    if not 1 <= len(entry) <= 3:
        message = (
            f"Invalid parameter tuple length at index {index} in parameters list: {entry}; "
            "expecting length between 1 and 3"
        )
        raise TypeError(message)
    name, value, descriptor = (*entry, *(None, None))[:3]
    if descriptor is None:
        descriptor = ParameterDescriptor()
    expect(name, str, f"First element at index {index} in parameters list")
    expect(descriptor, ParameterDescriptor, f"Third element at index {index} in parameters list")
    for ranges in (descriptor.integer_range, descriptor.floating_point_range):
        if len(ranges) > 1:
            message = f"{name}: the descriptor has {len(ranges)} ranges; it may have one"
            raise ValueError(message)
    return name, value, descriptor


def first_value(name: str, value: Any, descriptor: ParameterDescriptor) -> Parameter:
    """Return the parameter as declared, and note its type in the descriptor.

    Raises:
        ValueError: The type cannot be told.
    """
    if isinstance(value, ParameterType):
        if value is ParameterType.NOT_SET:
            message = f"Cannot declare parameter '{name}' as statically typed of type NOT_SET"
            raise ValueError(message)
        if descriptor.dynamic_typing:
            message = (
                f"When declaring parameter '{name}' passing a descriptor with "
                "`dynamic_typing=True` is not allowed when the parameter type is provided"
            )
            raise ValueError(message)
        descriptor.type = int(value)
        return Parameter(name)
    if isinstance(value, ParameterValue):
        parameter = Parameter.from_parameter_msg(ParameterMsg(name=name, value=value))
    else:
        parameter = Parameter(name, value=value)
    if not descriptor.dynamic_typing and parameter.type_ is ParameterType.NOT_SET:
        message = (
            f"Cannot declare the statically typed parameter '{name}' with a default value of type "
            "PARAMETER_NOT_SET: give a value, a Parameter.Type, or dynamic_typing=True"
        )
        raise ValueError(message)
    descriptor.type = int(parameter.type_)
    return parameter


def adapted(parameter: Parameter, descriptor: ParameterDescriptor | None) -> Parameter:
    """Return an empty list, whose type cannot be seen, as a list of the declared type."""
    if descriptor is None or descriptor.dynamic_typing:
        return parameter
    wanted = ParameterType(descriptor.type)
    is_empty = parameter.type_ is ParameterType.BYTE_ARRAY and not parameter.value
    if is_empty and wanted > ParameterType.BYTE_ARRAY:
        return Parameter(parameter.name, wanted, [])
    return parameter


def expect_names(names: Iterable[str]) -> list[str]:
    """Return names as a list.

    Raises:
        TypeError: One is no str.
    """
    result = list(names)
    if not all(isinstance(name, str) for name in result):
        message = f"All names must be instances of type str, unlike in {brief(result)}"
        raise TypeError(message)
    return result


def is_listed(name: str, prefixes: list[str], depth: int) -> bool:
    """Return whether `list_parameters` lists a name."""
    if not prefixes:
        return is_shallow(name, depth)
    return any(
        name == prefix
        or (
            name.startswith(prefix + PARAMETER_SEPARATOR_STRING)
            and is_shallow(name[len(prefix) + 1 :], depth)
        )
        for prefix in prefixes
    )


def is_shallow(name: str, depth: int) -> bool:
    """Return whether a name has at most `depth` parts; 0 means any number."""
    return depth == 0 or name.count(PARAMETER_SEPARATOR_STRING) < depth
