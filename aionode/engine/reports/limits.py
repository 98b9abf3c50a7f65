"""Log messages about limits: what happens when more arrives than an endpoint accepts."""

from __future__ import annotations

from typing import TYPE_CHECKING

from aionode.errors import escaped

if TYPE_CHECKING:
    from aionode.logging import RcutilsLogger

__all__ = ["heavy_text", "tell_full", "tell_rejected"]

REJECTED_SEC = 1.0
"""Minimum interval between reports of rejected goals, in seconds."""


def heavy_text(name: str, limit_bytes: int, what: str) -> str:
    """Return the warning for an endpoint with too many bytes of waiting messages or requests.

    Args:
        name: Its topic or service.
        limit_bytes: How many bytes may wait.
        what: What happens to the excess.
    """
    return (
        f"{name}: over {limit_bytes / 2**20:.3g} MiB wait for their callback; the excess is "
        f"{what}. AIONODE_QUEUE_BYTES or Context(queue_bytes=…) sets the limit"
    )


def tell_full(logger: RcutilsLogger, subject: str, why: str) -> None:
    """Log that a server rejected a goal because of a limit; at most once a second."""
    logger.warning(
        f"{subject}: rejected a goal, as {why}",
        throttle_duration_sec=REJECTED_SEC,
    )


def tell_rejected(logger: RcutilsLogger, subject: str, reason: str = "") -> None:
    """Log that a server rejected a goal; at most once a second, whatever clients send."""
    why = f": {escaped(reason)}" if reason else ""
    text = f"{subject}: goal_callback rejected a goal{why}"
    logger.info(text, throttle_duration_sec=REJECTED_SEC)
