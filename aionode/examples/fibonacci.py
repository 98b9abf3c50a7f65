"""An action: a goal that takes time, sends feedback, and can be canceled.

Run it with ``python -m aionode.examples.fibonacci``.
"""

from __future__ import annotations

import aionode
from aionode import ActionClient, CancelResponse, Node, ServerGoalHandle
from aionode.interfaces.example_interfaces.action import Fibonacci

__all__ = ["FibonacciServer", "application", "main"]

STEP_SEC = 0.2

Handle = ServerGoalHandle[Fibonacci.Goal, Fibonacci.Result, Fibonacci.Feedback]
FibonacciClient = ActionClient[Fibonacci.Goal, Fibonacci.Result, Fibonacci.Feedback]


class FibonacciServer(Node):
    """Serves /fibonacci: computes the sequence up to the order in the goal, step by step."""

    def __init__(self) -> None:
        super().__init__("fibonacci_server")
        self.server = self.create_action_server(
            Fibonacci,
            "/fibonacci",
            self.execute,
            cancel_callback=lambda _handle: CancelResponse.ACCEPT,
            on_client_lost="cancel",
        )

    async def execute(self, handle: Handle) -> Fibonacci.Result:
        """Execute one goal; an accepted cancel request cancels this coroutine."""
        sequence = [0, 1]
        for _ in range(handle.request.order - 1):
            await self.get_clock().sleep(STEP_SEC)
            sequence.append(sequence[-2] + sequence[-1])
            handle.publish_feedback(Fibonacci.Feedback(sequence=sequence))
        handle.succeed()
        return Fibonacci.Result(sequence=sequence)


async def application() -> None:
    """Await the result of one goal, the feedback of a second, and cancel a third."""
    async with FibonacciServer(), Node("application") as node:
        client = node.create_action_client(Fibonacci, "/fibonacci")
        await client.wait_for_server()
        await call(client)
        await watch(client)
        await cancel(client)


async def call(client: FibonacciClient) -> None:
    """Send a goal and await its result in one call."""
    result = await client.call(Fibonacci.Goal(order=5))
    print(f"called:    {result.sequence.tolist()}", flush=True)


async def watch(client: FibonacciClient) -> None:
    """Print the feedback while the goal is executed."""
    goal = await client.send_goal(Fibonacci.Goal(order=5))
    async for feedback in goal:
        print(f"feedback:  {feedback.sequence.tolist()}", flush=True)
    outcome = await goal.result()
    print(f"result:    {outcome.result.sequence.tolist()}, {outcome.status.name}", flush=True)


async def cancel(client: FibonacciClient) -> None:
    """Cancel a goal after its second feedback."""
    goal = await client.send_goal(Fibonacci.Goal(order=40))
    await anext(goal)
    await anext(goal)
    await goal.cancel()
    outcome = await goal.result()
    print(f"cancelled: {outcome.status.name}", flush=True)


def main() -> None:
    """Run the application until the last goal has ended, or until Ctrl-C."""
    aionode.run(application)


if __name__ == "__main__":
    main()
