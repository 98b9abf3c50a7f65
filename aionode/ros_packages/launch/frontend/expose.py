"""`launch.frontend.expose`: names of substitutions for XML and YAML launch files."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final, TypeVar

from launch.substitution import Substitution

__all__ = ["SUBSTITUTIONS", "expose_action", "expose_substitution"]

SUBSTITUTIONS: Final[dict[str, Callable[..., Substitution]]] = {}
"""The substitution that each name stands for in texts of XML and YAML files."""

ExposedT = TypeVar("ExposedT")


def expose_substitution(name: str) -> Callable[[ExposedT], ExposedT]:
    """Return a decorator that lets ``$(name word…)`` of XML and YAML files mean a substitution.

    It is for a class with a class method ``parse``, or for such a function: called with the words,
    it returns a class and the arguments by name that make the substitution.
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
    """Return a decorator that leaves an action as it is: files in Python use it by its class.

    XML and YAML launch files have no elements of a program's own here.
    """

    def decorate(exposed: ExposedT) -> ExposedT:
        parse_of(exposed, name)
        return exposed

    return decorate


def parse_of(exposed: Any, name: str) -> Any:
    """Return what makes a thing from the words of a file.

    Raises:
        RuntimeError: It has no such method, and is no function.
    """
    parse = getattr(exposed, "parse", None) if isinstance(exposed, type) else exposed
    if not callable(parse):
        problem = f"{name}: {exposed!r} has no class method 'parse', and is no function"
        raise RuntimeError(problem)  # as launch
    return parse
