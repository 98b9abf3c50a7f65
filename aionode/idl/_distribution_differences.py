"""The interfaces with other fields in other distributions of ROS 2, known without a sourced ROS 2.

`_installed.py` uses them for the distribution that ROS_DISTRO names.
"""

from __future__ import annotations

__all__ = ["DIFFERENCES"]

EMPTY_SERVICES: dict[str, str] = dict.fromkeys(
    (
        "rosbag2_interfaces/srv/Resume",
        "rosbag2_interfaces/srv/SplitBagfile",
        "rosbag2_interfaces/srv/Stop",
    ),
    "---\n",
)
"""Services without fields before Lyrical."""

DIFFERENCES: dict[str, dict[str, str]] = {
    "humble": {
        **EMPTY_SERVICES,
        "sensor_msgs/msg/Range": """\
uint8 ULTRASOUND=0
uint8 INFRARED=1
std_msgs/Header header
uint8 radiation_type
float32 field_of_view
float32 min_range
float32 max_range
float32 range
""",
        "rosbag2_interfaces/msg/ReadSplitEvent": "string closed_file\nstring opened_file\n",
        "rosbag2_interfaces/msg/WriteSplitEvent": "string closed_file\nstring opened_file\n",
    },
    "jazzy": EMPTY_SERVICES,
    "kilted": EMPTY_SERVICES,
    "lyrical": {
        "lifecycle_msgs/msg/TransitionEvent": """\
builtin_interfaces/Time stamp
Transition transition
State start_state
State goal_state
""",
    },
}
"""For each distribution, the definitions of the shipped types that have other fields there."""
