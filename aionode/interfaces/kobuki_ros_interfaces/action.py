"""Actions of kobuki_ros_interfaces.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from aionode.message import ActionType, Message

__all__ = ["AutoDocking"]


class AutoDocking(ActionType, typename="kobuki_ros_interfaces/action/AutoDocking"):
    """AutoDocking, as Kobuki defines it."""

    class Goal(Message):
        """The goal of AutoDocking."""

    class Result(Message):
        """The result of AutoDocking."""

        text: str = ""

    class Feedback(Message):
        """The feedback of AutoDocking."""

        state: str = ""
        text: str = ""
