"""Let a follower arm do what a person does with a leader arm, to record demonstrations.

Run it with ``python examples/learn/follow_leader.py``; the leader publishes its joints on
/leader/joint_states, and the follower listens to /arm/command.
"""

from pathlib import Path

import aionode
from aionode import Node
from aionode.errors import LeaseExpiredError
from aionode.interfaces.sensor_msgs.msg import JointState
from aionode.learn import Contract

CONTRACT = Contract.load(Path(__file__).with_name("follower.yaml"))


class Teleoperator(Node):
    """Commands the follower to be where the leader is."""

    def __init__(self) -> None:
        super().__init__("teleoperator")
        self.leader = self.create_subscription(JointState, "/leader/joint_states", qos_profile=1)
        self.start = self.create_timer(0.0, self.follow)

    async def follow(self) -> None:
        """Follow within the limits of the contract; hold still while the leader is silent."""
        self.start.cancel()
        (action,) = CONTRACT.actions
        while True:
            try:
                async with CONTRACT.act(self) as actor:
                    async for state in self.leader:
                        actor.send(action.value(state))
            except LeaseExpiredError as error:
                self.get_logger().warning(f"The leader is silent: {error}")


if __name__ == "__main__":
    aionode.run(Teleoperator)
