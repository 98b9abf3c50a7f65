"""Errors as one line."""

from __future__ import annotations

from aionode.errors import NameValidationException

__all__ = ["limited", "one_line"]

MAX_CHARACTERS = 1000
"""Maximum length of an error text: it may quote input of any length."""


def limited(text: str) -> str:
    """Return a text, omitting its middle if it is too long."""
    if len(text) <= MAX_CHARACTERS:
        return text
    return f"{text[: MAX_CHARACTERS // 2]} ... {text[-MAX_CHARACTERS // 2 :]}"


def one_line(error: BaseException) -> str:
    """Return the text of an error on one line of limited length."""
    return limited(text_of(error))


def text_of(error: BaseException) -> str:
    """Return the text of an error on one line."""
    if isinstance(error, NameValidationException):
        character = error.name[error.invalid_index : error.invalid_index + 1]
        where = f", at character {error.invalid_index + 1} ({character!r})" if character else ""
        return f"Invalid {error.name_type} {error.name!r}: {error.error_msg}{where}"
    return "; ".join(line.strip() for line in str(error).splitlines() if line.strip())
