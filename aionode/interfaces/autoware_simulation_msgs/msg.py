"""Messages of autoware_simulation_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import ClassVar

from aionode.interfaces.autoware_perception_msgs.msg import ObjectClassification, Shape
from aionode.interfaces.geometry_msgs.msg import (
    AccelWithCovariance,
    PoseWithCovariance,
    TwistWithCovariance,
)
from aionode.interfaces.std_msgs.msg import Header
from aionode.interfaces.unique_identifier_msgs.msg import UUID
from aionode.message import DEFAULT, Message, float32, uint8

__all__ = ["SimulatedObject", "SimulatedObjectInitialState"]


class SimulatedObjectInitialState(
    Message, typename="autoware_simulation_msgs/msg/SimulatedObjectInitialState"
):
    """SimulatedObjectInitialState, as Autoware defines it."""

    pose_covariance: PoseWithCovariance = DEFAULT
    twist_covariance: TwistWithCovariance = DEFAULT
    accel_covariance: AccelWithCovariance = DEFAULT


class SimulatedObject(Message, typename="autoware_simulation_msgs/msg/SimulatedObject"):
    """SimulatedObject, as Autoware defines it."""

    ADD: ClassVar[uint8] = 0
    MODIFY: ClassVar[uint8] = 1
    DELETE: ClassVar[uint8] = 2
    DELETE_ALL: ClassVar[uint8] = 3
    STRAIGHT_LINE: ClassVar[uint8] = 0
    PREDICTED_PATH: ClassVar[uint8] = 1

    header: Header = DEFAULT
    id: UUID = DEFAULT
    initial_state: SimulatedObjectInitialState = DEFAULT
    classification: ObjectClassification = DEFAULT
    shape: Shape = DEFAULT
    max_velocity: float32 = 0.0
    min_velocity: float32 = 0.0
    action: uint8 = 0
    movement_model: uint8 = 0
