"""Read YAML from others with PyYAML, within limits of size, depth and number.

A few lines with aliases of aliases expand to billions of values, deep nesting crashes the process
inside libyaml, and a long number with colons takes minutes to parse; so text from a file is checked
first.
"""

from __future__ import annotations

import os
from typing import Any, Final

__all__ = [
    "MAX_TEXT",
    "MAX_VALUES",
    "VALUES_VARIABLE",
    "checked_yaml",
    "composed_yaml",
    "documents_in",
    "fast_loader",
    "loaded_yaml",
    "most_values",
    "value_of_node",
]

MAX_TEXT: Final = 8 << 20
"""Maximum size of a text, in bytes."""

MAX_VALUES: Final = 80_000
"""Maximum values and keys, about a second's work; an alias counts as all values that it expands
to."""

VALUES_VARIABLE: Final = "AIONODE_YAML_VALUES"
"""The environment variable that sets another limit."""

MAX_DEPTH: Final = 100
MAX_NUMBER: Final = 400
"""Maximum length of a number, because parsing base 60 takes quadratic time."""

FROM_CONSTRUCTORS: Final = (
    ArithmeticError,
    AttributeError,
    LookupError,
    RecursionError,
    TypeError,
    ValueError,
)
"""The exceptions of PyYAML's constructors, as for an empty ``!!int`` or a thirteenth month."""


def most_values() -> int:
    """Return the maximum number of values in a text."""
    given = os.environ.get(VALUES_VARIABLE, "")
    return int(given) if given.isascii() and given.isdigit() else MAX_VALUES


def checked_yaml(text: str | bytes) -> None:
    """Raise `yaml.YAMLError` if a text is not YAML or exceeds the limits."""
    import yaml

    if len(text) > MAX_TEXT:
        problem = f"{len(text)} bytes; at most {MAX_TEXT} are read"
        raise yaml.MarkedYAMLError(problem=problem)
    seen = Seen()
    try:
        for event in yaml.parse(text, fast_loader()):
            seen.add(event)
    except ValueError as error:  # a lone surrogate
        raise yaml.MarkedYAMLError(problem=f"not text: {error}") from error


class Seen:
    """Counts the values of a text and their nesting depth."""

    def __init__(self) -> None:
        self.count = 0
        self.most = most_values()
        self.sizes: dict[str | None, int] = {}
        """The number of values that each anchor expands to."""
        self.open: list[tuple[str | None, int]] = []
        """The anchors of the open collections, and the count before each."""

    def add(self, event: Any) -> None:
        """Count an event of the parser; raise `yaml.YAMLError` beyond the limits."""
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
                f"more than {self.most} values, counting the values of each alias; "
                f"{VALUES_VARIABLE} raises the limit"
            )
        elif len(self.open) > MAX_DEPTH:
            what = f"values nested deeper than {MAX_DEPTH}"
        else:
            return
        raise yaml.MarkedYAMLError(problem=what, problem_mark=event.start_mark)

    def expect_closed(self, alias: Any) -> None:
        """Raise `yaml.YAMLError` for an alias inside its own value, which would be infinite."""
        import yaml

        if any(anchor == alias.anchor for anchor, _ in self.open):
            problem = f"the alias *{alias.anchor} is within its own value"
            raise yaml.MarkedYAMLError(problem=problem, problem_mark=alias.start_mark)


def expect_short(event: Any) -> None:
    """Raise `yaml.YAMLError` if a value may be a very long number."""
    import yaml

    value = event.value
    may_be_number = value[:1] in set("+-.0123456789") and (
        not event.style or (event.tag or "").endswith((":int", ":float"))
    )
    if len(value) > MAX_NUMBER and may_be_number and " " not in value:
        problem = f"a number of {len(value)} characters"
        raise yaml.MarkedYAMLError(problem=problem, problem_mark=event.start_mark)


def fast_loader() -> Any:
    """Return PyYAML's safe loader, in C if libyaml is available."""
    import yaml

    return getattr(yaml, "CSafeLoader", yaml.SafeLoader)


def loaded_yaml(text: str | bytes, loader: Any = None) -> Any:
    """Parse YAML from others to plain values; None for an empty text.

    Args:
        text: The text.
        loader: A safe loader of PyYAML to use instead of the default.

    Raises:
        yaml.YAMLError: it is not YAML, exceeds the limits, or has an invalid value.
    """
    import yaml

    checked_yaml(text)
    try:
        return yaml.load(text, loader or fast_loader())  # noqa: S506  # a safe loader
    except FROM_CONSTRUCTORS as error:
        raise yaml.MarkedYAMLError(problem=f"a value cannot be read: {error}") from error


def documents_in(text: str | bytes, loader: Any = None) -> list[Any]:
    """Parse each document of a text, like `loaded_yaml`, which takes a single one."""
    import yaml

    checked_yaml(text)
    try:
        return list(yaml.load_all(text, loader or fast_loader()))
    except FROM_CONSTRUCTORS as error:
        raise yaml.MarkedYAMLError(problem=f"a value cannot be read: {error}") from error


def value_of_node(node: Any) -> Any:
    """Return the value of a node of `composed_yaml`.

    Raises:
        yaml.YAMLError: the value is invalid.
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
    """Parse YAML from others to a node, which knows the lines of its values.

    Raises:
        yaml.YAMLError: it is not YAML, or exceeds the limits.
    """
    import yaml

    checked_yaml(text)
    return yaml.compose(text, fast_loader())
