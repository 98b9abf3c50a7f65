"""Content filters of subscriptions."""

from __future__ import annotations

from typing import NamedTuple

__all__ = ["ContentFilterOptions"]


class ContentFilterOptions(NamedTuple):
    """Which messages a subscription takes: an expression, and what stands for its ``%0`` and so on."""

    filter_expression: str
    expression_parameters: list[str]
