"""Messages of visualization_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.builtin_interfaces.msg import Duration
from aionode.interfaces.geometry_msgs.msg import Point, Pose, Quaternion, Vector3
from aionode.interfaces.sensor_msgs.msg import CompressedImage
from aionode.interfaces.std_msgs.msg import ColorRGBA, Header
from aionode.message import DEFAULT, Bytes, Message, Sequence, float32, int32, uint8, uint32, uint64

__all__ = [
    "ImageMarker",
    "InteractiveMarker",
    "InteractiveMarkerControl",
    "InteractiveMarkerFeedback",
    "InteractiveMarkerInit",
    "InteractiveMarkerPose",
    "InteractiveMarkerUpdate",
    "Marker",
    "MarkerArray",
    "MenuEntry",
    "MeshFile",
    "UVCoordinate",
]


class ImageMarker(Message, typename="visualization_msgs/msg/ImageMarker"):
    """Something to draw on an image: `type` and `action` are constants, lengths are in pixels."""

    CIRCLE: ClassVar[int32] = 0
    LINE_STRIP: ClassVar[int32] = 1
    LINE_LIST: ClassVar[int32] = 2
    POLYGON: ClassVar[int32] = 3
    POINTS: ClassVar[int32] = 4
    ADD: ClassVar[int32] = 0
    REMOVE: ClassVar[int32] = 1

    header: Header = DEFAULT
    ns: str = ""
    id: int32 = 0
    type: int32 = 0
    action: int32 = 0
    position: Point = DEFAULT
    scale: float32 = 0.0
    outline_color: ColorRGBA = DEFAULT
    filled: uint8 = 0
    fill_color: ColorRGBA = DEFAULT
    lifetime: Duration = DEFAULT
    points: Annotated[list[Point], Sequence[Point]] = DEFAULT
    outline_colors: Annotated[list[ColorRGBA], Sequence[ColorRGBA]] = DEFAULT


class MenuEntry(Message, typename="visualization_msgs/msg/MenuEntry"):
    """An entry of an interactive marker's menu; `parent_id` of 0 puts it at the top."""

    FEEDBACK: ClassVar[uint8] = 0
    ROSRUN: ClassVar[uint8] = 1
    ROSLAUNCH: ClassVar[uint8] = 2

    id: uint32 = 0
    parent_id: uint32 = 0
    title: str = ""
    command: str = ""
    command_type: uint8 = 0


class UVCoordinate(Message, typename="visualization_msgs/msg/UVCoordinate"):
    """A place on a texture, from 0 to 1."""

    u: float32 = 0.0
    v: float32 = 0.0


class MeshFile(Message, typename="visualization_msgs/msg/MeshFile"):
    """A mesh: name and bytes of its file."""

    filename: str = ""
    data: Annotated[Bytes, Sequence[uint8]] = DEFAULT


class Marker(Message, typename="visualization_msgs/msg/Marker"):
    """Something to draw in a 3D view.

    Attributes:
        header: Time, and the frame of `pose`.
        ns: With `id` it distinguishes this marker from others.
        id: A marker with the same `ns` and `id` replaces it.
        type: What to draw, one of the constants.
        action: Draw it, or remove it or all: one of the constants.
        pose: Where it is, in m.
        scale: Its size along its axes, in m; meaning depends on `type`.
        color: With opacity; an `a` of 0 is invisible.
        lifetime: How long to show it; 0 means forever.
        frame_locked: Whether it moves along with its frame.
        points: For lines, lists and triangles, in m.
        colors: One for each of `points`, or none.
        texture_resource: Where its texture is, or its name in `texture`.
        texture: An image for its surface.
        uv_coordinates: Where on the texture each of `points` is.
        text: For text.
        mesh_resource: Where its mesh is, such as ``package://…``.
        mesh_file: The mesh itself.
        mesh_use_embedded_materials: Whether the mesh brings its colors.
    """

    ARROW: ClassVar[int32] = 0
    CUBE: ClassVar[int32] = 1
    SPHERE: ClassVar[int32] = 2
    CYLINDER: ClassVar[int32] = 3
    LINE_STRIP: ClassVar[int32] = 4
    LINE_LIST: ClassVar[int32] = 5
    CUBE_LIST: ClassVar[int32] = 6
    SPHERE_LIST: ClassVar[int32] = 7
    POINTS: ClassVar[int32] = 8
    TEXT_VIEW_FACING: ClassVar[int32] = 9
    MESH_RESOURCE: ClassVar[int32] = 10
    TRIANGLE_LIST: ClassVar[int32] = 11
    ARROW_STRIP: ClassVar[int32] = 12
    ADD: ClassVar[int32] = 0
    MODIFY: ClassVar[int32] = 0
    DELETE: ClassVar[int32] = 2
    DELETEALL: ClassVar[int32] = 3

    header: Header = DEFAULT
    ns: str = ""
    id: int32 = 0
    type: int32 = 0
    action: int32 = 0
    pose: Pose = DEFAULT
    scale: Vector3 = DEFAULT
    color: ColorRGBA = DEFAULT
    lifetime: Duration = DEFAULT
    frame_locked: bool = False
    points: Annotated[list[Point], Sequence[Point]] = DEFAULT
    colors: Annotated[list[ColorRGBA], Sequence[ColorRGBA]] = DEFAULT
    texture_resource: str = ""
    texture: CompressedImage = DEFAULT
    uv_coordinates: Annotated[list[UVCoordinate], Sequence[UVCoordinate]] = DEFAULT
    text: str = ""
    mesh_resource: str = ""
    mesh_file: MeshFile = DEFAULT
    mesh_use_embedded_materials: bool = False


class InteractiveMarkerControl(Message, typename="visualization_msgs/msg/InteractiveMarkerControl"):
    """How a user can take hold of an interactive marker, and what that does."""

    INHERIT: ClassVar[uint8] = 0
    FIXED: ClassVar[uint8] = 1
    VIEW_FACING: ClassVar[uint8] = 2
    NONE: ClassVar[uint8] = 0
    MENU: ClassVar[uint8] = 1
    BUTTON: ClassVar[uint8] = 2
    MOVE_AXIS: ClassVar[uint8] = 3
    MOVE_PLANE: ClassVar[uint8] = 4
    ROTATE_AXIS: ClassVar[uint8] = 5
    MOVE_ROTATE: ClassVar[uint8] = 6
    MOVE_3D: ClassVar[uint8] = 7
    ROTATE_3D: ClassVar[uint8] = 8
    MOVE_ROTATE_3D: ClassVar[uint8] = 9

    name: str = ""
    orientation: Quaternion = DEFAULT
    orientation_mode: uint8 = 0
    interaction_mode: uint8 = 0
    always_visible: bool = False
    markers: Annotated[list[Marker], Sequence[Marker]] = DEFAULT
    independent_marker_orientation: bool = False
    description: str = ""


class InteractiveMarker(Message, typename="visualization_msgs/msg/InteractiveMarker"):
    """A thing in a 3D view that a user can move and click; `scale` in m."""

    header: Header = DEFAULT
    pose: Pose = DEFAULT
    name: str = ""
    description: str = ""
    scale: float32 = 0.0
    menu_entries: Annotated[list[MenuEntry], Sequence[MenuEntry]] = DEFAULT
    controls: Annotated[list[InteractiveMarkerControl], Sequence[InteractiveMarkerControl]] = (
        DEFAULT
    )


class InteractiveMarkerFeedback(
    Message, typename="visualization_msgs/msg/InteractiveMarkerFeedback"
):
    """What a user did with an interactive marker."""

    KEEP_ALIVE: ClassVar[uint8] = 0
    POSE_UPDATE: ClassVar[uint8] = 1
    MENU_SELECT: ClassVar[uint8] = 2
    BUTTON_CLICK: ClassVar[uint8] = 3
    MOUSE_DOWN: ClassVar[uint8] = 4
    MOUSE_UP: ClassVar[uint8] = 5

    header: Header = DEFAULT
    client_id: str = ""
    marker_name: str = ""
    control_name: str = ""
    event_type: uint8 = 0
    pose: Pose = DEFAULT
    menu_entry_id: uint32 = 0
    mouse_point: Point = DEFAULT
    mouse_point_valid: bool = False


class InteractiveMarkerInit(Message, typename="visualization_msgs/msg/InteractiveMarkerInit"):
    """All interactive markers of a server, for viewers that join later."""

    server_id: str = ""
    seq_num: uint64 = 0
    markers: Annotated[list[InteractiveMarker], Sequence[InteractiveMarker]] = DEFAULT


class InteractiveMarkerPose(Message, typename="visualization_msgs/msg/InteractiveMarkerPose"):
    """Where an interactive marker is now."""

    header: Header = DEFAULT
    pose: Pose = DEFAULT
    name: str = ""


class InteractiveMarkerUpdate(Message, typename="visualization_msgs/msg/InteractiveMarkerUpdate"):
    """Which interactive markers of a server are new, moved or gone."""

    KEEP_ALIVE: ClassVar[uint8] = 0
    UPDATE: ClassVar[uint8] = 1

    server_id: str = ""
    seq_num: uint64 = 0
    type: uint8 = 0
    markers: Annotated[list[InteractiveMarker], Sequence[InteractiveMarker]] = DEFAULT
    poses: Annotated[list[InteractiveMarkerPose], Sequence[InteractiveMarkerPose]] = DEFAULT
    erases: Annotated[list[str], Sequence[str]] = DEFAULT


class MarkerArray(Message, typename="visualization_msgs/msg/MarkerArray"):
    """Several things to draw in a 3D view."""

    markers: Annotated[list[Marker], Sequence[Marker]] = DEFAULT
