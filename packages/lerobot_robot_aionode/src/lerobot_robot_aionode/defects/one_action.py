"""`lerobot-rollout` raises IndexError for a robot with a single action.

In LeRobot 0.6.1, line 117 of ``lerobot/rollout/inference/sync.py`` removes the batch dimension of
an action by ``squeeze(0)``, and passes it to `make_robot_action`, which does so once more in line
194 of ``lerobot/policies/utils.py``. That does nothing to several actions, but leaves no dimension
of a single one, which is then indexed. Not reported. The workaround gives the dimension back to the
function that removes it the second time.
"""

from __future__ import annotations

import functools
import sys
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Mapping

__all__ = ["let_one_action_drive"]

PLACE = "lerobot.rollout.inference.sync"


def let_one_action_drive() -> None:
    """Let the rollout that runs in this process, if one does, drive a robot of one action."""
    rollout = sys.modules.get(PLACE)
    given = getattr(rollout, "make_robot_action", None)
    if rollout is None or given is None or hasattr(given, "__wrapped__"):
        return

    @functools.wraps(given)
    def make_robot_action(action: Any, features: Mapping[str, Any]) -> Any:
        return given(action.reshape(1, -1), features)

    vars(rollout)["make_robot_action"] = make_robot_action
