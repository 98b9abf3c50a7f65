"""The keys of the metadata in an episode's bag."""

from __future__ import annotations

from typing import Final

__all__ = ["CONTRACT_KEY", "FAILURE", "OUTCOME_KEY", "TASK_KEY"]

TASK_KEY: Final = "task"
"""What was demonstrated, in words."""

CONTRACT_KEY: Final = "contract"
"""The contract, as JSON."""

OUTCOME_KEY: Final = "outcome"
"""How it ended: ``success`` or ``failure``; missing if its recorder was killed."""

FAILURE: Final = "failure"
"""The outcome with which an export leaves an episode out."""
