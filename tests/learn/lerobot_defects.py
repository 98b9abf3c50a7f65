"""The defects of LeRobot that `lerobot_robot_aionode` works around: ``make lerobot``.

Run with the Python of an environment that has LeRobot. Each function fails once LeRobot no longer
has the defect; then the module of the same name in `lerobot_robot_aionode.defects` can go.
"""

from __future__ import annotations

__all__: list[str] = []


def one_action() -> None:
    """`make_robot_action` cannot take what the rollout passes to it for a single action."""
    import torch
    from lerobot.policies.utils import make_robot_action

    action = torch.zeros(1, 1).squeeze(0)  # as `SyncInferenceEngine.get_action` does
    try:
        make_robot_action(action, {"action": {"names": ["shoulder.pos"]}})
    except IndexError:
        return
    raise AssertionError("a single action is taken: defects/one_action.py can go")


if __name__ == "__main__":
    one_action()
