"""Messages as dictionaries, YAML and comma-separated values."""

from __future__ import annotations

import sys
from collections import OrderedDict
from typing import Any

import yaml

from aionode.message.conversion import Form, plain
from rosidl_generator_py import to_aionode

__all__ = [
    "get_message_slot_types",
    "message_to_csv",
    "message_to_ordereddict",
    "message_to_yaml",
]


def get_message_slot_types(msg: Any) -> OrderedDict[str, Any]:
    """Return the type of each field of a message, or of a message class."""
    return OrderedDict(zip(msg.get_fields_and_field_types(), msg.SLOT_TYPES, strict=True))


def message_to_ordereddict(
    msg: Any, *, truncate_length: int | None = None, no_arr: bool = False, no_str: bool = False
) -> OrderedDict[str, Any]:
    """Return a message as a dictionary of numbers, strings, lists and dictionaries.

    Args:
        msg: The message.
        truncate_length: The largest number of elements or characters that are shown.
        no_arr: Show type and length instead of arrays and sequences.
        no_str: Show the length instead of strings.
    """
    form = Form(as_byte=chr, truncate=truncate_length, no_arr=no_arr, no_str=no_str)
    mapping: OrderedDict[str, Any] = ordered(plain(to_aionode(msg), form))
    return mapping


def ordered(value: Any) -> Any:
    """Return a value with an `OrderedDict` in place of each dict."""
    if isinstance(value, dict):
        return OrderedDict((name, ordered(part)) for name, part in value.items())
    return list(map(ordered, value)) if isinstance(value, list) else value


def message_to_yaml(
    msg: Any,
    *,
    truncate_length: int | None = None,
    no_arr: bool = False,
    no_str: bool = False,
    flow_style: bool = False,
) -> str:
    """Return a message as YAML; see `message_to_ordereddict`."""
    form = Form(as_byte=chr, truncate=truncate_length, no_arr=no_arr, no_str=no_str)
    text: str = yaml.dump(
        plain(to_aionode(msg), form),
        allow_unicode=True,
        width=sys.maxsize,
        default_flow_style=flow_style,
        sort_keys=False,
    )
    return text


def message_to_csv(
    msg: Any, *, truncate_length: int | None = None, no_arr: bool = False, no_str: bool = False
) -> str:
    """Return the values of a message in a line; see `message_to_ordereddict`."""
    form = Form(
        as_float=lambda number: number,  # numpy's float32 prints fewer digits than float
        as_byte=lambda number: bytes((number,)),
        elements=list,
        truncate=truncate_length,
        no_arr=no_arr,
        no_str=no_str,
    )
    return line(plain(to_aionode(msg), form))


def line(value: Any) -> str:
    """Return the values in a dict or list, separated by commas."""
    if isinstance(value, dict | list):
        return ",".join(map(line, value.values() if isinstance(value, dict) else value))
    return str(value)
