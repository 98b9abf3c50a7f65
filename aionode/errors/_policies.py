"""Errors of policies that drive a robot."""

from __future__ import annotations

from typing import TYPE_CHECKING

from aionode.errors._base import AionodeError

if TYPE_CHECKING:
    from collections.abc import Mapping

__all__ = ["PolicyTooSlowError", "StaleError"]


class StaleError(AionodeError, TimeoutError):
    """Something that a policy should see is older than its contract allows, or never arrived.

    Attributes:
        ages: The age of each topic that is too old, in seconds; None for one never received.
    """

    def __init__(self, ages: Mapping[str, float | None], limits: Mapping[str, float]) -> None:
        self.ages = dict(ages)
        shown = "; ".join(
            f"{topic} was never heard"
            if age is None
            else f"{topic} is {age:.3f} s old; at most {limits[topic]:g} s are allowed"
            for topic, age in ages.items()
        )
        super().__init__(
            f"observation: {shown}; see `aionode topic hz`, or raise max_age in the contract"
        )


class PolicyTooSlowError(AionodeError, TimeoutError):
    """A policy takes longer to answer than the actions of its answer last; nothing was sent.

    Attributes:
        latency_sec: How long it took.
        chunk_sec: How long the actions of its answer last.
    """

    def __init__(self, latency_sec: float, chunk_sec: float) -> None:
        self.latency_sec = latency_sec
        self.chunk_sec = chunk_sec
        super().__init__(
            f"policy: it took {latency_sec:.3f} s to answer with actions for {chunk_sec:.3f} s, "
            "which are over by then; nothing was sent. Have it answer with more actions or in less "
            "than half that time"
        )
