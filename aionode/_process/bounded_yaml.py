"""YAML of others: read by PyYAML, within limits of size, depth and number.

A few lines with aliases of aliases stand for billions of values, deep nesting ends the process
inside libyaml, and a number with colons takes minutes: what comes from a file is looked at first.
"""

from __future__ import annotations

import os
from typing import Any, Final

__all__ = [
    "LARGEST_TEXT",
    "MOST_VALUES",
    "VALUES_VARIABLE",
    "checked_yaml",
    "composed_yaml",
    "documents_in",
    "fast_loader",
    "loaded_yaml",
    "most_values",
    "value_of_node",
]

LARGEST_TEXT: Final = 8 << 20
"""The longest text, in bytes."""

MOST_VALUES: Final = 80_000
"""The most values and keys, where each alias counts as all that it stands for: a second's work."""

VALUES_VARIABLE: Final = "AIONODE_YAML_VALUES"
"""The variable of the environment that sets another number."""

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


def most_values() -> int:
    """Return how many values a text may have."""
    given = os.environ.get(VALUES_VARIABLE, "")
    return int(given) if given.isascii() and given.isdigit() else MOST_VALUES


def checked_yaml(text: str | bytes) -> None:
    """Raise `yaml.YAMLError` if a text is not YAML, or beyond the limits."""
    import yaml

    if len(text) > LARGEST_TEXT:
        problem = f"{len(text)} bytes; at most {LARGEST_TEXT} are read"
        raise yaml.MarkedYAMLError(problem=problem)
    seen = Seen()
    try:
        for event in yaml.parse(text, fast_loader()):
            seen.add(event)
    except ValueError as error:  # a lone surrogate
        raise yaml.MarkedYAMLError(problem=f"no text: {error}") from error


class Seen:
    """Counts the values of a text, and how deep they are nested."""

    def __init__(self) -> None:
        self.count = 0
        self.most = most_values()
        self.sizes: dict[str | None, int] = {}
        """How many values each anchor stands for."""
        self.open: list[tuple[str | None, int]] = []
        """The anchors of the collections that have begun, and the count before each."""

    def add(self, event: Any) -> None:
        """Note what the parser has found; raise `yaml.YAMLError` beyond the limits."""
        import yaml

        if isinstance(event, yaml.AliasEvent):
            self.expect_closed(event)
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
        if self.count > self.most:
            what = (
                f"more than {self.most} values, where aliases count as what they stand for; "
                f"{VALUES_VARIABLE} raises the limit"
            )
        elif len(self.open) > DEEPEST:
            what = f"values nested deeper than {DEEPEST}"
        else:
            return
        raise yaml.MarkedYAMLError(problem=what, problem_mark=event.start_mark)

    def expect_closed(self, alias: Any) -> None:
        """Raise `yaml.YAMLError` for an alias within what it stands for, which has no end."""
        import yaml

        if any(anchor == alias.anchor for anchor, _ in self.open):
            problem = f"the alias *{alias.anchor} is within what it stands for"
            raise yaml.MarkedYAMLError(problem=problem, problem_mark=alias.start_mark)


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
        raise yaml.MarkedYAMLError(problem=f"a value cannot be read: {error}") from error


def documents_in(text: str | bytes, loader: Any = None) -> list[Any]:
    """Return what each document of a text describes; as `loaded_yaml`, which takes one."""
    import yaml

    checked_yaml(text)
    try:
        return list(yaml.load_all(text, loader or fast_loader()))
    except FROM_CONSTRUCTORS as error:
        raise yaml.MarkedYAMLError(problem=f"a value cannot be read: {error}") from error


def value_of_node(node: Any) -> Any:
    """Return what a node of `composed_yaml` describes.

    Raises:
        yaml.YAMLError: it is a value that is none.
    """
    import yaml

    loader = yaml.SafeLoader("")
    try:
        return loader.construct_object(node, deep=True)
    except FROM_CONSTRUCTORS as error:
        problem = f"a value cannot be read: {error}"
        raise yaml.MarkedYAMLError(problem=problem, problem_mark=node.start_mark) from error
    finally:
        loader.dispose()


def composed_yaml(text: str | bytes) -> Any:
    """Return the node of a text of others, which has the lines of its values.

    Raises:
        yaml.YAMLError: it is no YAML, or beyond the limits.
    """
    import yaml

    checked_yaml(text)
    return yaml.compose(text, fast_loader())
