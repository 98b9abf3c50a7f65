"""Substitutions in texts of XML and YAML files: ``$(var name)``, ``$(find-pkg-share pkg)``, …."""

from __future__ import annotations

import re
from typing import Any

from launch.frontend.expose import SUBSTITUTIONS
from launch.substitution import Substitution, TextSubstitution

__all__ = ["parse_words"]

NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]*")

MAX_LEVELS = 100
"""The deepest nesting of substitutions."""


def parse_words(text: str) -> list[Substitution]:
    """Return the substitutions that make up a text.

    Raises:
        ValueError: A name is unknown, or a bracket is not closed.
    """
    reader = Reader(text)
    parts = reader.parts(until="")
    return parts or [TextSubstitution(text="")]


class Reader:
    """Reads a text from left to right."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.at = 0
        self._depth = 0

    def parts(self, until: str) -> list[Substitution]:
        """Return the parts before one of these characters, or before the end."""
        texts: list[Substitution] = []
        plain = ""
        while self.at < len(self.text) and self.text[self.at] not in (until or "\0"):
            char = self.text[self.at]
            if self.text.startswith("$(", self.at):
                if plain:
                    texts.append(TextSubstitution(text=plain))
                    plain = ""
                texts.append(self.substitution())
            elif char == "\\" and self.at + 1 < len(self.text):
                plain += self.text[self.at + 1]
                self.at += 2
            else:
                plain += char
                self.at += 1
        if plain:
            texts.append(TextSubstitution(text=plain))
        return texts

    def substitution(self) -> Substitution:
        """Return the substitution that begins here."""
        begin = self.at
        self._depth += 1
        if self._depth > MAX_LEVELS:
            raise ValueError(f"substitutions are nested deeper than {MAX_LEVELS}")
        self.at += 2
        match = NAME.match(self.text, self.at)
        if match is None:
            raise ValueError(f"'{self.text[begin : begin + 20]}': expected a name after '$('")
        self.at = match.end()
        words: list[Any] = []
        while self.peek() == " ":
            self.at += 1
            words.append(self.word())
        if self.peek() != ")":
            raise ValueError(f"'{self.text[begin : begin + 40]}': ')' is missing")
        self.at += 1
        self._depth -= 1
        return make(match.group(), words)

    def word(self) -> list[Substitution]:
        """Return one argument, which may be quoted."""
        quote = self.peek()
        if quote and quote in "'\"":
            self.at += 1
            parts = self.parts(until=quote)
            if self.peek() != quote:
                raise ValueError(f"'{self.text}': {quote} is missing")
            self.at += 1
            return parts or [TextSubstitution(text="")]
        return self.parts(until=" )") or [TextSubstitution(text="")]

    def peek(self) -> str:
        """Return the next character, or nothing at the end."""
        return self.text[self.at : self.at + 1]


def make(name: str, words: list[Any]) -> Substitution:
    """Return the substitution of this name with these arguments."""
    if name not in SUBSTITUTIONS:
        known = ", ".join(sorted(SUBSTITUTIONS))
        raise ValueError(f"'$({name} …)' is not a substitution; use one of: {known}")
    try:
        return SUBSTITUTIONS[name](*words)
    except TypeError as error:
        raise ValueError(f"'$({name} …)' takes other arguments: {error}") from error
    except IndexError as error:
        raise ValueError(f"'$({name})' requires an argument") from error
