"""What the metadata of an episode's bag has."""

from __future__ import annotations

from typing import Final

__all__ = ["CONTRACT_KEY", "FAILURE", "OUTCOME_KEY", "TASK_KEY"]

TASK_KEY: Final = "task"
"""What was shown, in words."""

CONTRACT_KEY: Final = "contract"
"""The contract, as JSON."""

OUTCOME_KEY: Final = "outcome"
"""How it ended: ``success`` or ``failure``; there is none if its recorder was killed."""

FAILURE: Final = "failure"
"""The outcome of an episode that an export leaves out."""
