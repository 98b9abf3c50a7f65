"""The six parameter services of a node."""

from __future__ import annotations

from collections.abc import Callable, Sequence, Sized
from typing import Any, Final, Protocol

from msgspec import Struct

from aionode.errors import (
    ParameterNotDeclaredException,
    ParameterUninitializedException,
    RequestRefusedError,
)
from aionode.interfaces.rcl_interfaces import srv
from aionode.interfaces.rcl_interfaces.msg import (
    ListParametersResult,
    ParameterValue,
    SetParametersResult,
)
from aionode.interfaces.rcl_interfaces.msg import Parameter as ParameterMsg
from aionode.parameter._value import Parameter

__all__ = ["ParameterService", "parameter_services"]

MAX_NAMES: Final = 10_000
"""Maximum names or values in one request; `ros2 param dump` asks for all of a node."""

MAX_SET: Final = 2_000
"""Maximum parameters set by one request: each is checked, and published as an event."""

MAX_REPEATED: Final = 1_000
"""Maximum names in a request that repeats some; otherwise the node's own number is the limit."""

MAX_ANSWER: Final = 2**24
"""Maximum bytes of the values in one answer: a request may repeat a name many times."""

MAX_HELD: Final = 2**26
"""Maximum bytes of all values of a node once other nodes have set some."""

PARAMETER_BYTES: Final = 500
"""Approximate memory of a parameter besides its value."""


class ParameterService(Struct, frozen=True):
    """One service, to be created by ``node.create_service(srv_type, f"~/{name}", callback)``.

    Attributes:
        name: Its name relative to the node.
        srv_type: Its type.
        callback: Answers a request.
    """

    name: str
    srv_type: Any
    callback: Callable[[Any, Any], Any]


class Parameters(Protocol):
    """What the services read and set: a `ParameterStore`, or a node with its methods."""

    def describe_parameters(self, names: Any) -> list[Any]: ...
    def get_parameters(self, names: Any) -> list[Any]: ...
    def get_parameter_types(self, names: Any) -> list[Any]: ...
    def get_parameters_by_prefix(self, prefix: str) -> dict[str, Any]: ...
    def list_parameters(self, prefixes: Any, depth: int) -> ListParametersResult: ...
    def set_parameters_atomically(self, parameter_list: Any) -> SetParametersResult: ...


def parameter_services(
    parameters: Parameters,
    parameter_class: type[Parameter] = Parameter,
    services: Any = srv,
    result_class: Any = SetParametersResult,
    refusals: tuple[type[Exception], ...] = (ParameterNotDeclaredException,),
) -> list[ParameterService]:
    """Return the services through which other nodes read and set the parameters of a node.

    Args:
        parameters: The parameters.
        parameter_class: Their class.
        services: The service classes, by name.
        result_class: The class of SetParametersResult.
        refusals: The errors that leave everything unchanged, whose texts the caller gets as
            reasons.
    """
    answers = Answers(parameters, parameter_class, result_class, refusals)
    return [
        ParameterService("describe_parameters", services.DescribeParameters, answers.describe),
        ParameterService("get_parameters", services.GetParameters, answers.get_values),
        ParameterService("get_parameter_types", services.GetParameterTypes, answers.get_types),
        ParameterService("list_parameters", services.ListParameters, answers.list_names),
        ParameterService("set_parameters", services.SetParameters, answers.set_each),
        ParameterService(
            "set_parameters_atomically", services.SetParametersAtomically, answers.set_atomically
        ),
    ]


class Answers:
    """The callbacks of the services.

    If one of several names is undeclared, reads answer with an empty list: these services have no
    other way to say so.

    Each raises `RequestRefusedError` for a request or an answer that exceeds the limits above.
    """

    def __init__(
        self,
        parameters: Parameters,
        parameter_class: type[Parameter],
        result_class: Any,
        refusals: tuple[type[Exception], ...],
    ) -> None:
        self.parameters = parameters
        self.parameter_class = parameter_class
        self.result_class = result_class
        self.refusals = refusals

    def describe(
        self, request: srv.DescribeParameters.Request, response: srv.DescribeParameters.Response
    ) -> srv.DescribeParameters.Response:
        """Answer describe_parameters."""
        refuse_many(request.names)
        try:
            descriptors = each_once(request.names, self.parameters.describe_parameters)
        except ParameterNotDeclaredException:
            return response
        sizes = {name: descriptor_size(descriptor) for name, descriptor in descriptors.items()}
        refuse_large(sum(sizes[name] for name in request.names), "descriptions")
        response.descriptors = [descriptors[name] for name in request.names]
        return response

    def get_values(
        self, request: srv.GetParameters.Request, response: srv.GetParameters.Response
    ) -> srv.GetParameters.Response:
        """Answer get_parameters."""
        refuse_many(request.names)
        try:
            parameters = each_once(request.names, self.parameters.get_parameters)
        except (ParameterNotDeclaredException, ParameterUninitializedException):
            return response
        sizes = {name: size_of(parameter.value) for name, parameter in parameters.items()}
        refuse_large(sum(sizes[name] for name in request.names), "values")
        values = {name: parameter.get_parameter_value() for name, parameter in parameters.items()}
        response.values = [values[name] for name in request.names]
        return response

    def get_types(
        self, request: srv.GetParameterTypes.Request, response: srv.GetParameterTypes.Response
    ) -> srv.GetParameterTypes.Response:
        """Answer get_parameter_types."""
        refuse_many(request.names)
        try:
            response.types = bytes(self.parameters.get_parameter_types(list(request.names)))
        except ParameterNotDeclaredException:
            response.types = b""
        return response

    def list_names(
        self, request: srv.ListParameters.Request, response: srv.ListParameters.Response
    ) -> srv.ListParameters.Response:
        """Answer list_parameters."""
        refuse_many(request.prefixes)
        response.result = self.parameters.list_parameters(list(request.prefixes), request.depth)
        return response

    def set_each(
        self, request: srv.SetParameters.Request, response: srv.SetParameters.Response
    ) -> srv.SetParameters.Response:
        """Answer set_parameters: one by one, in order."""
        refuse_many(request.parameters, MAX_SET)
        self._refuse_hoard(request.parameters)
        response.results = [self._set([message]) for message in request.parameters]
        return response

    def set_atomically(
        self,
        request: srv.SetParametersAtomically.Request,
        response: srv.SetParametersAtomically.Response,
    ) -> srv.SetParametersAtomically.Response:
        """Answer set_parameters_atomically: all or none."""
        refuse_many(request.parameters, MAX_SET)
        self._refuse_hoard(request.parameters)
        response.result = self._set(request.parameters)
        return response

    def _refuse_hoard(self, messages: list[ParameterMsg]) -> None:
        """Refuse values that, with the existing ones, exceed what a node keeps.

        Raises:
            RequestRefusedError: they are too large or too many.
        """
        new_bytes = sum(len(message.name) + size_of_message(message.value) for message in messages)
        held = self.parameters.get_parameters_by_prefix("")
        held_bytes = sum(
            PARAMETER_BYTES + len(name) + size_of(message.value) for name, message in held.items()
        )
        if new_bytes + PARAMETER_BYTES * len(messages) + held_bytes > MAX_HELD:
            raise RequestRefusedError(
                f"the parameters of this node have {held_bytes} bytes, and these {new_bytes}; a "
                f"node keeps at most {MAX_HELD} that others have set"
            )

    def _set(self, messages: list[ParameterMsg]) -> SetParametersResult:
        try:
            parameters = list(map(self.parameter_class.from_parameter_msg, messages))
        except ValueError as error:  # an unknown type
            return self._failure(error)
        try:
            return self.parameters.set_parameters_atomically(parameters)
        except self.refusals as error:
            return self._failure(error)

    def _failure(self, error: Exception) -> SetParametersResult:
        result: SetParametersResult = self.result_class(reason=str(error))
        return result


def each_once(names: Sequence[str], read: Callable[[Any], list[Any]]) -> dict[str, Any]:
    """Read each name once and return all results; only short requests may repeat names.

    Raises:
        RequestRefusedError: many are requested, some of them repeatedly.
    """
    unique = list(dict.fromkeys(names))
    if len(unique) < len(names) and len(names) > MAX_REPEATED:
        raise RequestRefusedError(
            f"the request has {len(names)} names, but only {len(unique)} different ones; ask for "
            f"each once, or for at most {MAX_REPEATED}"
        )
    return dict(zip(unique, read(unique), strict=True))


def refuse_large(size_bytes: int, what: str) -> None:
    """Refuse an answer that is too large.

    Raises:
        RequestRefusedError: it has more than `MAX_ANSWER` bytes.
    """
    if size_bytes > MAX_ANSWER:
        raise RequestRefusedError(
            f"the {what} have {size_bytes} bytes, at most {MAX_ANSWER} fit into an answer; "
            "ask for fewer parameters at once"
        )


def refuse_many(items: Sequence[object], max_items: int = MAX_NAMES) -> None:
    """Refuse a request with more items than any tool sends.

    Raises:
        RequestRefusedError: there are more than `max_items`.
    """
    if len(items) > max_items:
        raise RequestRefusedError(
            f"the request has {len(items)} names, at most {max_items} fit; ask in several requests"
        )


def descriptor_size(descriptor: Any) -> int:
    """Estimate how many bytes a descriptor takes in an answer."""
    texts = descriptor.name, descriptor.description, descriptor.additional_constraints
    return PARAMETER_BYTES + sum(map(len, texts))


def size_of_message(value: ParameterValue) -> int:
    """Estimate how many bytes the value in a request takes."""
    arrays = (
        value.string_value,
        value.byte_array_value,
        value.bool_array_value,
        value.integer_array_value,
        value.double_array_value,
        value.string_array_value,
    )
    return sum(map(size_of, arrays))


def size_of(value: object) -> int:
    """Estimate how many bytes the value of a parameter takes in an answer."""
    if isinstance(value, str | bytes):
        return len(value)
    if isinstance(value, Sized):
        strings = isinstance(value, list) and value and isinstance(value[0], str)
        return sum(map(len, value)) if strings else 8 * len(value)  # type: ignore[call-overload]  # a list of strings
    return 8
