"""Filter a program's output for a terminal: only text and colours pass."""

from __future__ import annotations

import re
from typing import Final

__all__ = ["has_codes", "without_codes"]

CONTROLS: Final = bytes({*range(0x20), 0x7F} - {0x09, 0x0A})
"""All ASCII control characters except tab and newline."""

C1: Final = b"\xc2"
"""The first byte of the other control characters in UTF-8."""

COLOR: Final = re.compile(rb"\x1b\[[0-9;:]*m")
RESET: Final = b"\x1b[0m"

CODES: Final = re.compile(
    b"|".join(
        (
            b"(?P<color>" + COLOR.pattern + b")",
            rb"\x1b\[[0-?]*[ -/]*[@-~]",  # the cursor, the screen, modes
            rb"\x1b[\]PX^_][^\x07\x1b\n]*(?:\x07|\x1b\\)",  # titles, the clipboard, links
            rb"\x1b[ -/]*[0-~]",
            rb"(?P<other>[\x00-\x08\x0b-\x1f\x7f])",
        )
    )
)
HIGH: Final = re.compile(rb"\xc2[\x80-\x9f]")


def has_codes(output: bytes) -> bool:
    """Return whether a program's output contains more than text; fast if it does not."""
    return C1 in output or len(output.translate(None, CONTROLS)) < len(output)


def without_codes(lines: bytes) -> bytes:
    r"""Return whole lines without codes that move the cursor or change more than colours.

    Otherwise a program could overwrite the output of others, retitle the terminal or write to the
    clipboard. A carriage return, as of a progress bar, starts a new line; colours end with their
    line; other control characters are escaped, as in ``\x07``.
    """
    lines = lines.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    if has_codes(COLOR.sub(b"", lines)):
        lines = CODES.sub(replacement, lines)
        lines = HIGH.sub(shown, lines)  # last, as two bytes may have been apart before
    if b"\x1b" not in lines:
        return lines
    return b"\n".join(map(with_reset, lines.split(b"\n")))


def replacement(code: re.Match[bytes]) -> bytes:
    """Return the replacement of a code."""
    return shown(code) if code["other"] else code["color"] or b""


def shown(control: re.Match[bytes]) -> bytes:
    """Return a control character as an escape."""
    return control[0].decode().encode("unicode_escape")


def with_reset(line: bytes) -> bytes:
    """Return a line with its colours reset at the end, if they are not."""
    last = line.rfind(b"\x1b[")
    return line if last < 0 or line.startswith((RESET, b"\x1b[m"), last) else line + RESET
