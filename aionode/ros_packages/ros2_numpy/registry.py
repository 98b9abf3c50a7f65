"""The functions that convert each message to numpy, and back."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, TypeVar

__all__ = ["converts_from_numpy", "converts_to_numpy", "msgify", "numpify"]

Converter = TypeVar("Converter", bound=Callable[..., Any])

TO_NUMPY: dict[tuple[type[Any], bool], Callable[..., Any]] = {}
FROM_NUMPY: dict[tuple[type[Any], bool], Callable[..., Any]] = {}


def converts_to_numpy(msgtype: type[Any], plural: bool = False) -> Callable[[Converter], Converter]:
    """Return a decorator for a function that `numpify` calls.

    Args:
        msgtype: The class of the messages.
        plural: Whether it takes a sequence of them.
    """

    def decorate(converter: Converter) -> Converter:
        TO_NUMPY[msgtype, plural] = converter
        return converter

    return decorate


def converts_from_numpy(
    msgtype: type[Any], plural: bool = False
) -> Callable[[Converter], Converter]:
    """Return a decorator for a function that `msgify` calls; see `converts_to_numpy`."""

    def decorate(converter: Converter) -> Converter:
        FROM_NUMPY[msgtype, plural] = converter
        return converter

    return decorate


def numpify(msg: Any, *args: Any, **kwargs: Any) -> Any:
    """Return a message, or a sequence of messages, in numpy form; None for None.

    Args:
        msg: The message.
        args: Further arguments of its converter.
        kwargs: Keyword arguments of its converter.

    Raises:
        ValueError: No converter is known, or the sequence is empty.
    """
    if msg is None:
        return None
    converter = TO_NUMPY.get((type(msg), False))
    if converter is None and isinstance(msg, Sequence):
        if not msg:
            raise ValueError("the sequence is empty, so the type of its messages is unknown")
        converter = TO_NUMPY.get((type(msg[0]), True))
    if converter is None:
        raise ValueError(f"{type(msg).__name__} cannot be converted; use one of {known(TO_NUMPY)}")
    return converter(msg, *args, **kwargs)


def msgify(msg_type: type[Any], numpy_obj: Any, *args: Any, **kwargs: Any) -> Any:
    """Return a message of a type, created from an array.

    Args:
        msg_type: The class of the message.
        numpy_obj: The array.
        args: Further arguments of the converter.
        kwargs: Keyword arguments of the converter; ``plural=True`` creates a sequence of messages.

    Raises:
        ValueError: No converter is known.
    """
    converter = FROM_NUMPY.get((msg_type, kwargs.pop("plural", False)))
    if converter is None:
        raise ValueError(f"{msg_type.__name__} cannot be created; use one of {known(FROM_NUMPY)}")
    return converter(numpy_obj, *args, **kwargs)


def known(converters: dict[tuple[type[Any], bool], Callable[..., Any]]) -> str:
    """Return the names of the messages that can be converted."""
    return ", ".join(cls.__name__ + "[]" * plural for cls, plural in converters)
