"""The keys of the metadata in an episode's bag."""

from __future__ import annotations

from typing import Final

__all__ = ["CONTRACT_KEY", "FAILURE", "OUTCOME_KEY", "TASK_KEY"]

TASK_KEY: Final = "task"
"""The key of the task: what was demonstrated, in words."""

CONTRACT_KEY: Final = "contract"
"""The key of the contract, as JSON."""

OUTCOME_KEY: Final = "outcome"
"""The key of the outcome, ``success`` or ``failure``; missing if the recorder was killed."""

FAILURE: Final = "failure"
"""The outcome of episodes that an export leaves out."""
