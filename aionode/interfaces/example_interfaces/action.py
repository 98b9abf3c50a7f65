"""example_interfaces."""

from typing import Annotated

from aionode.message import ActionType, DEFAULT, Ints, Message, Sequence, int32


class Fibonacci(ActionType, typename="example_interfaces/action/Fibonacci"):
    """Fibonacci."""

    class Goal(Message):
        """Goal."""

        order: int32 = 0

    class Result(Message):
        """Result."""

        sequence: Annotated[Ints, Sequence[int32]] = DEFAULT

    class Feedback(Message):
        """Feedback."""

        sequence: Annotated[Ints, Sequence[int32]] = DEFAULT
