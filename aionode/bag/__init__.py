"""Bags: recordings of topics, in files shared with ROS 2 and Foxglove.

`open` reads a bag: MCAP and sqlite3 files of any rosbag2 version, including split and compressed
ones. `BagWriter` writes bags as rosbag2 does. It requires the extra ``bag``:
``pip install aionode[bag]``.

::

    with bag.open("run") as run:
        for record in run.read(topics=["/scan"]):
            print(record.time, record.message.ranges)
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from aionode._process.first_use import imported_on_first_use

if TYPE_CHECKING:
    from aionode.bag._bag import Bag, open  # noqa: A004  # as in `bag.open(path)`
    from aionode.bag._causes import why
    from aionode.bag._copy import convert, cut, merge
    from aionode.bag._repair import Checked, check, reindex
    from aionode.bag._selection import Selection
    from aionode.bag._writer import BagWriter
    from aionode.bag.files.losses import Lost
    from aionode.bag.files.qos import qos_overrides
    from aionode.bag.files.record import Record, TopicInfo
    from aionode.bag.playing.player import Player
    from aionode.bag.recording.recorder import Recorder
    from aionode.bag.recording.recording import TopicStats
    from aionode.bag.replaying.comparison import Difference, compare
    from aionode.bag.replaying.machine_use import MachineUseWarning
    from aionode.bag.replaying.outputs import Outputs
    from aionode.bag.replaying.replay import Replay, replay

__all__ = [
    "Bag",
    "BagWriter",
    "Checked",
    "Difference",
    "Lost",
    "MachineUseWarning",
    "Outputs",
    "Player",
    "Record",
    "Recorder",
    "Replay",
    "Selection",
    "TopicInfo",
    "TopicStats",
    "check",
    "compare",
    "convert",
    "cut",
    "merge",
    "open",
    "qos_overrides",
    "reindex",
    "replay",
    "why",
]

PLACES = {
    "Bag": "_bag",
    "BagWriter": "_writer",
    "Checked": "_repair",
    "Difference": "replaying.comparison",
    "Lost": "files.losses",
    "MachineUseWarning": "replaying.machine_use",
    "Outputs": "replaying.outputs",
    "Player": "playing.player",
    "Record": "files.record",
    "Recorder": "recording.recorder",
    "Replay": "replaying.replay",
    "Selection": "_selection",
    "TopicInfo": "files.record",
    "TopicStats": "recording.recording",
    "check": "_repair",
    "compare": "replaying.comparison",
    "convert": "_copy",
    "cut": "_copy",
    "merge": "_copy",
    "open": "_bag",
    "qos_overrides": "files.qos",
    "reindex": "_repair",
    "replay": "replaying.replay",
    "why": "_causes",
}
"""The module of each public name, imported on first use: few programs need all of them."""

__getattr__ = imported_on_first_use(__name__, PLACES, "bag")
