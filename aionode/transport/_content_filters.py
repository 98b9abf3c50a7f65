"""The content filters that subscriptions of other contexts have announced, for their publishers.

A subscription announces its filter beside itself, and publishers leave out what no subscription
wants. Nothing depends on it: a publisher that does not know a filter sends everything, and each
subscription applies its own filter to what arrives.
"""

from __future__ import annotations

import base64
import json
import re
from typing import TYPE_CHECKING, Any, Final

from aionode.content_filter import ContentFilterOptions, compile_filter
from aionode.errors import ContentFilterError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

__all__ = ["ContentFilters", "filter_from_text", "filter_token", "text_of_filter"]

GID: Final = re.compile("[0-9a-f]{32}")

MAX_SIZE: Final = 4096
"""Longer filters, as text, are not announced, nor taken from others."""

KIND: Final = "filter/1/"
"""What the token of a filter has after the participant: a word, and the version of its form."""

MAX_FILTERS: Final = 10_000
"""How many announced filters are known at most, of all other contexts."""


def text_of_filter(content_filter: ContentFilterOptions) -> str:
    """Return a filter as text of letters, digits, ``-`` and ``_``; empty if it is not announced."""
    plain = [content_filter.filter_expression, list(content_filter.expression_parameters)]
    text = base64.urlsafe_b64encode(json.dumps(plain).encode()).decode().rstrip("=")
    return text if content_filter.filter_expression and len(text) <= MAX_SIZE else ""


def filter_token(domain_id: int, participant: str, gid: bytes, text: str) -> str:
    """Return the liveliness token that announces the filter of a subscription."""
    return f"@aionode/{domain_id}/{participant}/{KIND}{gid.hex()}/{text}"


def filter_from_text(text: str) -> ContentFilterOptions | None:
    """Return the filter that `text_of_filter` wrote; None if it is malformed."""
    if len(text) > MAX_SIZE:
        return None
    try:
        plain = json.loads(base64.urlsafe_b64decode(text + "=" * (-len(text) % 4)))
    except (ValueError, RecursionError):
        return None
    match plain:
        case [str(expression), list(parameters)] if all(isinstance(p, str) for p in parameters):
            return ContentFilterOptions(expression, parameters)
    return None


class ContentFilters:
    """The announced filters of subscriptions, by the gid of the subscription.

    While a subscription changes its filter, both are known, and what either wants is sent.

    Attributes:
        changes: Incremented whenever a filter is added or removed.
        on_change: Called then.
    """

    def __init__(self) -> None:
        self.changes = 0
        self.on_change: list[Callable[[], None]] = []
        self._by_gid: dict[bytes, dict[str, ContentFilterOptions]] = {}

    def __bool__(self) -> bool:
        return bool(self._by_gid)

    def take_token(self, what: str, *, present: bool) -> None:
        """Add or remove what a token announces; others than those of filters are ignored.

        Args:
            what: The token without the participant and what is before it.
            present: Whether the token was declared, and not undeclared.
        """
        gid_text, _, text = what.removeprefix(KIND).partition("/")
        if not what.startswith(KIND) or not GID.fullmatch(gid_text):
            return
        gid = bytes.fromhex(gid_text)
        known = self._by_gid.setdefault(gid, {})
        content_filter = filter_from_text(text) if present else None
        if content_filter is not None and len(self._by_gid) <= MAX_FILTERS:
            known[text] = content_filter
        else:
            known.pop(text, None)
        if not known:
            del self._by_gid[gid]
        self._changed()

    def clear(self) -> None:
        """Forget all filters: the session has ended."""
        if self._by_gid:
            self._by_gid.clear()
            self._changed()

    def _changed(self) -> None:
        self.changes += 1
        for listener in self.on_change:
            listener()

    def wanted_by(self, gids: Iterable[bytes], msg_type: type[Any]) -> Callable[[Any], bool] | None:
        """Return whether a message is wanted by any of some subscriptions.

        None if one of them wants all messages, if there are none, or if a filter does not fit the
        type: then everything is sent.
        """
        predicates: list[Callable[[Any], bool]] = []
        for gid in gids:
            announced = self._by_gid.get(gid)
            if not announced:
                return None
            for one in announced.values():
                try:
                    predicates.append(
                        compile_filter(msg_type, one.filter_expression, one.expression_parameters)
                    )
                except ContentFilterError:
                    return None
        return any_of(predicates) if predicates else None


def any_of(predicates: list[Callable[[Any], bool]]) -> Callable[[Any], bool]:
    """Return whether any of these predicates is true of a message, which may be invalid."""

    def wants(msg: Any) -> bool:
        try:
            return any(predicate(msg) for predicate in predicates)
        except (TypeError, ValueError, AttributeError, LookupError):
            return True  # a value that does not fit its field: the encoder says which one

    return wants
