"""ROS 2's managed talker: it publishes only after another program has activated it.

`lifecycle_manager.py` does that, or ``aionode lifecycle set /lc_talker configure``.
"""

import aionode
from aionode.interfaces.std_msgs.msg import String
from aionode.lifecycle import LifecycleNode, State, TransitionCallbackReturn


class LifecycleTalker(LifecycleNode):
    """Makes its publisher when it is configured, and destroys it when it is cleaned up."""

    def __init__(self) -> None:
        super().__init__("lc_talker")
        self.count = 0

    def on_configure(self, state: State) -> TransitionCallbackReturn:
        """Create the publisher and its timer, which do nothing yet."""
        self.publisher = self.create_lifecycle_publisher(String, "/lifecycle_chatter", 10)
        self.timer = self.create_timer(0.1, self.say)
        self.get_logger().info("on_configure() is called.")
        super().on_configure(state)
        return TransitionCallbackReturn.SUCCESS

    async def on_activate(self, state: State) -> TransitionCallbackReturn:
        """Warm up for a moment, during which `get_state` answers `activating`; then publish."""
        await self.get_clock().sleep(0.2)
        self.get_logger().info("on_activate() is called.")
        super().on_activate(state)
        return TransitionCallbackReturn.SUCCESS

    def on_deactivate(self, state: State) -> TransitionCallbackReturn:
        """Stop publishing."""
        self.get_logger().info("on_deactivate() is called.")
        super().on_deactivate(state)
        return TransitionCallbackReturn.SUCCESS

    def on_cleanup(self, state: State) -> TransitionCallbackReturn:
        """Destroy what `on_configure` created."""
        self.destroy_timer(self.timer)
        self.destroy_lifecycle_publisher(self.publisher)
        self.get_logger().info("on_cleanup() is called.")
        super().on_cleanup(state)
        return TransitionCallbackReturn.SUCCESS

    def on_shutdown(self, state: State) -> TransitionCallbackReturn:
        """Leave for good, from any state."""
        self.get_logger().info(f"on_shutdown() is called from state {state.label}.")
        super().on_shutdown(state)
        return TransitionCallbackReturn.SUCCESS

    def say(self) -> None:
        """Publish one greeting, which is discarded while the node is not active."""
        self.count += 1
        text = f"Lifecycle HelloWorld #{self.count}"
        if self.publisher.is_activated:
            self.get_logger().info(f"Lifecycle publisher is active. Publishing: [{text}]")
        else:
            self.get_logger().info("Lifecycle publisher is inactive. Messages are not published.")
        self.publisher.publish(String(data=text))


if __name__ == "__main__":
    aionode.run(LifecycleTalker)
