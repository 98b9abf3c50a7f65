"""YAML of others: read by PyYAML, within limits of size, depth and number.

A few lines with aliases of aliases stand for billions of values, deep nesting ends the process
inside libyaml, and a number with colons takes minutes: what comes from a file is looked at first.
"""

from __future__ import annotations

from typing import Any, Final

__all__ = ["LARGEST_TEXT", "MOST_VALUES", "checked_yaml", "composed_yaml", "loaded_yaml"]

LARGEST_TEXT: Final = 8 << 20
"""The longest text, in bytes."""

MOST_VALUES: Final = 200_000
"""The most values and keys, where each alias counts as all that it stands for."""

DEEPEST: Final = 100
LONGEST_NUMBER: Final = 400
"""The longest word that may be a number: those of base 60 take the square of their length."""

FROM_CONSTRUCTORS: Final = (
    ArithmeticError,
    AttributeError,
    LookupError,
    RecursionError,
    TypeError,
    ValueError,
)
"""What PyYAML's constructors raise for an empty ``!!int``, a thirteenth month, and the like."""


def checked_yaml(text: str | bytes) -> None:
    """Raise `yaml.YAMLError` if a text is not YAML, or beyond the limits."""
    import yaml

    if len(text) > LARGEST_TEXT:
        raise yaml.YAMLError(f"{len(text)} bytes; at most {LARGEST_TEXT} are read")
    seen = Seen()
    try:
        for event in yaml.parse(text, fast_loader()):
            seen.add(event)
    except ValueError as error:  # a lone surrogate
        raise yaml.YAMLError(str(error)) from error


class Seen:
    """Counts the values of a text, and how deep they are nested."""

    def __init__(self) -> None:
        self.count = 0
        self.sizes: dict[str | None, int] = {}
        """How many values each anchor stands for."""
        self.open: list[tuple[str | None, int]] = []
        """The anchors of the collections that have begun, and the count before each."""

    def add(self, event: Any) -> None:
        """Note what the parser has found; raise `yaml.YAMLError` beyond the limits."""
        import yaml

        if isinstance(event, yaml.AliasEvent):
            self.count += self.sizes.get(event.anchor, 1)
        elif isinstance(event, yaml.CollectionEndEvent):
            anchor, before = self.open.pop()
            self.sizes[anchor] = self.count - before
        elif isinstance(event, yaml.CollectionStartEvent):
            self.open.append((event.anchor, self.count))
            self.count += 1
        elif isinstance(event, yaml.ScalarEvent):
            self.count += 1
            expect_short(event)
        if self.count > MOST_VALUES:
            what = f"more than {MOST_VALUES} values, where aliases count as what they stand for"
        elif len(self.open) > DEEPEST:
            what = f"values nested deeper than {DEEPEST}"
        else:
            return
        raise yaml.MarkedYAMLError(problem=what, problem_mark=event.start_mark)


def expect_short(event: Any) -> None:
    """Raise `yaml.YAMLError` if a value may be a number, and is a very long one."""
    import yaml

    value = event.value
    may_be_number = value[:1] in set("+-.0123456789") and (
        not event.style or (event.tag or "").endswith((":int", ":float"))
    )
    if len(value) > LONGEST_NUMBER and may_be_number and " " not in value:
        problem = f"a number of {len(value)} characters"
        raise yaml.MarkedYAMLError(problem=problem, problem_mark=event.start_mark)


def fast_loader() -> Any:
    """Return PyYAML's safe loader, in C where libyaml is there."""
    import yaml

    return getattr(yaml, "CSafeLoader", yaml.SafeLoader)


def loaded_yaml(text: str | bytes, loader: Any = None) -> Any:
    """Return what a text of others describes, as plain values; None for an empty one.

    Args:
        text: The text.
        loader: A safe loader of PyYAML in place of the usual one.

    Raises:
        yaml.YAMLError: it is no YAML, beyond the limits, or has a value that is none.
    """
    import yaml

    checked_yaml(text)
    try:
        return yaml.load(text, loader or fast_loader())  # noqa: S506  # a safe loader
    except FROM_CONSTRUCTORS as error:
        raise yaml.YAMLError(f"a value cannot be read: {error}") from error


def composed_yaml(text: str | bytes) -> Any:
    """Return the node of a text of others, which has the lines of its values.

    Raises:
        yaml.YAMLError: it is no YAML, or beyond the limits.
    """
    import yaml

    checked_yaml(text)
    return yaml.compose(text, yaml.SafeLoader)
