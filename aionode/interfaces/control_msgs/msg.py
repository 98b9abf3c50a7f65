"""Messages of control_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.builtin_interfaces.msg import Duration
from aionode.interfaces.geometry_msgs.msg import (
    PoseStamped,
    Quaternion,
    TransformStamped,
    Twist,
    TwistStamped,
    WrenchStamped,
)
from aionode.interfaces.sensor_msgs.msg import BatteryState, JointState
from aionode.interfaces.std_msgs.msg import Float64MultiArray, Header, Int8MultiArray, String
from aionode.interfaces.trajectory_msgs.msg import (
    JointTrajectoryPoint,
    MultiDOFJointTrajectoryPoint,
)
from aionode.message import DEFAULT, Floats, Message, Sequence, float64, int8, uint16

__all__ = [
    "AdmittanceControllerState",
    "BatteryStateArray",
    "DynamicInterfaceGroupValues",
    "DynamicInterfaceValues",
    "DynamicJointState",
    "Float64Values",
    "GripperCommand",
    "InterfaceValue",
    "JointComponentTolerance",
    "JointControllerState",
    "JointJog",
    "JointTolerance",
    "JointTrajectoryControllerState",
    "Keys",
    "MecanumDriveControllerState",
    "MotionArgument",
    "MotionPrimitive",
    "MotionPrimitiveSequence",
    "MultiDOFCommand",
    "MultiDOFStateStamped",
    "PidState",
    "SingleDOFState",
    "SingleDOFStateStamped",
    "SpeedScalingFactor",
    "SteeringControllerStatus",
    "VDA5050SafetyState",
]


class MotionArgument(Message, typename="control_msgs/msg/MotionArgument"):
    """MotionArgument, as ros-controls defines it."""

    name: str = ""
    value: float64 = 0.0


class MotionPrimitive(Message, typename="control_msgs/msg/MotionPrimitive"):
    """MotionPrimitive, as ros-controls defines it."""

    UNKNOWN: ClassVar[int8] = -1
    LINEAR_JOINT: ClassVar[int8] = 0
    LINEAR_CARTESIAN: ClassVar[int8] = 50
    CIRCULAR_CARTESIAN: ClassVar[int8] = 51

    type: int8 = -1
    blend_radius: float64 = 0.0
    additional_arguments: Annotated[list[MotionArgument], Sequence[MotionArgument]] = DEFAULT
    poses: Annotated[list[PoseStamped], Sequence[PoseStamped]] = DEFAULT
    joint_positions: Annotated[Floats, Sequence[float64]] = DEFAULT


class MotionPrimitiveSequence(Message, typename="control_msgs/msg/MotionPrimitiveSequence"):
    """MotionPrimitiveSequence, as ros-controls defines it."""

    motions: Annotated[list[MotionPrimitive], Sequence[MotionPrimitive]] = DEFAULT


class JointTolerance(Message, typename="control_msgs/msg/JointTolerance"):
    """JointTolerance, as ros-controls defines it."""

    name: str = ""
    position: float64 = 0.0
    velocity: float64 = 0.0
    acceleration: float64 = 0.0


class JointComponentTolerance(Message, typename="control_msgs/msg/JointComponentTolerance"):
    """JointComponentTolerance, as ros-controls defines it."""

    X_AXIS: ClassVar[uint16] = 1
    Y_AXIS: ClassVar[uint16] = 2
    Z_AXIS: ClassVar[uint16] = 3
    TRANSLATION: ClassVar[uint16] = 4
    ROTATION: ClassVar[uint16] = 5

    joint_name: str = ""
    component: uint16 = 0
    position: float64 = 0.0
    velocity: float64 = 0.0
    acceleration: float64 = 0.0


class GripperCommand(Message, typename="control_msgs/msg/GripperCommand"):
    """GripperCommand, as ros-controls defines it."""

    position: float64 = 0.0
    max_effort: float64 = 0.0


class AdmittanceControllerState(Message, typename="control_msgs/msg/AdmittanceControllerState"):
    """AdmittanceControllerState, as ros-controls defines it."""

    mass: Float64MultiArray = DEFAULT
    damping: Float64MultiArray = DEFAULT
    stiffness: Float64MultiArray = DEFAULT
    rot_base_control: Quaternion = DEFAULT
    ref_trans_base_ft: TransformStamped = DEFAULT
    selected_axes: Int8MultiArray = DEFAULT
    ft_sensor_frame: String = DEFAULT
    admittance_position: TransformStamped = DEFAULT
    admittance_acceleration: TwistStamped = DEFAULT
    admittance_velocity: TwistStamped = DEFAULT
    wrench_base: WrenchStamped = DEFAULT
    joint_state: JointState = DEFAULT


class BatteryStateArray(Message, typename="control_msgs/msg/BatteryStateArray"):
    """BatteryStateArray, as ros-controls defines it."""

    battery_states: Annotated[list[BatteryState], Sequence[BatteryState]] = DEFAULT


class InterfaceValue(Message, typename="control_msgs/msg/InterfaceValue"):
    """InterfaceValue, as ros-controls defines it."""

    interface_names: Annotated[list[str], Sequence[str]] = DEFAULT
    values: Annotated[Floats, Sequence[float64]] = DEFAULT


class DynamicInterfaceGroupValues(Message, typename="control_msgs/msg/DynamicInterfaceGroupValues"):
    """DynamicInterfaceGroupValues, as ros-controls defines it."""

    header: Header = DEFAULT
    interface_groups: Annotated[list[str], Sequence[str]] = DEFAULT
    interface_values: Annotated[list[InterfaceValue], Sequence[InterfaceValue]] = DEFAULT


class DynamicInterfaceValues(Message, typename="control_msgs/msg/DynamicInterfaceValues"):
    """DynamicInterfaceValues, as ros-controls defines it."""

    header: Header = DEFAULT
    states: InterfaceValue = DEFAULT
    commands: InterfaceValue = DEFAULT


class DynamicJointState(Message, typename="control_msgs/msg/DynamicJointState"):
    """DynamicJointState, as ros-controls defines it."""

    header: Header = DEFAULT
    joint_names: Annotated[list[str], Sequence[str]] = DEFAULT
    interface_values: Annotated[list[InterfaceValue], Sequence[InterfaceValue]] = DEFAULT


class Float64Values(Message, typename="control_msgs/msg/Float64Values"):
    """Float64Values, as ros-controls defines it."""

    header: Header = DEFAULT
    values: Annotated[Floats, Sequence[float64]] = DEFAULT


class JointControllerState(Message, typename="control_msgs/msg/JointControllerState"):
    """JointControllerState, as ros-controls defines it."""

    header: Header = DEFAULT
    set_point: float64 = 0.0
    process_value: float64 = 0.0
    process_value_dot: float64 = 0.0
    error: float64 = 0.0
    time_step: float64 = 0.0
    command: float64 = 0.0
    p: float64 = 0.0
    i: float64 = 0.0
    d: float64 = 0.0
    i_clamp: float64 = 0.0
    antiwindup: bool = False


class JointJog(Message, typename="control_msgs/msg/JointJog"):
    """JointJog, as ros-controls defines it."""

    header: Header = DEFAULT
    joint_names: Annotated[list[str], Sequence[str]] = DEFAULT
    displacements: Annotated[Floats, Sequence[float64]] = DEFAULT
    velocities: Annotated[Floats, Sequence[float64]] = DEFAULT
    duration: float64 = 0.0


class JointTrajectoryControllerState(
    Message, typename="control_msgs/msg/JointTrajectoryControllerState"
):
    """JointTrajectoryControllerState, as ros-controls defines it."""

    header: Header = DEFAULT
    joint_names: Annotated[list[str], Sequence[str]] = DEFAULT
    reference: JointTrajectoryPoint = DEFAULT
    feedback: JointTrajectoryPoint = DEFAULT
    error: JointTrajectoryPoint = DEFAULT
    output: JointTrajectoryPoint = DEFAULT
    multi_dof_joint_names: Annotated[list[str], Sequence[str]] = DEFAULT
    multi_dof_reference: MultiDOFJointTrajectoryPoint = DEFAULT
    multi_dof_feedback: MultiDOFJointTrajectoryPoint = DEFAULT
    multi_dof_error: MultiDOFJointTrajectoryPoint = DEFAULT
    multi_dof_output: MultiDOFJointTrajectoryPoint = DEFAULT
    speed_scaling_factor: float64 = 0.0


class Keys(Message, typename="control_msgs/msg/Keys"):
    """Keys, as ros-controls defines it."""

    header: Header = DEFAULT
    keys: Annotated[list[str], Sequence[str]] = DEFAULT


class MecanumDriveControllerState(Message, typename="control_msgs/msg/MecanumDriveControllerState"):
    """MecanumDriveControllerState, as ros-controls defines it."""

    header: Header = DEFAULT
    front_left_wheel_velocity: float64 = 0.0
    back_left_wheel_velocity: float64 = 0.0
    back_right_wheel_velocity: float64 = 0.0
    front_right_wheel_velocity: float64 = 0.0
    reference_velocity: Twist = DEFAULT


class MultiDOFCommand(Message, typename="control_msgs/msg/MultiDOFCommand"):
    """MultiDOFCommand, as ros-controls defines it."""

    dof_names: Annotated[list[str], Sequence[str]] = DEFAULT
    values: Annotated[Floats, Sequence[float64]] = DEFAULT
    values_dot: Annotated[Floats, Sequence[float64]] = DEFAULT


class SingleDOFState(Message, typename="control_msgs/msg/SingleDOFState"):
    """SingleDOFState, as ros-controls defines it."""

    name: str = ""
    reference: float64 = 0.0
    feedback: float64 = 0.0
    feedback_dot: float64 = 0.0
    error: float64 = 0.0
    error_dot: float64 = 0.0
    time_step: float64 = 0.0
    output: float64 = 0.0


class MultiDOFStateStamped(Message, typename="control_msgs/msg/MultiDOFStateStamped"):
    """MultiDOFStateStamped, as ros-controls defines it."""

    header: Header = DEFAULT
    dof_states: Annotated[list[SingleDOFState], Sequence[SingleDOFState]] = DEFAULT


class PidState(Message, typename="control_msgs/msg/PidState"):
    """PidState, as ros-controls defines it."""

    header: Header = DEFAULT
    timestep: Duration = DEFAULT
    error: float64 = 0.0
    error_dot: float64 = 0.0
    p_error: float64 = 0.0
    i_error: float64 = 0.0
    d_error: float64 = 0.0
    p_term: float64 = 0.0
    i_term: float64 = 0.0
    d_term: float64 = 0.0
    i_max: float64 = 0.0
    i_min: float64 = 0.0
    output: float64 = 0.0


class SingleDOFStateStamped(Message, typename="control_msgs/msg/SingleDOFStateStamped"):
    """SingleDOFStateStamped, as ros-controls defines it."""

    header: Header = DEFAULT
    dof_state: SingleDOFState = DEFAULT


class SpeedScalingFactor(Message, typename="control_msgs/msg/SpeedScalingFactor"):
    """SpeedScalingFactor, as ros-controls defines it."""

    factor: float64 = 0.0


class SteeringControllerStatus(Message, typename="control_msgs/msg/SteeringControllerStatus"):
    """SteeringControllerStatus, as ros-controls defines it."""

    header: Header = DEFAULT
    traction_wheels_position: Annotated[Floats, Sequence[float64]] = DEFAULT
    traction_wheels_velocity: Annotated[Floats, Sequence[float64]] = DEFAULT
    steer_positions: Annotated[Floats, Sequence[float64]] = DEFAULT
    linear_velocity_command: Annotated[Floats, Sequence[float64]] = DEFAULT
    steering_angle_command: Annotated[Floats, Sequence[float64]] = DEFAULT


class VDA5050SafetyState(Message, typename="control_msgs/msg/VDA5050SafetyState"):
    """VDA5050SafetyState, as ros-controls defines it."""

    AUTO_ACK: ClassVar[str] = "autoAck"
    MANUAL: ClassVar[str] = "manual"
    REMOTE: ClassVar[str] = "remote"
    NONE: ClassVar[str] = "none"

    e_stop: str = ""
    field_violation: bool = False
