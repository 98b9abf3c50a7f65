"""Actions of py_trees_ros_interfaces.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from aionode.interfaces.geometry_msgs.msg import PoseStamped
from aionode.message import DEFAULT, ActionType, Message, float32

__all__ = ["Dock", "MoveBase", "Rotate"]


class Dock(ActionType, typename="py_trees_ros_interfaces/action/Dock"):
    """Dock, as py_trees_ros defines it."""

    class Goal(Message):
        """The goal of Dock."""

        dock: bool = False

    class Result(Message):
        """The result of Dock."""

        message: str = ""

    class Feedback(Message):
        """The feedback of Dock."""

        percentage_completed: float32 = 0.0


class MoveBase(ActionType, typename="py_trees_ros_interfaces/action/MoveBase"):
    """MoveBase, as py_trees_ros defines it."""

    class Goal(Message):
        """The goal of MoveBase."""

        target_pose: PoseStamped = DEFAULT

    class Result(Message):
        """The result of MoveBase."""

        message: str = ""

    class Feedback(Message):
        """The feedback of MoveBase."""

        base_position: PoseStamped = DEFAULT


class Rotate(ActionType, typename="py_trees_ros_interfaces/action/Rotate"):
    """Rotate, as py_trees_ros defines it."""

    class Goal(Message):
        """The goal of Rotate."""

    class Result(Message):
        """The result of Rotate."""

        message: str = ""

    class Feedback(Message):
        """The feedback of Rotate."""

        percentage_completed: float32 = 0.0
        angle_rotated: float32 = 0.0
