"""Content filters of subscriptions."""

from __future__ import annotations

from typing import NamedTuple

__all__ = ["ContentFilterOptions"]


class ContentFilterOptions(NamedTuple):
    """Which messages a subscription takes: an expression, and what its ``%0`` and so on are."""

    filter_expression: str
    expression_parameters: list[str]
