"""Robot learning: from a demonstration to a policy that drives.

A `Contract`, one YAML file, names the topics that a policy observes and commands, with the numbers
in their messages, their ages and limits.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from aionode._process.first_use import imported_on_first_use

if TYPE_CHECKING:
    from aionode.learn.contract import Action, Contract, Feature, Observation

__all__ = ["Action", "Contract", "Feature", "Observation"]

PLACES = {
    "Action": "contract",
    "Contract": "contract",
    "Feature": "contract",
    "Observation": "contract",
}
"""The module of each public name, imported on first use."""

__getattr__ = imported_on_first_use(__name__, PLACES, "lerobot")
