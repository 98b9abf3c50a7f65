"""Hashes of types."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["Checked", "TypeHash"]

SIZE = 32
PREFIX = "RIHS"


class Checked:
    """An attribute whose values must have a type.

    Args:
        kind: The type.
        convert: Converts other values to that type.
    """

    def __init__(self, kind: Any, convert: Callable[[Any], Any] | None = None) -> None:
        self._kind = kind
        self._convert = convert

    def __set_name__(self, owner: type, name: str) -> None:
        self._slot = f"_{name}"

    def __get__(self, instance: Any, owner: type) -> Any:
        return self if instance is None else getattr(instance, self._slot)

    def __set__(self, instance: Any, value: Any) -> None:
        if self._convert is not None and not isinstance(value, self._kind):
            value = self._convert(value)
        assert isinstance(value, self._kind)  # noqa: S101  # as rclpy does
        setattr(instance, self._slot, value)


class TypeHash:
    """A hash of a type's definition.

    Attributes:
        version: The version of the algorithm; below 1 it is invalid.
        value: Its 32 bytes.
    """

    __slots__ = ("_value", "_version")

    version = Checked(int)
    value = Checked(bytes)

    def __init__(self, version: int = -1, value: bytes = bytes(SIZE)) -> None:
        self.version = version  # noqa: PLE0237  # kept in the slot `_version`
        self.value = value  # noqa: PLE0237  # likewise

    @classmethod
    def from_text(cls, text: str) -> TypeHash:
        """Parse a hash from a text such as ``RIHS01_…``; other texts give an invalid hash."""
        if not text.startswith(PREFIX) or "_" not in text:
            return cls()
        version, _, digits = text.removeprefix(PREFIX).partition("_")
        return cls(int(version), bytes.fromhex(digits))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, TypeHash):
            return False
        return (self.version, self.value) == (other.version, other.value)

    def __hash__(self) -> int:
        return hash((self.version, self.value))

    def __str__(self) -> str:
        if self.version <= 0 or len(self.value) != SIZE:
            return "INVALID"
        return f"{PREFIX}{self.version:02}_{self.value.hex()}"
