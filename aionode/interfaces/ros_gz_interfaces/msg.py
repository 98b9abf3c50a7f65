"""Messages of ros_gz_interfaces.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.interfaces.geometry_msgs.msg import Pose, Vector3, Wrench
from aionode.interfaces.rcl_interfaces.msg import Parameter
from aionode.interfaces.std_msgs.msg import ColorRGBA, Header, String, UInt32
from aionode.message import (
    DEFAULT,
    Bytes,
    Floats,
    Message,
    Sequence,
    float32,
    float64,
    uint8,
    uint32,
    uint64,
)

__all__ = [
    "Altimeter",
    "Contact",
    "Contacts",
    "Dataframe",
    "Entity",
    "EntityFactory",
    "EntityWrench",
    "Float32Array",
    "GuiCamera",
    "JointWrench",
    "Light",
    "MaterialColor",
    "ParamVec",
    "SensorNoise",
    "StringVec",
    "TrackVisual",
    "VideoRecord",
    "WorldControl",
    "WorldReset",
]


class Altimeter(Message, typename="ros_gz_interfaces/msg/Altimeter"):
    """Altimeter, as ros_gz defines it."""

    header: Header = DEFAULT
    vertical_position: float64 = 0.0
    vertical_velocity: float64 = 0.0
    vertical_reference: float64 = 0.0


class Entity(Message, typename="ros_gz_interfaces/msg/Entity"):
    """Entity, as ros_gz defines it."""

    NONE: ClassVar[uint8] = 0
    LIGHT: ClassVar[uint8] = 1
    MODEL: ClassVar[uint8] = 2
    LINK: ClassVar[uint8] = 3
    VISUAL: ClassVar[uint8] = 4
    COLLISION: ClassVar[uint8] = 5
    SENSOR: ClassVar[uint8] = 6
    JOINT: ClassVar[uint8] = 7

    id: uint64 = 0
    name: str = ""
    type: uint8 = 0


class JointWrench(Message, typename="ros_gz_interfaces/msg/JointWrench"):
    """JointWrench, as ros_gz defines it."""

    header: Header = DEFAULT
    body_1_name: String = DEFAULT
    body_1_id: UInt32 = DEFAULT
    body_2_name: String = DEFAULT
    body_2_id: UInt32 = DEFAULT
    body_1_wrench: Wrench = DEFAULT
    body_2_wrench: Wrench = DEFAULT


class Contact(Message, typename="ros_gz_interfaces/msg/Contact"):
    """Contact, as ros_gz defines it."""

    collision1: Entity = DEFAULT
    collision2: Entity = DEFAULT
    positions: Annotated[list[Vector3], Sequence[Vector3]] = DEFAULT
    normals: Annotated[list[Vector3], Sequence[Vector3]] = DEFAULT
    depths: Annotated[Floats, Sequence[float64]] = DEFAULT
    wrenches: Annotated[list[JointWrench], Sequence[JointWrench]] = DEFAULT


class Contacts(Message, typename="ros_gz_interfaces/msg/Contacts"):
    """Contacts, as ros_gz defines it."""

    header: Header = DEFAULT
    contacts: Annotated[list[Contact], Sequence[Contact]] = DEFAULT


class Dataframe(Message, typename="ros_gz_interfaces/msg/Dataframe"):
    """Dataframe, as ros_gz defines it."""

    header: Header = DEFAULT
    src_address: str = ""
    dst_address: str = ""
    data: Annotated[Bytes, Sequence[uint8]] = DEFAULT
    rssi: float64 = 0.0


class EntityFactory(Message, typename="ros_gz_interfaces/msg/EntityFactory"):
    """EntityFactory, as ros_gz defines it."""

    name: str = ""
    allow_renaming: bool = False
    sdf: str = ""
    sdf_filename: str = ""
    clone_name: str = ""
    pose: Pose = DEFAULT
    relative_to: str = "world"


class EntityWrench(Message, typename="ros_gz_interfaces/msg/EntityWrench"):
    """EntityWrench, as ros_gz defines it."""

    header: Header = DEFAULT
    entity: Entity = DEFAULT
    wrench: Wrench = DEFAULT


class Float32Array(Message, typename="ros_gz_interfaces/msg/Float32Array"):
    """Float32Array, as ros_gz defines it."""

    data: Annotated[Floats, Sequence[float32]] = DEFAULT


class TrackVisual(Message, typename="ros_gz_interfaces/msg/TrackVisual"):
    """TrackVisual, as ros_gz defines it."""

    header: Header = DEFAULT
    name: str = ""
    id: uint32 = 0
    inherit_orientation: bool = False
    min_dist: float64 = 0.0
    max_dist: float64 = 0.0
    is_static: bool = False
    use_model_frame: bool = False
    xyz: Vector3 = DEFAULT
    inherit_yaw: bool = False


class GuiCamera(Message, typename="ros_gz_interfaces/msg/GuiCamera"):
    """GuiCamera, as ros_gz defines it."""

    header: Header = DEFAULT
    name: str = ""
    view_controller: str = ""
    pose: Pose = DEFAULT
    track: TrackVisual = DEFAULT
    projection_type: str = ""


class Light(Message, typename="ros_gz_interfaces/msg/Light"):
    """Light, as ros_gz defines it."""

    POINT: ClassVar[uint8] = 0
    SPOT: ClassVar[uint8] = 1
    DIRECTIONAL: ClassVar[uint8] = 2

    header: Header = DEFAULT
    name: str = ""
    type: uint8 = 0
    pose: Pose = DEFAULT
    diffuse: ColorRGBA = DEFAULT
    specular: ColorRGBA = DEFAULT
    attenuation_constant: float32 = 0.0
    attenuation_linear: float32 = 0.0
    attenuation_quadratic: float32 = 0.0
    direction: Vector3 = DEFAULT
    range: float32 = 0.0
    cast_shadows: bool = False
    spot_inner_angle: float32 = 0.0
    spot_outer_angle: float32 = 0.0
    spot_falloff: float32 = 0.0
    id: uint32 = 0
    parent_id: uint32 = 0
    intensity: float32 = 0.0


class MaterialColor(Message, typename="ros_gz_interfaces/msg/MaterialColor"):
    """MaterialColor, as ros_gz defines it."""

    FIRST: ClassVar[uint8] = 0
    ALL: ClassVar[uint8] = 1

    header: Header = DEFAULT
    entity: Entity = DEFAULT
    ambient: ColorRGBA = DEFAULT
    diffuse: ColorRGBA = DEFAULT
    specular: ColorRGBA = DEFAULT
    emissive: ColorRGBA = DEFAULT
    shininess: float64 = 0.0
    entity_match: uint8 = 0


class ParamVec(Message, typename="ros_gz_interfaces/msg/ParamVec"):
    """ParamVec, as ros_gz defines it."""

    header: Header = DEFAULT
    params: Annotated[list[Parameter], Sequence[Parameter]] = DEFAULT


class SensorNoise(Message, typename="ros_gz_interfaces/msg/SensorNoise"):
    """SensorNoise, as ros_gz defines it."""

    NONE: ClassVar[uint8] = 0
    GAUSSIAN: ClassVar[uint8] = 2
    GAUSSIAN_QUANTIZED: ClassVar[uint8] = 3

    header: Header = DEFAULT
    type: uint8 = 0
    mean: float64 = 0.0
    stddev: float64 = 0.0
    bias_mean: float64 = 0.0
    bias_stddev: float64 = 0.0
    precision: float64 = 0.0
    dynamic_bias_stddev: float64 = 0.0
    dynamic_bias_correlation_time: float64 = 0.0


class StringVec(Message, typename="ros_gz_interfaces/msg/StringVec"):
    """StringVec, as ros_gz defines it."""

    header: Header = DEFAULT
    data: Annotated[list[str], Sequence[str]] = DEFAULT


class VideoRecord(Message, typename="ros_gz_interfaces/msg/VideoRecord"):
    """VideoRecord, as ros_gz defines it."""

    header: Header = DEFAULT
    start: bool = False
    stop: bool = False
    format: str = ""
    save_filename: str = ""


class WorldReset(Message, typename="ros_gz_interfaces/msg/WorldReset"):
    """WorldReset, as ros_gz defines it."""

    all: bool = False
    time_only: bool = False
    model_only: bool = False


class WorldControl(Message, typename="ros_gz_interfaces/msg/WorldControl"):
    """WorldControl, as ros_gz defines it."""

    pause: bool = False
    step: bool = False
    multi_step: uint32 = 0
    reset: WorldReset = DEFAULT
    seed: uint32 = 0
    run_to_sim_time: Time = DEFAULT
