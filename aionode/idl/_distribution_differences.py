"""The interfaces with other fields in other distributions of ROS 2, known without a sourced ROS 2.

`_installed.py` uses them for the distribution that ROS_DISTRO names.
"""

from __future__ import annotations

__all__ = ["DIFFERENCES"]

RESULT = "int32 return_code\nstring error_string\n"

LYRICAL: dict[str, str] = {
    "lifecycle_msgs/msg/TransitionEvent": """\
builtin_interfaces/Time stamp
Transition transition
State start_state
State goal_state
""",
    "rosbag2_interfaces/srv/Resume": f"""\
int32 RESUME_MODE_NODE_TIME=0
int32 RESUME_MODE_PUBLISH_TIME=1
int32 RESUME_MODE_RECEIVE_TIME=2
builtin_interfaces/Time resume_time
int32 resume_mode
string tracking_topic_name
---
int32 RETURN_CODE_SUCCESS=0
int32 RETURN_CODE_INVALID_RESUME_MODE=1
int32 RETURN_CODE_INVALID_TRACKING_TOPIC=2
int32 RETURN_CODE_RESUME_FAILED=3
{RESULT}""",
    "rosbag2_interfaces/srv/SplitBagfile": f"""\
int32 SPLIT_MODE_NODE_TIME=0
int32 SPLIT_MODE_PUBLISH_TIME=1
int32 SPLIT_MODE_RECEIVE_TIME=2
builtin_interfaces/Time split_time
int32 split_mode
string tracking_topic_name
---
int32 RETURN_CODE_SUCCESS=0
int32 RETURN_CODE_NOT_RECORDING=1
int32 RETURN_CODE_INVALID_SPLIT_MODE=2
int32 RETURN_CODE_INVALID_TRACKING_TOPIC=3
int32 RETURN_CODE_SPLIT_FAILED=4
{RESULT}""",
    "rosbag2_interfaces/srv/Stop": f"---\n{RESULT}",
}

DIFFERENCES: dict[str, dict[str, str]] = {
    "humble": {
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
    "lyrical": LYRICAL,
    "rolling": LYRICAL,
}
"""For each distribution, the definitions of the shipped types that have other fields there."""
