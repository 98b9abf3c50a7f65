"""Actions of action_tutorials_interfaces.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.message import DEFAULT, ActionType, Ints, Message, Sequence, int32

__all__ = ["Fibonacci"]


class Fibonacci(ActionType, typename="action_tutorials_interfaces/action/Fibonacci"):
    """Compute Fibonacci numbers, slowly enough to watch: the example of an action."""

    class Goal(Message):
        """How far to compute: `order` numbers follow the first."""

        order: int32 = 0

    class Result(Message):
        """The whole sequence."""

        sequence: Annotated[Ints, Sequence[int32]] = DEFAULT

    class Feedback(Message):
        """The sequence as far as it is computed."""

        partial_sequence: Annotated[Ints, Sequence[int32]] = DEFAULT
