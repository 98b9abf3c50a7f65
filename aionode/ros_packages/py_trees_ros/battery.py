"""A behaviour that watches a battery."""

from __future__ import annotations

from typing import Any

from py_trees.common import Access, ClearingPolicy, Status
from sensor_msgs.msg import BatteryState

from py_trees_ros import subscribers

__all__ = ["ToBlackboard"]

HYSTERESIS = 5.0


class ToBlackboard(subscribers.ToBlackboard):
    """Writes a battery's state to ``battery``, and whether it is low to ``battery_low_warning``.

    The warning ends 5 above the threshold at which it begins.

    Args:
        name: The behaviour's name.
        topic_name: The topic.
        qos_profile: The profile of the subscription.
        threshold: The percentage below which a battery is low, in the unit of the messages.
    """

    def __init__(
        self, name: str, topic_name: str, qos_profile: Any, threshold: float = 30.0
    ) -> None:
        super().__init__(
            name=name,
            topic_name=topic_name,
            topic_type=BatteryState,
            qos_profile=qos_profile,
            blackboard_variables={"battery": None},
            clearing_policy=ClearingPolicy.NEVER,
        )
        self.blackboard.register_key(key="battery_low_warning", access=Access.WRITE)
        self.blackboard.battery = BatteryState(
            percentage=0.0,
            power_supply_status=BatteryState.POWER_SUPPLY_STATUS_UNKNOWN,
        )
        self.blackboard.battery_low_warning = False
        self.threshold = threshold

    def update(self) -> Status:
        """Write the state, and the warning."""
        self.logger.debug(f"{type(self).__name__}.update()")
        status = super().update()
        if status is not Status.RUNNING:
            percentage = self.blackboard.battery.percentage
            if percentage > self.threshold + HYSTERESIS:
                self.blackboard.battery_low_warning = False
            elif percentage < self.threshold:
                self.blackboard.battery_low_warning = True
                self.node.get_logger().error(f"{self.name}: battery level is low!")
            how = "low" if self.blackboard.battery_low_warning else "ok"
            self.feedback_message = f"Battery level is {how}"
        return status
