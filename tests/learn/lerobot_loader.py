"""Reads data sets with LeRobot's own loader, in its environment, which has no aionode.

``make lerobot`` runs it. It reads every row, with chunks of ten actions, and compares what each
picture shows with the joint beside it.
"""

from __future__ import annotations

import sys
from importlib.metadata import version
from pathlib import Path
from typing import Any

from lerobot.datasets import LeRobotDataset
from torch.utils.data import DataLoader

PIXELS_PER_RAD = 50


def column(picture: Any) -> int:
    """Return the column up to which a picture is white."""
    middle = picture[0, picture.shape[1] // 2]
    return int((middle > (middle.min() + middle.max()) / 2).sum())


def check(root: Path) -> None:
    """Read a data set, and print what was found."""
    data = LeRobotDataset(
        f"test/{root.name}",
        root=root,
        video_backend="pyav",
        delta_timestamps={"action": [step / 30 for step in range(10)]},
    )
    rows = worst = 0
    for batch in DataLoader(data, batch_size=8):
        rows += len(batch["index"])
        assert batch["action"].shape[1] == 10
        assert set(batch["task"]) == {"turn the joint"}
        for key in data.meta.video_keys:
            for picture, state in zip(batch[key], batch["observation.state"], strict=True):
                wanted = min(round(float(state[0]) * PIXELS_PER_RAD), picture.shape[2])
                if 0 < wanted < picture.shape[2]:
                    worst = max(worst, abs(column(picture) - wanted))
    assert rows == len(data) == data.meta.total_frames
    print(  # noqa: T201
        f"{root.name}: {data.meta.total_episodes} episodes, {rows} rows, "
        f"{len(data.meta.video_keys)} cameras; picture and joint differ by {worst} columns at most"
    )
    assert worst <= (1 if root.name != "two_cameras" else 3)


if __name__ == "__main__":
    print(f"LeRobot {version('lerobot')}")  # noqa: T201
    for folder in sorted(Path(sys.argv[1]).iterdir()):
        if (folder / "meta").exists():
            check(folder)
