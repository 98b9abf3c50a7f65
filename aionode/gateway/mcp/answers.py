"""The answers of tools: JSON small enough for a model, and errors that name the valid options."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, Final

import mcp_types as types
import msgspec

from aionode.errors import InterfaceNotFoundError, MessageError, RefusedError, ToolError

__all__ = ["MAX_BYTES", "answer", "bounded", "failure"]

MAX_BYTES: Final = 9_500
"""The longest JSON of an answer. An answer contains it twice, as text and structured: 20 kB in
all."""

SIZES: Final = ((400, 4000), (150, 1500), (60, 600), (25, 250), (10, 100), (4, 40), (1, 20))
"""How many entries and characters of long lists and texts to keep; the next step is tried until all
fits."""

MAX_LEVELS: Final = 30
"""How deeply nested an answer may be."""


def answer(values: Mapping[str, Any], *, is_error: bool = False) -> types.CallToolResult:
    """Return the result of a tool: its values as JSON, shortened to `MAX_BYTES`."""
    fitting = bounded(values, MAX_BYTES)
    text = msgspec.json.encode(fitting).decode()
    content = [types.TextContent(type="text", text=text)]
    return types.CallToolResult(
        content=list(content), structured_content=fitting, is_error=is_error
    )


def failure(error: Exception) -> types.CallToolResult:
    """Return the error that tells the model why a tool has failed."""
    code = "failed"
    if isinstance(error, RefusedError | ToolError):
        code = error.code
    elif isinstance(error, TimeoutError):
        code = "timeout"
    elif isinstance(error, MessageError):
        code = "invalid_message"
    elif isinstance(error, InterfaceNotFoundError):
        code = "not_found"
    text = str(error) or "no answer in time; try again, or wait longer"
    fitting = bounded({"error": text, "code": code}, MAX_BYTES)
    return types.CallToolResult(
        content=[types.TextContent(type="text", text=fitting["error"])],
        structured_content=fitting,
        is_error=True,
    )


def bounded(values: Mapping[str, Any], max_bytes: int) -> dict[str, Any]:
    """Return values shortened so that their JSON fits, without the ends of long lists and texts."""
    for items, characters in SIZES:
        # Each part takes a byte at least: with more of them, these sizes do not fit.
        parts = iter(range(max_bytes))
        fitting = {str(key): cut(value, items, characters, parts) for key, value in values.items()}
        if len(msgspec.json.encode(fitting)) <= max_bytes:
            return fitting
    return {"left_out": f"the answer has more than {max_bytes} bytes; request less of it"}


def cut(value: Any, items: int, characters: int, parts: Iterator[int], level: int = 0) -> Any:
    """Return a value with lists and texts cut to a length, each with the number of omitted items.

    The value and each value in it consume one of `parts`; when these are used up, the rest is
    omitted.
    """
    if level > MAX_LEVELS or next(parts, None) is None:
        return "..."
    if isinstance(value, str):
        if len(value) <= characters:
            return value
        return f"{value[:characters]}... ({len(value)} characters)"
    if isinstance(value, Mapping):
        kept = {
            str(key): cut(part, items, characters, parts, level + 1)
            for key, part in list(value.items())[:items]
        }
        if len(value) > items:
            kept["..."] = f"{len(value) - items} more"
        return kept
    if isinstance(value, list | tuple):
        kept_items = [cut(part, items, characters, parts, level + 1) for part in value[:items]]
        return [*kept_items, f"... {len(value) - items} more"] if len(value) > items else kept_items
    return value
