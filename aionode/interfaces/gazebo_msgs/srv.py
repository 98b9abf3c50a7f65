"""Services of gazebo_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.builtin_interfaces.msg import Duration, Time
from aionode.interfaces.gazebo_msgs.msg import (
    EntityState,
    LinkState,
    ModelState,
    ODEJointProperties,
    ODEPhysics,
)
from aionode.interfaces.geometry_msgs.msg import Point, Pose, Twist, Vector3, Wrench
from aionode.interfaces.std_msgs.msg import ColorRGBA, Header
from aionode.interfaces.trajectory_msgs.msg import JointTrajectory
from aionode.message import DEFAULT, Floats, Message, Sequence, ServiceType, float64, uint8

__all__ = [
    "ApplyBodyWrench",
    "ApplyJointEffort",
    "ApplyLinkWrench",
    "BodyRequest",
    "DeleteEntity",
    "DeleteLight",
    "DeleteModel",
    "GetEntityState",
    "GetJointProperties",
    "GetLightProperties",
    "GetLinkProperties",
    "GetLinkState",
    "GetModelList",
    "GetModelProperties",
    "GetModelState",
    "GetPhysicsProperties",
    "GetWorldProperties",
    "JointRequest",
    "LinkRequest",
    "SetEntityState",
    "SetJointProperties",
    "SetJointTrajectory",
    "SetLightProperties",
    "SetLinkProperties",
    "SetLinkState",
    "SetModelConfiguration",
    "SetModelState",
    "SetPhysicsProperties",
    "SpawnEntity",
    "SpawnModel",
]


class ApplyBodyWrench(ServiceType, typename="gazebo_msgs/srv/ApplyBodyWrench"):
    """ApplyBodyWrench, as gazebo_ros_pkgs defines it."""

    class Request(Message):
        """The request of ApplyBodyWrench."""

        body_name: str = ""
        reference_frame: str = ""
        reference_point: Point = DEFAULT
        wrench: Wrench = DEFAULT
        start_time: Time = DEFAULT
        duration: Duration = DEFAULT

    class Response(Message):
        """The response of ApplyBodyWrench."""

        success: bool = False
        status_message: str = ""


class ApplyJointEffort(ServiceType, typename="gazebo_msgs/srv/ApplyJointEffort"):
    """ApplyJointEffort, as gazebo_ros_pkgs defines it."""

    class Request(Message):
        """The request of ApplyJointEffort."""

        joint_name: str = ""
        effort: float64 = 0.0
        start_time: Time = DEFAULT
        duration: Duration = DEFAULT

    class Response(Message):
        """The response of ApplyJointEffort."""

        success: bool = False
        status_message: str = ""


class ApplyLinkWrench(ServiceType, typename="gazebo_msgs/srv/ApplyLinkWrench"):
    """ApplyLinkWrench, as gazebo_ros_pkgs defines it."""

    class Request(Message):
        """The request of ApplyLinkWrench."""

        link_name: str = ""
        reference_frame: str = ""
        reference_point: Point = DEFAULT
        wrench: Wrench = DEFAULT
        start_time: Time = DEFAULT
        duration: Duration = DEFAULT

    class Response(Message):
        """The response of ApplyLinkWrench."""

        success: bool = False
        status_message: str = ""


class BodyRequest(ServiceType, typename="gazebo_msgs/srv/BodyRequest"):
    """BodyRequest, as gazebo_ros_pkgs defines it."""

    class Request(Message):
        """The request of BodyRequest."""

        body_name: str = ""

    class Response(Message):
        """The response of BodyRequest."""


class DeleteEntity(ServiceType, typename="gazebo_msgs/srv/DeleteEntity"):
    """DeleteEntity, as gazebo_ros_pkgs defines it."""

    class Request(Message):
        """The request of DeleteEntity."""

        name: str = ""

    class Response(Message):
        """The response of DeleteEntity."""

        success: bool = False
        status_message: str = ""


class DeleteLight(ServiceType, typename="gazebo_msgs/srv/DeleteLight"):
    """DeleteLight, as gazebo_ros_pkgs defines it."""

    class Request(Message):
        """The request of DeleteLight."""

        light_name: str = ""

    class Response(Message):
        """The response of DeleteLight."""

        success: bool = False
        status_message: str = ""


class DeleteModel(ServiceType, typename="gazebo_msgs/srv/DeleteModel"):
    """DeleteModel, as gazebo_ros_pkgs defines it."""

    class Request(Message):
        """The request of DeleteModel."""

        model_name: str = ""

    class Response(Message):
        """The response of DeleteModel."""

        success: bool = False
        status_message: str = ""


class GetEntityState(ServiceType, typename="gazebo_msgs/srv/GetEntityState"):
    """GetEntityState, as gazebo_ros_pkgs defines it."""

    class Request(Message):
        """The request of GetEntityState."""

        name: str = ""
        reference_frame: str = ""

    class Response(Message):
        """The response of GetEntityState."""

        header: Header = DEFAULT
        state: EntityState = DEFAULT
        success: bool = False


class GetJointProperties(ServiceType, typename="gazebo_msgs/srv/GetJointProperties"):
    """GetJointProperties, as gazebo_ros_pkgs defines it."""

    class Request(Message):
        """The request of GetJointProperties."""

        joint_name: str = ""

    class Response(Message):
        """The response of GetJointProperties."""

        REVOLUTE: ClassVar[uint8] = 0
        CONTINUOUS: ClassVar[uint8] = 1
        PRISMATIC: ClassVar[uint8] = 2
        FIXED: ClassVar[uint8] = 3
        BALL: ClassVar[uint8] = 4
        UNIVERSAL: ClassVar[uint8] = 5

        type: uint8 = 0
        damping: Annotated[Floats, Sequence[float64]] = DEFAULT
        position: Annotated[Floats, Sequence[float64]] = DEFAULT
        rate: Annotated[Floats, Sequence[float64]] = DEFAULT
        success: bool = False
        status_message: str = ""


class GetLightProperties(ServiceType, typename="gazebo_msgs/srv/GetLightProperties"):
    """GetLightProperties, as gazebo_ros_pkgs defines it."""

    class Request(Message):
        """The request of GetLightProperties."""

        light_name: str = ""

    class Response(Message):
        """The response of GetLightProperties."""

        diffuse: ColorRGBA = DEFAULT
        attenuation_constant: float64 = 0.0
        attenuation_linear: float64 = 0.0
        attenuation_quadratic: float64 = 0.0
        success: bool = False
        status_message: str = ""


class GetLinkProperties(ServiceType, typename="gazebo_msgs/srv/GetLinkProperties"):
    """GetLinkProperties, as gazebo_ros_pkgs defines it."""

    class Request(Message):
        """The request of GetLinkProperties."""

        link_name: str = ""

    class Response(Message):
        """The response of GetLinkProperties."""

        com: Pose = DEFAULT
        gravity_mode: bool = False
        mass: float64 = 0.0
        ixx: float64 = 0.0
        ixy: float64 = 0.0
        ixz: float64 = 0.0
        iyy: float64 = 0.0
        iyz: float64 = 0.0
        izz: float64 = 0.0
        success: bool = False
        status_message: str = ""


class GetLinkState(ServiceType, typename="gazebo_msgs/srv/GetLinkState"):
    """GetLinkState, as gazebo_ros_pkgs defines it."""

    class Request(Message):
        """The request of GetLinkState."""

        link_name: str = ""
        reference_frame: str = ""

    class Response(Message):
        """The response of GetLinkState."""

        link_state: LinkState = DEFAULT
        success: bool = False
        status_message: str = ""


class GetModelList(ServiceType, typename="gazebo_msgs/srv/GetModelList"):
    """GetModelList, as gazebo_ros_pkgs defines it."""

    class Request(Message):
        """The request of GetModelList."""

    class Response(Message):
        """The response of GetModelList."""

        header: Header = DEFAULT
        model_names: Annotated[list[str], Sequence[str]] = DEFAULT
        success: bool = False


class GetModelProperties(ServiceType, typename="gazebo_msgs/srv/GetModelProperties"):
    """GetModelProperties, as gazebo_ros_pkgs defines it."""

    class Request(Message):
        """The request of GetModelProperties."""

        model_name: str = ""

    class Response(Message):
        """The response of GetModelProperties."""

        parent_model_name: str = ""
        canonical_body_name: str = ""
        body_names: Annotated[list[str], Sequence[str]] = DEFAULT
        geom_names: Annotated[list[str], Sequence[str]] = DEFAULT
        joint_names: Annotated[list[str], Sequence[str]] = DEFAULT
        child_model_names: Annotated[list[str], Sequence[str]] = DEFAULT
        is_static: bool = False
        success: bool = False
        status_message: str = ""


class GetModelState(ServiceType, typename="gazebo_msgs/srv/GetModelState"):
    """GetModelState, as gazebo_ros_pkgs defines it."""

    class Request(Message):
        """The request of GetModelState."""

        model_name: str = ""
        relative_entity_name: str = ""

    class Response(Message):
        """The response of GetModelState."""

        header: Header = DEFAULT
        pose: Pose = DEFAULT
        twist: Twist = DEFAULT
        success: bool = False
        status_message: str = ""


class GetPhysicsProperties(ServiceType, typename="gazebo_msgs/srv/GetPhysicsProperties"):
    """GetPhysicsProperties, as gazebo_ros_pkgs defines it."""

    class Request(Message):
        """The request of GetPhysicsProperties."""

    class Response(Message):
        """The response of GetPhysicsProperties."""

        time_step: float64 = 0.0
        pause: bool = False
        max_update_rate: float64 = 0.0
        gravity: Vector3 = DEFAULT
        ode_config: ODEPhysics = DEFAULT
        success: bool = False
        status_message: str = ""


class GetWorldProperties(ServiceType, typename="gazebo_msgs/srv/GetWorldProperties"):
    """GetWorldProperties, as gazebo_ros_pkgs defines it."""

    class Request(Message):
        """The request of GetWorldProperties."""

    class Response(Message):
        """The response of GetWorldProperties."""

        sim_time: float64 = 0.0
        model_names: Annotated[list[str], Sequence[str]] = DEFAULT
        rendering_enabled: bool = False
        success: bool = False
        status_message: str = ""


class JointRequest(ServiceType, typename="gazebo_msgs/srv/JointRequest"):
    """JointRequest, as gazebo_ros_pkgs defines it."""

    class Request(Message):
        """The request of JointRequest."""

        joint_name: str = ""

    class Response(Message):
        """The response of JointRequest."""


class LinkRequest(ServiceType, typename="gazebo_msgs/srv/LinkRequest"):
    """LinkRequest, as gazebo_ros_pkgs defines it."""

    class Request(Message):
        """The request of LinkRequest."""

        link_name: str = ""

    class Response(Message):
        """The response of LinkRequest."""


class SetEntityState(ServiceType, typename="gazebo_msgs/srv/SetEntityState"):
    """SetEntityState, as gazebo_ros_pkgs defines it."""

    class Request(Message):
        """The request of SetEntityState."""

        state: EntityState = DEFAULT

    class Response(Message):
        """The response of SetEntityState."""

        success: bool = False


class SetJointProperties(ServiceType, typename="gazebo_msgs/srv/SetJointProperties"):
    """SetJointProperties, as gazebo_ros_pkgs defines it."""

    class Request(Message):
        """The request of SetJointProperties."""

        joint_name: str = ""
        ode_joint_config: ODEJointProperties = DEFAULT

    class Response(Message):
        """The response of SetJointProperties."""

        success: bool = False
        status_message: str = ""


class SetJointTrajectory(ServiceType, typename="gazebo_msgs/srv/SetJointTrajectory"):
    """SetJointTrajectory, as gazebo_ros_pkgs defines it."""

    class Request(Message):
        """The request of SetJointTrajectory."""

        model_name: str = ""
        joint_trajectory: JointTrajectory = DEFAULT
        model_pose: Pose = DEFAULT
        set_model_pose: bool = False
        disable_physics_updates: bool = False

    class Response(Message):
        """The response of SetJointTrajectory."""

        success: bool = False
        status_message: str = ""


class SetLightProperties(ServiceType, typename="gazebo_msgs/srv/SetLightProperties"):
    """SetLightProperties, as gazebo_ros_pkgs defines it."""

    class Request(Message):
        """The request of SetLightProperties."""

        light_name: str = ""
        diffuse: ColorRGBA = DEFAULT
        attenuation_constant: float64 = 0.0
        attenuation_linear: float64 = 0.0
        attenuation_quadratic: float64 = 0.0

    class Response(Message):
        """The response of SetLightProperties."""

        success: bool = False
        status_message: str = ""


class SetLinkProperties(ServiceType, typename="gazebo_msgs/srv/SetLinkProperties"):
    """SetLinkProperties, as gazebo_ros_pkgs defines it."""

    class Request(Message):
        """The request of SetLinkProperties."""

        link_name: str = ""
        com: Pose = DEFAULT
        gravity_mode: bool = False
        mass: float64 = 0.0
        ixx: float64 = 0.0
        ixy: float64 = 0.0
        ixz: float64 = 0.0
        iyy: float64 = 0.0
        iyz: float64 = 0.0
        izz: float64 = 0.0

    class Response(Message):
        """The response of SetLinkProperties."""

        success: bool = False
        status_message: str = ""


class SetLinkState(ServiceType, typename="gazebo_msgs/srv/SetLinkState"):
    """SetLinkState, as gazebo_ros_pkgs defines it."""

    class Request(Message):
        """The request of SetLinkState."""

        link_state: LinkState = DEFAULT

    class Response(Message):
        """The response of SetLinkState."""

        success: bool = False
        status_message: str = ""


class SetModelConfiguration(ServiceType, typename="gazebo_msgs/srv/SetModelConfiguration"):
    """SetModelConfiguration, as gazebo_ros_pkgs defines it."""

    class Request(Message):
        """The request of SetModelConfiguration."""

        model_name: str = ""
        urdf_param_name: str = ""
        joint_names: Annotated[list[str], Sequence[str]] = DEFAULT
        joint_positions: Annotated[Floats, Sequence[float64]] = DEFAULT

    class Response(Message):
        """The response of SetModelConfiguration."""

        success: bool = False
        status_message: str = ""


class SetModelState(ServiceType, typename="gazebo_msgs/srv/SetModelState"):
    """SetModelState, as gazebo_ros_pkgs defines it."""

    class Request(Message):
        """The request of SetModelState."""

        model_state: ModelState = DEFAULT

    class Response(Message):
        """The response of SetModelState."""

        success: bool = False
        status_message: str = ""


class SetPhysicsProperties(ServiceType, typename="gazebo_msgs/srv/SetPhysicsProperties"):
    """SetPhysicsProperties, as gazebo_ros_pkgs defines it."""

    class Request(Message):
        """The request of SetPhysicsProperties."""

        time_step: float64 = 0.0
        max_update_rate: float64 = 0.0
        gravity: Vector3 = DEFAULT
        ode_config: ODEPhysics = DEFAULT

    class Response(Message):
        """The response of SetPhysicsProperties."""

        success: bool = False
        status_message: str = ""


class SpawnEntity(ServiceType, typename="gazebo_msgs/srv/SpawnEntity"):
    """SpawnEntity, as gazebo_ros_pkgs defines it."""

    class Request(Message):
        """The request of SpawnEntity."""

        name: str = ""
        xml: str = ""
        robot_namespace: str = ""
        initial_pose: Pose = DEFAULT
        reference_frame: str = ""

    class Response(Message):
        """The response of SpawnEntity."""

        success: bool = False
        status_message: str = ""


class SpawnModel(ServiceType, typename="gazebo_msgs/srv/SpawnModel"):
    """SpawnModel, as gazebo_ros_pkgs defines it."""

    class Request(Message):
        """The request of SpawnModel."""

        model_name: str = ""
        model_xml: str = ""
        robot_namespace: str = ""
        initial_pose: Pose = DEFAULT
        reference_frame: str = ""

    class Response(Message):
        """The response of SpawnModel."""

        success: bool = False
        status_message: str = ""
