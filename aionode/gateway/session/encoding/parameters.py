"""Parameter values in JSON, which distinguishes neither doubles from integers nor list types."""

from __future__ import annotations

import base64
import binascii
from typing import Any, Final

from aionode.errors import MessageError
from aionode.gateway.session.encoding.client_json import check_items
from aionode.parameter import Parameter, ParameterType

__all__ = ["HINTS", "depends_on_type", "parameter_of"]

HINTS: Final = {
    "byte_array": ParameterType.BYTE_ARRAY,
    "float64": ParameterType.DOUBLE,
    "float64_array": ParameterType.DOUBLE_ARRAY,
}
"""The types that a client can name beside a value, as Foxglove's clients do."""


def depends_on_type(value: Any) -> bool:
    """Return whether the meaning of a value depends on the type of the parameter."""
    return value == [] or any(
        type(item) is int for item in (value if isinstance(value, list) else [value])
    )


def parameter_of(name: str, value: Any, now: ParameterType, hint: str | None = None) -> Parameter:
    """Return the parameter that a client has specified.

    Args:
        name: Its name within its node.
        value: The value in JSON; None undeclares the parameter.
        now: Its current type: 2 becomes a double if the parameter is one, as does each number of a
            list that mixes 3.5 and 4.
        hint: The type named by the client, one of `HINTS`; bytes are given in Base64.

    Raises:
        MessageError: parameters cannot have such a value (a ValueError).
    """
    check_items(value, name)
    type_ = HINTS.get(hint or "", now)
    try:
        if value is None:
            return Parameter(name)
        if hint == "byte_array":
            data = base64.b64decode(value, validate=True)
            return Parameter(name, type_, [bytes([byte]) for byte in data])
        if hint in HINTS or (value == [] and now.check([])):
            return Parameter(name, type_, as_real(value, type_))
        return Parameter(name, value=as_real(value, type_))
    except (TypeError, ValueError, OverflowError, binascii.Error) as error:
        raise MessageError(name[:200], str(error)) from None


def as_real(value: Any, type_: ParameterType) -> Any:
    """Return whole numbers as doubles if the parameter has doubles, or the list mixes both."""
    if isinstance(value, list):
        is_mixed = any(isinstance(item, float) for item in value)
        if is_mixed or type_ is ParameterType.DOUBLE_ARRAY:
            return [as_real(item, ParameterType.DOUBLE) for item in value]
        return value
    return float(value) if type_ is ParameterType.DOUBLE and type(value) is int else value
