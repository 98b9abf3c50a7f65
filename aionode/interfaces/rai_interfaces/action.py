"""Actions of rai_interfaces.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from aionode.message import ActionType, Message

__all__ = ["Task", "TaskFeedback"]


class Task(ActionType, typename="rai_interfaces/action/Task"):
    """Task, as RAI defines it."""

    class Goal(Message):
        """The goal of Task."""

        task: str = ""
        description: str = ""
        priority: str = ""

    class Result(Message):
        """The result of Task."""

        success: bool = False
        report: str = ""

    class Feedback(Message):
        """The feedback of Task."""

        current_status: str = ""


class TaskFeedback(ActionType, typename="rai_interfaces/action/TaskFeedback"):
    """TaskFeedback, as RAI defines it."""

    class Goal(Message):
        """The goal of TaskFeedback."""

        issue_description: str = ""
        current_task: str = ""
        additional_info: str = ""

    class Result(Message):
        """The result of TaskFeedback."""

        informations: str = ""
        success: bool = False

    class Feedback(Message):
        """The feedback of TaskFeedback."""

        feedback: str = ""
