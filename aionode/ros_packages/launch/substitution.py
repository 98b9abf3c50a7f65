"""`launch.substitution`: texts known only when a description is evaluated."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any, ClassVar, Self, TypeAlias

if TYPE_CHECKING:
    from launch.launch_context import LaunchContext

__all__ = [
    "SomeSubstitutionsType",
    "Substitution",
    "SubstitutionFailure",
    "TextSubstitution",
    "normalize_to_list_of_substitutions",
    "of_words",
    "perform_substitutions",
    "text_of",
]


class SubstitutionFailure(RuntimeError):  # noqa: N818  # launch's name
    """A substitution has no value."""


class Substitution:
    """A text known only when the description is evaluated."""

    def perform(self, context: LaunchContext) -> str:
        """Return the text."""
        raise NotImplementedError(f"{type(self).__name__}.perform")

    def describe(self) -> str:
        """Return the text of the description."""
        return f"{type(self).__name__}()"

    _Substitution__second_word: ClassVar[str] = ""
    """The name of the argument for the second word of ``$(name word word)``, if it has one."""

    @classmethod
    def _Substitution__of_words(cls, *words: Any) -> Self:
        """Return the substitution for ``$(name word word)`` in a file."""
        if cls._Substitution__second_word and len(words) == 2:
            return cls(words[0], **{cls._Substitution__second_word: words[1]})  # type: ignore[call-arg]  # the subclass has it
        return cls(*words)


def of_words(kind: type[Substitution]) -> Callable[..., Substitution]:
    """Return the function that makes a substitution of the words of ``$(name word word)``."""
    return kind._Substitution__of_words


class TextSubstitution(Substitution):
    """A text that is known already."""

    def __init__(self, *, text: str) -> None:
        if not isinstance(text, str):
            raise TypeError(f"TextSubstitution expects a str as text, got {text!r}")
        self.text = text

    def describe(self) -> str:
        """Return the text in quotes."""
        return f"'{self.text}'"

    def perform(self, context: LaunchContext) -> str:
        """Return the text."""
        return self.text


SomeSubstitutionsType: TypeAlias = str | Substitution | Iterable[Any]
"""A text, a substitution, or several of them to join."""


def normalize_to_list_of_substitutions(subs: SomeSubstitutionsType) -> list[Substitution]:
    """Return the substitutions that make up a text."""
    if isinstance(subs, Substitution):
        return [subs]
    if isinstance(subs, str):
        return [TextSubstitution(text=subs)]
    if hasattr(subs, "__fspath__"):
        return [TextSubstitution(text=str(subs))]
    if isinstance(subs, Iterable):
        return [part for sub in subs for part in normalize_to_list_of_substitutions(sub)]
    raise TypeError(f"expected a text, a substitution or a list of them, got {subs!r}")


def perform_substitutions(context: LaunchContext, subs: Sequence[Substitution]) -> str:
    """Return the texts of substitutions, joined."""
    return "".join(context.perform_substitution(sub) for sub in subs)


def text_of(context: LaunchContext, subs: SomeSubstitutionsType) -> str:
    """Return the text of a substitution, or of several joined."""
    return perform_substitutions(context, normalize_to_list_of_substitutions(subs))
