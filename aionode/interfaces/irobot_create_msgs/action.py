"""Actions of irobot_create_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import ClassVar

from aionode.interfaces.builtin_interfaces.msg import Duration
from aionode.interfaces.geometry_msgs.msg import PoseStamped
from aionode.interfaces.irobot_create_msgs.msg import AudioNoteVector, LightringLeds
from aionode.message import DEFAULT, ActionType, Message, float32, int8, int32

__all__ = [
    "AudioNoteSequence",
    "Dock",
    "DriveArc",
    "DriveDistance",
    "LedAnimation",
    "NavigateToPosition",
    "RotateAngle",
    "Undock",
    "WallFollow",
]


class AudioNoteSequence(ActionType, typename="irobot_create_msgs/action/AudioNoteSequence"):
    """AudioNoteSequence, as the Create 3 defines it."""

    class Goal(Message):
        """The goal of AudioNoteSequence."""

        INFINITE: ClassVar[int32] = -1

        iterations: int32 = 1
        note_sequence: AudioNoteVector = DEFAULT

    class Result(Message):
        """The result of AudioNoteSequence."""

        complete: bool = False
        iterations_played: int32 = 0
        runtime: Duration = DEFAULT

    class Feedback(Message):
        """The feedback of AudioNoteSequence."""

        iterations_played: int32 = 0
        current_runtime: Duration = DEFAULT


class Dock(ActionType, typename="irobot_create_msgs/action/Dock"):
    """Dock, as the Create 3 defines it."""

    class Goal(Message):
        """The goal of Dock."""

    class Result(Message):
        """The result of Dock."""

        is_docked: bool = False

    class Feedback(Message):
        """The feedback of Dock."""

        sees_dock: bool = False


class DriveArc(ActionType, typename="irobot_create_msgs/action/DriveArc"):
    """DriveArc, as the Create 3 defines it."""

    class Goal(Message):
        """The goal of DriveArc."""

        TRANSLATE_FORWARD: ClassVar[int8] = 1
        TRANSLATE_BACKWARD: ClassVar[int8] = -1

        translate_direction: int8 = 0
        angle: float32 = 0.0
        radius: float32 = 0.0
        max_translation_speed: float32 = 0.3

    class Result(Message):
        """The result of DriveArc."""

        pose: PoseStamped = DEFAULT

    class Feedback(Message):
        """The feedback of DriveArc."""

        remaining_angle_travel: float32 = 0.0


class DriveDistance(ActionType, typename="irobot_create_msgs/action/DriveDistance"):
    """DriveDistance, as the Create 3 defines it."""

    class Goal(Message):
        """The goal of DriveDistance."""

        distance: float32 = 0.0
        max_translation_speed: float32 = 0.3

    class Result(Message):
        """The result of DriveDistance."""

        pose: PoseStamped = DEFAULT

    class Feedback(Message):
        """The feedback of DriveDistance."""

        remaining_travel_distance: float32 = 0.0


class LedAnimation(ActionType, typename="irobot_create_msgs/action/LedAnimation"):
    """LedAnimation, as the Create 3 defines it."""

    class Goal(Message):
        """The goal of LedAnimation."""

        BLINK_LIGHTS: ClassVar[int8] = 1
        SPIN_LIGHTS: ClassVar[int8] = 2

        animation_type: int8 = 0
        lightring: LightringLeds = DEFAULT
        max_runtime: Duration = DEFAULT

    class Result(Message):
        """The result of LedAnimation."""

        runtime: Duration = DEFAULT

    class Feedback(Message):
        """The feedback of LedAnimation."""

        remaining_runtime: Duration = DEFAULT


class NavigateToPosition(ActionType, typename="irobot_create_msgs/action/NavigateToPosition"):
    """NavigateToPosition, as the Create 3 defines it."""

    class Goal(Message):
        """The goal of NavigateToPosition."""

        goal_pose: PoseStamped = DEFAULT
        achieve_goal_heading: bool = False
        max_translation_speed: float32 = 0.3
        max_rotation_speed: float32 = 1.9

    class Result(Message):
        """The result of NavigateToPosition."""

        pose: PoseStamped = DEFAULT

    class Feedback(Message):
        """The feedback of NavigateToPosition."""

        ROTATING_TO_GOAL_POSITION: ClassVar[int8] = 1
        DRIVING_TO_GOAL_POSITION: ClassVar[int8] = 2
        ROTATING_TO_GOAL_ORIENTATION: ClassVar[int8] = 3

        navigate_state: int8 = 0
        remaining_angle_travel: float32 = 0.0
        remaining_travel_distance: float32 = 0.0


class RotateAngle(ActionType, typename="irobot_create_msgs/action/RotateAngle"):
    """RotateAngle, as the Create 3 defines it."""

    class Goal(Message):
        """The goal of RotateAngle."""

        angle: float32 = 0.0
        max_rotation_speed: float32 = 1.9

    class Result(Message):
        """The result of RotateAngle."""

        pose: PoseStamped = DEFAULT

    class Feedback(Message):
        """The feedback of RotateAngle."""

        remaining_angle_travel: float32 = 0.0


class Undock(ActionType, typename="irobot_create_msgs/action/Undock"):
    """Undock, as the Create 3 defines it."""

    class Goal(Message):
        """The goal of Undock."""

    class Result(Message):
        """The result of Undock."""

        is_docked: bool = False

    class Feedback(Message):
        """The feedback of Undock."""


class WallFollow(ActionType, typename="irobot_create_msgs/action/WallFollow"):
    """WallFollow, as the Create 3 defines it."""

    class Goal(Message):
        """The goal of WallFollow."""

        FOLLOW_RIGHT: ClassVar[int8] = -1
        FOLLOW_LEFT: ClassVar[int8] = 1

        follow_side: int8 = 0
        max_runtime: Duration = DEFAULT

    class Result(Message):
        """The result of WallFollow."""

        runtime: Duration = DEFAULT

    class Feedback(Message):
        """The feedback of WallFollow."""

        engaged: bool = False
