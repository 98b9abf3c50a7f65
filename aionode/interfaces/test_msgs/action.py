"""Actions of test_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.interfaces.test_msgs.msg import BasicTypes, Builtins
from aionode.message import DEFAULT, ActionType, Ints, Message, Sequence, int32

__all__ = ["Fibonacci", "NestedMessage"]


class Fibonacci(ActionType, typename="test_msgs/action/Fibonacci"):
    """For tests: an action as in the tutorials."""

    class Goal(Message):
        """The goal of Fibonacci."""

        order: int32 = 0

    class Result(Message):
        """The result of Fibonacci."""

        sequence: Annotated[Ints, Sequence[int32]] = DEFAULT

    class Feedback(Message):
        """The feedback of Fibonacci."""

        sequence: Annotated[Ints, Sequence[int32]] = DEFAULT


class NestedMessage(ActionType, typename="test_msgs/action/NestedMessage"):
    """For tests: an action of nested messages."""

    class Goal(Message):
        """The goal of NestedMessage."""

        nested_field_no_pkg: Builtins = DEFAULT
        nested_field: BasicTypes = DEFAULT
        nested_different_pkg: Time = DEFAULT

    class Result(Message):
        """The result of NestedMessage."""

        nested_field_no_pkg: Builtins = DEFAULT
        nested_field: BasicTypes = DEFAULT
        nested_different_pkg: Time = DEFAULT

    class Feedback(Message):
        """The feedback of NestedMessage."""

        nested_field_no_pkg: Builtins = DEFAULT
        nested_field: BasicTypes = DEFAULT
        nested_different_pkg: Time = DEFAULT
