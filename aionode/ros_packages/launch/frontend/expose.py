"""`launch.frontend.expose`: names of substitutions for XML and YAML launch files."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final, TypeVar

from launch.substitution import Substitution

__all__ = ["SUBSTITUTIONS", "expose_action", "expose_substitution"]

SUBSTITUTIONS: Final[dict[str, Callable[..., Substitution]]] = {}
"""The substitution for each name in texts of XML and YAML files."""

ExposedT = TypeVar("ExposedT")


def expose_substitution(name: str) -> Callable[[ExposedT], ExposedT]:
    """Return a decorator that makes ``$(name word…)`` of XML and YAML files mean a substitution.

    It decorates a class with a class method ``parse``, or such a function: called with the words,
    it returns a class and the keyword arguments that create the substitution.
    """

    def decorate(exposed: ExposedT) -> ExposedT:
        parse: Any = parse_of(exposed, name)

        def make(*words: Any) -> Substitution:
            kind, arguments = parse(words)
            substitution: Substitution = kind(**arguments)
            return substitution

        SUBSTITUTIONS[name] = make
        return exposed

    return decorate


def expose_action(name: str) -> Callable[[ExposedT], ExposedT]:
    """Return a decorator that leaves an action unchanged: Python files use it by its class.

    Custom elements in XML and YAML launch files are not supported here.
    """

    def decorate(exposed: ExposedT) -> ExposedT:
        parse_of(exposed, name)
        return exposed

    return decorate


def parse_of(exposed: Any, name: str) -> Any:
    """Return the function that creates an object from the words of a file.

    Raises:
        RuntimeError: It has no such method, and is not a function.
    """
    parse = getattr(exposed, "parse", None) if isinstance(exposed, type) else exposed
    if not callable(parse):
        problem = f"{name}: {exposed!r} has no class method 'parse', and is not a function"
        raise RuntimeError(problem)  # as in launch
    return parse
