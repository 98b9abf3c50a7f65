"""Content filters of subscriptions."""

from __future__ import annotations

from typing import NamedTuple

__all__ = ["ContentFilterOptions"]


class ContentFilterOptions(NamedTuple):
    """An expression that selects messages, and the values of its ``%0``, ``%1`` and so on."""

    filter_expression: str
    expression_parameters: list[str]
