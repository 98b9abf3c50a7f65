"""ROS 2's listener to a managed talker: to its messages, and to its transitions."""

import aionode
from aionode import Node
from aionode.interfaces.lifecycle_msgs.msg import TransitionEvent
from aionode.interfaces.std_msgs.msg import String


class LifecycleListener(Node):
    """Listens to `lifecycle_talker.py`."""

    def __init__(self) -> None:
        super().__init__("lc_listener")
        self.create_subscription(String, "/lifecycle_chatter", self.on_data, 10)
        self.create_subscription(
            TransitionEvent, "/lc_talker/transition_event", self.on_transition, 10
        )

    def on_data(self, msg: String) -> None:
        """Log what the talker says while it is active."""
        self.get_logger().info(f"data_callback: {msg.data}")

    def on_transition(self, event: TransitionEvent) -> None:
        """Log each change of the talker's state."""
        self.get_logger().info(
            f"notify callback: Transition from state {event.start_state.label} to "
            f"{event.goal_state.label}"
        )


if __name__ == "__main__":
    aionode.run(LifecycleListener)
