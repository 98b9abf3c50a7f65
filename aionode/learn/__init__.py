"""Robot learning: from a demonstration to a policy that drives.

A `Contract`, one YAML file, names the topics that a policy observes and commands, with the numbers
in their messages, their ages and limits. `Contract.observe` shows the robot as a policy was trained
to see it, and `Contract.act` sends its actions, each at its time, and stops the robot when there
are none.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from aionode._process.first_use import imported_on_first_use

if TYPE_CHECKING:
    from aionode.learn._actor import Actor, ActorStats
    from aionode.learn._check import Checked, check
    from aionode.learn._dataset import check_dataset
    from aionode.learn._export import Exported, Limits, export
    from aionode.learn._observer import Observations, Seen
    from aionode.learn._record import Episode, Episodes, RecordEpisode
    from aionode.learn.contract import Action, Contract, Feature, Observation

__all__ = [
    "Action",
    "Actor",
    "ActorStats",
    "Checked",
    "Contract",
    "Episode",
    "Episodes",
    "Exported",
    "Feature",
    "Limits",
    "Observation",
    "Observations",
    "RecordEpisode",
    "Seen",
    "check",
    "check_dataset",
    "export",
]

PLACES = {
    "Action": "contract",
    "Actor": "_actor",
    "ActorStats": "_actor",
    "Checked": "_check",
    "Contract": "contract",
    "Episode": "_record",
    "Episodes": "_record",
    "Exported": "_export",
    "Feature": "contract",
    "Limits": "_export",
    "Observation": "contract",
    "Observations": "_observer",
    "RecordEpisode": "_record",
    "Seen": "_observer",
    "check": "_check",
    "check_dataset": "_dataset",
    "export": "_export",
}
"""The module of each public name, imported on first use."""

__getattr__ = imported_on_first_use(__name__, PLACES, "lerobot")
