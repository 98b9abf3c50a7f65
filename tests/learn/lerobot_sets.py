"""Writes data sets for LeRobot's own loader: ``python -m tests.learn.lerobot_sets FOLDER``."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

import numpy as np

from aionode import image
from aionode.learn import Limits, export
from tests.support.demonstrations import Timing, contract, demonstration


def main(folder: Path) -> None:
    """Write a data set into each subfolder."""
    shutil.rmtree(folder, ignore_errors=True)
    bags = folder / "bags"
    kinds = {
        "one_camera": [Timing(30, late_sec=0.008, jitter_sec=0.004)],
        "two_cameras": [Timing(30, late_sec=0.03), Timing(25, phase_sec=0.01)],
        "gaps": [Timing(30, gaps=[(0.7, 1.0), (1.5, 1.7)])],
    }
    for name, cameras in kinds.items():
        made = [
            demonstration(bags / f"{name}{number}", cameras=cameras, seed=number)
            for number in range(3)
        ]
        export(folder / name, made, contract=contract(len(cameras)), limits=Limits(1, 1, 1))
    one = [demonstration(bags / "av1")]
    export(folder / "av1", one, contract=contract(), codec="av1")
    observations = contract().to_dict()["observations"]
    observations[0] |= {"image": "depth", "feature": "observation.images.depth"}
    deep = demonstration(
        bags / "depth",
        wrap=lambda shown: image.from_numpy(
            image.to_numpy(shown)[..., 0].astype(np.float32) / 255 + 1, "32FC1", shown.header
        ),
    )
    export(folder / "depth", [deep], contract=contract(observations=observations))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
