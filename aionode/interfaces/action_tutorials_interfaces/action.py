"""Actions of action_tutorials_interfaces.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.message import DEFAULT, ActionType, Ints, Message, Sequence, int32

__all__ = ["Fibonacci"]


class Fibonacci(ActionType, typename="action_tutorials_interfaces/action/Fibonacci"):
    """Fibonacci."""

    class Goal(Message):
        """The goal of Fibonacci."""

        order: int32 = 0

    class Result(Message):
        """The result of Fibonacci."""

        sequence: Annotated[Ints, Sequence[int32]] = DEFAULT

    class Feedback(Message):
        """The feedback of Fibonacci."""

        partial_sequence: Annotated[Ints, Sequence[int32]] = DEFAULT
