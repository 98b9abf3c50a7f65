"""Messages of gazebo_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.geometry_msgs.msg import Pose, Twist, Vector3, Wrench
from aionode.interfaces.std_msgs.msg import Header
from aionode.message import DEFAULT, Floats, Message, Sequence, float64, uint32

__all__ = [
    "ContactState",
    "ContactsState",
    "EntityState",
    "LinkState",
    "LinkStates",
    "ModelState",
    "ModelStates",
    "ODEJointProperties",
    "ODEPhysics",
    "PerformanceMetrics",
    "SensorPerformanceMetric",
    "WheelSlip",
    "WorldState",
]


class ContactState(Message, typename="gazebo_msgs/msg/ContactState"):
    """ContactState, as gazebo_ros_pkgs defines it."""

    info: str = ""
    collision1_name: str = ""
    collision2_name: str = ""
    wrenches: Annotated[list[Wrench], Sequence[Wrench]] = DEFAULT
    total_wrench: Wrench = DEFAULT
    contact_positions: Annotated[list[Vector3], Sequence[Vector3]] = DEFAULT
    contact_normals: Annotated[list[Vector3], Sequence[Vector3]] = DEFAULT
    depths: Annotated[Floats, Sequence[float64]] = DEFAULT


class ContactsState(Message, typename="gazebo_msgs/msg/ContactsState"):
    """ContactsState, as gazebo_ros_pkgs defines it."""

    header: Header = DEFAULT
    states: Annotated[list[ContactState], Sequence[ContactState]] = DEFAULT


class EntityState(Message, typename="gazebo_msgs/msg/EntityState"):
    """EntityState, as gazebo_ros_pkgs defines it."""

    name: str = ""
    pose: Pose = DEFAULT
    twist: Twist = DEFAULT
    reference_frame: str = ""


class LinkState(Message, typename="gazebo_msgs/msg/LinkState"):
    """LinkState, as gazebo_ros_pkgs defines it."""

    link_name: str = ""
    pose: Pose = DEFAULT
    twist: Twist = DEFAULT
    reference_frame: str = ""


class LinkStates(Message, typename="gazebo_msgs/msg/LinkStates"):
    """LinkStates, as gazebo_ros_pkgs defines it."""

    name: Annotated[list[str], Sequence[str]] = DEFAULT
    pose: Annotated[list[Pose], Sequence[Pose]] = DEFAULT
    twist: Annotated[list[Twist], Sequence[Twist]] = DEFAULT


class ModelState(Message, typename="gazebo_msgs/msg/ModelState"):
    """ModelState, as gazebo_ros_pkgs defines it."""

    model_name: str = ""
    pose: Pose = DEFAULT
    twist: Twist = DEFAULT
    reference_frame: str = ""


class ModelStates(Message, typename="gazebo_msgs/msg/ModelStates"):
    """ModelStates, as gazebo_ros_pkgs defines it."""

    name: Annotated[list[str], Sequence[str]] = DEFAULT
    pose: Annotated[list[Pose], Sequence[Pose]] = DEFAULT
    twist: Annotated[list[Twist], Sequence[Twist]] = DEFAULT


class ODEJointProperties(Message, typename="gazebo_msgs/msg/ODEJointProperties"):
    """ODEJointProperties, as gazebo_ros_pkgs defines it."""

    damping: Annotated[Floats, Sequence[float64]] = DEFAULT
    hi_stop: Annotated[Floats, Sequence[float64]] = DEFAULT
    lo_stop: Annotated[Floats, Sequence[float64]] = DEFAULT
    erp: Annotated[Floats, Sequence[float64]] = DEFAULT
    cfm: Annotated[Floats, Sequence[float64]] = DEFAULT
    stop_erp: Annotated[Floats, Sequence[float64]] = DEFAULT
    stop_cfm: Annotated[Floats, Sequence[float64]] = DEFAULT
    fudge_factor: Annotated[Floats, Sequence[float64]] = DEFAULT
    fmax: Annotated[Floats, Sequence[float64]] = DEFAULT
    vel: Annotated[Floats, Sequence[float64]] = DEFAULT


class ODEPhysics(Message, typename="gazebo_msgs/msg/ODEPhysics"):
    """ODEPhysics, as gazebo_ros_pkgs defines it."""

    auto_disable_bodies: bool = False
    sor_pgs_precon_iters: uint32 = 0
    sor_pgs_iters: uint32 = 0
    sor_pgs_w: float64 = 0.0
    sor_pgs_rms_error_tol: float64 = 0.0
    contact_surface_layer: float64 = 0.0
    contact_max_correcting_vel: float64 = 0.0
    cfm: float64 = 0.0
    erp: float64 = 0.0
    max_contacts: uint32 = 0


class SensorPerformanceMetric(Message, typename="gazebo_msgs/msg/SensorPerformanceMetric"):
    """SensorPerformanceMetric, as gazebo_ros_pkgs defines it."""

    name: str = ""
    sim_update_rate: float64 = 0.0
    real_update_rate: float64 = 0.0
    fps: float64 = 0.0


class PerformanceMetrics(Message, typename="gazebo_msgs/msg/PerformanceMetrics"):
    """PerformanceMetrics, as gazebo_ros_pkgs defines it."""

    header: Header = DEFAULT
    real_time_factor: float64 = 0.0
    sensors: Annotated[list[SensorPerformanceMetric], Sequence[SensorPerformanceMetric]] = DEFAULT


class WheelSlip(Message, typename="gazebo_msgs/msg/WheelSlip"):
    """WheelSlip, as gazebo_ros_pkgs defines it."""

    name: Annotated[list[str], Sequence[str]] = DEFAULT
    lateral_slip: Annotated[Floats, Sequence[float64]] = DEFAULT
    longitudinal_slip: Annotated[Floats, Sequence[float64]] = DEFAULT


class WorldState(Message, typename="gazebo_msgs/msg/WorldState"):
    """WorldState, as gazebo_ros_pkgs defines it."""

    header: Header = DEFAULT
    name: Annotated[list[str], Sequence[str]] = DEFAULT
    pose: Annotated[list[Pose], Sequence[Pose]] = DEFAULT
    twist: Annotated[list[Twist], Sequence[Twist]] = DEFAULT
    wrench: Annotated[list[Wrench], Sequence[Wrench]] = DEFAULT
