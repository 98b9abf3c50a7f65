"""Hashes of types."""

from __future__ import annotations

__all__ = ["TypeHash"]

SIZE = 32
PREFIX = "RIHS"


class TypeHash:
    """A hash of a type's definition.

    Attributes:
        version: How it was made; below 1 it is invalid.
        value: Its 32 bytes.
    """

    __slots__ = ("_value", "_version")

    def __init__(self, version: int = -1, value: bytes = bytes(SIZE)) -> None:
        self.version = version
        self.value = value

    @classmethod
    def from_text(cls, text: str) -> TypeHash:
        """Return the hash in a text such as ``RIHS01_…``; an invalid one for other texts."""
        if not text.startswith(PREFIX) or "_" not in text:
            return cls()
        version, _, digits = text.removeprefix(PREFIX).partition("_")
        return cls(int(version), bytes.fromhex(digits))

    @property
    def version(self) -> int:
        """How it was made."""
        return self._version

    @version.setter
    def version(self, value: int) -> None:
        assert isinstance(value, int)  # noqa: S101  # as rclpy does
        self._version = value

    @property
    def value(self) -> bytes:
        """Its bytes."""
        return self._value

    @value.setter
    def value(self, value: bytes) -> None:
        assert isinstance(value, bytes)  # noqa: S101  # as rclpy does
        self._value = value

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, TypeHash):
            return False
        return (self._version, self._value) == (other._version, other._value)

    def __hash__(self) -> int:
        return hash((self._version, self._value))

    def __str__(self) -> str:
        if self._version <= 0 or len(self._value) != SIZE:
            return "INVALID"
        return f"{PREFIX}{self._version:02}_{self._value.hex()}"
