"""The base of all errors, and the formatting of values in their texts."""

from __future__ import annotations

import re

__all__ = [
    "MAX_NAME",
    "AionodeError",
    "brief",
    "escaped",
    "shortened",
]

MAX_TEXT = 2_000
"""Maximum length of an error text, in characters; the values it quotes can be far longer."""

MAX_NAME = 160
"""Maximum number of characters of an invalid name that are shown."""


def shortened(text: str, limit: int = MAX_TEXT) -> str:
    """Return `text`, with its middle cut out if it is longer than `limit` characters."""
    if len(text) <= limit:
        return text
    half = limit // 2
    return f"{text[:half]} […{len(text) - 2 * half} characters…] {text[-half:]}"


UNSHOWN = (  # compiled by its first use
    "[\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028\u2029\u202a-\u202e\u2066-\u2069\ud800-\udfff]"
)
"""Control characters except tab and newline, bidirectional controls, and surrogates."""


def escaped(text: str, *, one_line: bool = False) -> str:
    r"""Return `text` with control characters escaped, as in ``\x1b``, for people to read.

    The text may come from another process: printed unescaped, an escape sequence could recolour,
    overwrite or retitle a terminal. Tabs and newlines stay; with `one_line`, newlines are escaped
    too, so that a name cannot pose as another line.
    """
    if one_line:
        text = text.replace("\n", "\\n")
    if re.search(UNSHOWN, text) is None:
        return text
    return re.sub(UNSHOWN, lambda match: match[0].encode("unicode_escape").decode(), text)


def brief(value: object) -> str:
    """Return the shortened repr of `value` for an error text.

    For integers of thousands of digits, which Python refuses to convert, the reason is returned.
    """
    try:
        text = repr(value)
    except ValueError as error:
        text = f"a {type(value).__name__} that cannot be written ({error})"
    return shortened(text, MAX_NAME)


class AionodeError(Exception):
    """Base of all errors that aionode raises on purpose.

    Texts of more than 2000 characters are shortened in the middle, since the beginning says what
    happened and the end what to do. Control characters are escaped, since a text may quote another
    process. The attributes hold the complete values.
    """

    def __init__(self, *args: object) -> None:
        shown = (escaped(shortened(arg)) if isinstance(arg, str) else arg for arg in args)
        super().__init__(*shown)
