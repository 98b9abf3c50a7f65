"""Services of mavros_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from builtins import list as list_
from typing import Annotated, ClassVar

from aionode.interfaces.geometry_msgs.msg import Vector3
from aionode.interfaces.mavros_msgs.msg import FileEntry, ParamValue, VehicleInfo, Waypoint
from aionode.interfaces.rcl_interfaces.msg import ParameterValue
from aionode.interfaces.std_msgs.msg import Header
from aionode.message import (
    DEFAULT,
    Bytes,
    Message,
    Sequence,
    ServiceType,
    float32,
    int16,
    int32,
    uint8,
    uint16,
    uint32,
    uint64,
)

__all__ = [
    "CommandAck",
    "CommandBool",
    "CommandHome",
    "CommandInt",
    "CommandLong",
    "CommandTOL",
    "CommandTOLLocal",
    "CommandTriggerControl",
    "CommandTriggerInterval",
    "CommandVtolTransition",
    "EndpointAdd",
    "EndpointDel",
    "FileChecksum",
    "FileClose",
    "FileList",
    "FileMakeDir",
    "FileOpen",
    "FileRead",
    "FileRemove",
    "FileRemoveDir",
    "FileRename",
    "FileTruncate",
    "FileWrite",
    "GimbalGetInformation",
    "GimbalManagerCameraTrack",
    "GimbalManagerConfigure",
    "GimbalManagerPitchyaw",
    "GimbalManagerSetRoi",
    "LogRequestData",
    "LogRequestEnd",
    "LogRequestList",
    "MessageInterval",
    "MountConfigure",
    "ParamGet",
    "ParamPull",
    "ParamPush",
    "ParamSet",
    "ParamSetV2",
    "SetMavFrame",
    "SetMode",
    "StreamRate",
    "VehicleInfoGet",
    "WaypointClear",
    "WaypointPull",
    "WaypointPush",
    "WaypointSetCurrent",
]


class CommandAck(ServiceType, typename="mavros_msgs/srv/CommandAck"):
    """CommandAck, as MAVROS defines it."""

    class Request(Message):
        """The request of CommandAck."""

        command: uint16 = 0
        result: uint8 = 0
        progress: uint8 = 0
        result_param2: uint32 = 0

    class Response(Message):
        """The response of CommandAck."""

        success: bool = False
        result: uint8 = 0


class CommandBool(ServiceType, typename="mavros_msgs/srv/CommandBool"):
    """CommandBool, as MAVROS defines it."""

    class Request(Message):
        """The request of CommandBool."""

        value: bool = False

    class Response(Message):
        """The response of CommandBool."""

        success: bool = False
        result: uint8 = 0


class CommandHome(ServiceType, typename="mavros_msgs/srv/CommandHome"):
    """CommandHome, as MAVROS defines it."""

    class Request(Message):
        """The request of CommandHome."""

        current_gps: bool = False
        yaw: float32 = 0.0
        latitude: float32 = 0.0
        longitude: float32 = 0.0
        altitude: float32 = 0.0

    class Response(Message):
        """The response of CommandHome."""

        success: bool = False
        result: uint8 = 0


class CommandInt(ServiceType, typename="mavros_msgs/srv/CommandInt"):
    """CommandInt, as MAVROS defines it."""

    class Request(Message):
        """The request of CommandInt."""

        broadcast: bool = False
        frame: uint8 = 0
        command: uint16 = 0
        current: uint8 = 0
        autocontinue: uint8 = 0
        param1: float32 = 0.0
        param2: float32 = 0.0
        param3: float32 = 0.0
        param4: float32 = 0.0
        x: int32 = 0
        y: int32 = 0
        z: float32 = 0.0

    class Response(Message):
        """The response of CommandInt."""

        success: bool = False


class CommandLong(ServiceType, typename="mavros_msgs/srv/CommandLong"):
    """CommandLong, as MAVROS defines it."""

    class Request(Message):
        """The request of CommandLong."""

        broadcast: bool = False
        command: uint16 = 0
        confirmation: uint8 = 0
        param1: float32 = 0.0
        param2: float32 = 0.0
        param3: float32 = 0.0
        param4: float32 = 0.0
        param5: float32 = 0.0
        param6: float32 = 0.0
        param7: float32 = 0.0

    class Response(Message):
        """The response of CommandLong."""

        success: bool = False
        result: uint8 = 0


class CommandTOL(ServiceType, typename="mavros_msgs/srv/CommandTOL"):
    """CommandTOL, as MAVROS defines it."""

    class Request(Message):
        """The request of CommandTOL."""

        min_pitch: float32 = 0.0
        yaw: float32 = 0.0
        latitude: float32 = 0.0
        longitude: float32 = 0.0
        altitude: float32 = 0.0

    class Response(Message):
        """The response of CommandTOL."""

        success: bool = False
        result: uint8 = 0


class CommandTOLLocal(ServiceType, typename="mavros_msgs/srv/CommandTOLLocal"):
    """CommandTOLLocal, as MAVROS defines it."""

    class Request(Message):
        """The request of CommandTOLLocal."""

        min_pitch: float32 = 0.0
        offset: float32 = 0.0
        rate: float32 = 0.0
        yaw: float32 = 0.0
        position: Vector3 = DEFAULT

    class Response(Message):
        """The response of CommandTOLLocal."""

        success: bool = False
        result: uint8 = 0


class CommandTriggerControl(ServiceType, typename="mavros_msgs/srv/CommandTriggerControl"):
    """CommandTriggerControl, as MAVROS defines it."""

    class Request(Message):
        """The request of CommandTriggerControl."""

        trigger_enable: bool = False
        sequence_reset: bool = False
        trigger_pause: bool = False

    class Response(Message):
        """The response of CommandTriggerControl."""

        success: bool = False
        result: uint8 = 0


class CommandTriggerInterval(ServiceType, typename="mavros_msgs/srv/CommandTriggerInterval"):
    """CommandTriggerInterval, as MAVROS defines it."""

    class Request(Message):
        """The request of CommandTriggerInterval."""

        cycle_time: float32 = 0.0
        integration_time: float32 = 0.0

    class Response(Message):
        """The response of CommandTriggerInterval."""

        success: bool = False
        result: uint8 = 0


class CommandVtolTransition(ServiceType, typename="mavros_msgs/srv/CommandVtolTransition"):
    """CommandVtolTransition, as MAVROS defines it."""

    class Request(Message):
        """The request of CommandVtolTransition."""

        STATE_MC: ClassVar[uint8] = 3
        STATE_FW: ClassVar[uint8] = 4

        header: Header = DEFAULT
        state: uint8 = 0

    class Response(Message):
        """The response of CommandVtolTransition."""

        success: bool = False
        result: uint8 = 0


class EndpointAdd(ServiceType, typename="mavros_msgs/srv/EndpointAdd"):
    """EndpointAdd, as MAVROS defines it."""

    class Request(Message):
        """The request of EndpointAdd."""

        TYPE_FCU: ClassVar[uint8] = 0
        TYPE_GCS: ClassVar[uint8] = 1
        TYPE_UAS: ClassVar[uint8] = 2

        url: str = ""
        type: uint8 = 0

    class Response(Message):
        """The response of EndpointAdd."""

        successful: bool = False
        reason: str = ""
        id: uint32 = 0


class EndpointDel(ServiceType, typename="mavros_msgs/srv/EndpointDel"):
    """EndpointDel, as MAVROS defines it."""

    class Request(Message):
        """The request of EndpointDel."""

        TYPE_FCU: ClassVar[uint8] = 0
        TYPE_GCS: ClassVar[uint8] = 1
        TYPE_UAS: ClassVar[uint8] = 2

        id: uint32 = 0
        url: str = ""
        type: uint8 = 0

    class Response(Message):
        """The response of EndpointDel."""

        successful: bool = False


class FileChecksum(ServiceType, typename="mavros_msgs/srv/FileChecksum"):
    """FileChecksum, as MAVROS defines it."""

    class Request(Message):
        """The request of FileChecksum."""

        file_path: str = ""

    class Response(Message):
        """The response of FileChecksum."""

        crc32: uint32 = 0
        success: bool = False
        r_errno: int32 = 0


class FileClose(ServiceType, typename="mavros_msgs/srv/FileClose"):
    """FileClose, as MAVROS defines it."""

    class Request(Message):
        """The request of FileClose."""

        file_path: str = ""

    class Response(Message):
        """The response of FileClose."""

        success: bool = False
        r_errno: int32 = 0


class FileList(ServiceType, typename="mavros_msgs/srv/FileList"):
    """FileList, as MAVROS defines it."""

    class Request(Message):
        """The request of FileList."""

        dir_path: str = ""

    class Response(Message):
        """The response of FileList."""

        list: Annotated[list_[FileEntry], Sequence[FileEntry]] = DEFAULT
        success: bool = False
        r_errno: int32 = 0


class FileMakeDir(ServiceType, typename="mavros_msgs/srv/FileMakeDir"):
    """FileMakeDir, as MAVROS defines it."""

    class Request(Message):
        """The request of FileMakeDir."""

        dir_path: str = ""

    class Response(Message):
        """The response of FileMakeDir."""

        success: bool = False
        r_errno: int32 = 0


class FileOpen(ServiceType, typename="mavros_msgs/srv/FileOpen"):
    """FileOpen, as MAVROS defines it."""

    class Request(Message):
        """The request of FileOpen."""

        MODE_READ: ClassVar[uint8] = 0
        MODE_WRITE: ClassVar[uint8] = 1
        MODE_CREATE: ClassVar[uint8] = 2

        file_path: str = ""
        mode: uint8 = 0

    class Response(Message):
        """The response of FileOpen."""

        size: uint32 = 0
        success: bool = False
        r_errno: int32 = 0


class FileRead(ServiceType, typename="mavros_msgs/srv/FileRead"):
    """FileRead, as MAVROS defines it."""

    class Request(Message):
        """The request of FileRead."""

        file_path: str = ""
        offset: uint64 = 0
        size: uint64 = 0

    class Response(Message):
        """The response of FileRead."""

        data: Annotated[Bytes, Sequence[uint8]] = DEFAULT
        success: bool = False
        r_errno: int32 = 0


class FileRemove(ServiceType, typename="mavros_msgs/srv/FileRemove"):
    """FileRemove, as MAVROS defines it."""

    class Request(Message):
        """The request of FileRemove."""

        file_path: str = ""

    class Response(Message):
        """The response of FileRemove."""

        success: bool = False
        r_errno: int32 = 0


class FileRemoveDir(ServiceType, typename="mavros_msgs/srv/FileRemoveDir"):
    """FileRemoveDir, as MAVROS defines it."""

    class Request(Message):
        """The request of FileRemoveDir."""

        dir_path: str = ""

    class Response(Message):
        """The response of FileRemoveDir."""

        success: bool = False
        r_errno: int32 = 0


class FileRename(ServiceType, typename="mavros_msgs/srv/FileRename"):
    """FileRename, as MAVROS defines it."""

    class Request(Message):
        """The request of FileRename."""

        old_path: str = ""
        new_path: str = ""

    class Response(Message):
        """The response of FileRename."""

        success: bool = False
        r_errno: int32 = 0


class FileTruncate(ServiceType, typename="mavros_msgs/srv/FileTruncate"):
    """FileTruncate, as MAVROS defines it."""

    class Request(Message):
        """The request of FileTruncate."""

        file_path: str = ""
        length: uint64 = 0

    class Response(Message):
        """The response of FileTruncate."""

        success: bool = False
        r_errno: int32 = 0


class FileWrite(ServiceType, typename="mavros_msgs/srv/FileWrite"):
    """FileWrite, as MAVROS defines it."""

    class Request(Message):
        """The request of FileWrite."""

        file_path: str = ""
        offset: uint64 = 0
        data: Annotated[Bytes, Sequence[uint8]] = DEFAULT

    class Response(Message):
        """The response of FileWrite."""

        success: bool = False
        r_errno: int32 = 0


class GimbalGetInformation(ServiceType, typename="mavros_msgs/srv/GimbalGetInformation"):
    """GimbalGetInformation, as MAVROS defines it."""

    class Request(Message):
        """The request of GimbalGetInformation."""

    class Response(Message):
        """The response of GimbalGetInformation."""

        success: bool = False
        result: uint8 = 0


class GimbalManagerCameraTrack(ServiceType, typename="mavros_msgs/srv/GimbalManagerCameraTrack"):
    """GimbalManagerCameraTrack, as MAVROS defines it."""

    class Request(Message):
        """The request of GimbalManagerCameraTrack."""

        CAMERA_TRACK_MODE_POINT: ClassVar[uint8] = 0
        CAMERA_TRACK_MODE_RECTANGLE: ClassVar[uint8] = 1
        CAMERA_TRACK_MODE_STOP_TRACKING: ClassVar[uint8] = 2

        mode: uint8 = 0
        x: float32 = 0.0
        y: float32 = 0.0
        radius: float32 = 0.0
        top_left_x: float32 = 0.0
        top_left_y: float32 = 0.0
        bottom_right_x: float32 = 0.0
        bottom_right_y: float32 = 0.0

    class Response(Message):
        """The response of GimbalManagerCameraTrack."""

        success: bool = False
        result: uint8 = 0


class GimbalManagerConfigure(ServiceType, typename="mavros_msgs/srv/GimbalManagerConfigure"):
    """GimbalManagerConfigure, as MAVROS defines it."""

    class Request(Message):
        """The request of GimbalManagerConfigure."""

        sysid_primary: int16 = 0
        compid_primary: int16 = 0
        sysid_secondary: int16 = 0
        compid_secondary: int16 = 0
        gimbal_device_id: uint8 = 0

    class Response(Message):
        """The response of GimbalManagerConfigure."""

        success: bool = False
        result: uint8 = 0


class GimbalManagerPitchyaw(ServiceType, typename="mavros_msgs/srv/GimbalManagerPitchyaw"):
    """GimbalManagerPitchyaw, as MAVROS defines it."""

    class Request(Message):
        """The request of GimbalManagerPitchyaw."""

        GIMBAL_MANAGER_FLAGS_RETRACT: ClassVar[uint32] = 1
        GIMBAL_MANAGER_FLAGS_NEUTRAL: ClassVar[uint32] = 2
        GIMBAL_MANAGER_FLAGS_ROLL_LOCK: ClassVar[uint32] = 4
        GIMBAL_MANAGER_FLAGS_PITCH_LOCK: ClassVar[uint32] = 8
        GIMBAL_MANAGER_FLAGS_YAW_LOCK: ClassVar[uint32] = 16

        pitch: float32 = 0.0
        yaw: float32 = 0.0
        pitch_rate: float32 = 0.0
        yaw_rate: float32 = 0.0
        flags: uint32 = 0
        gimbal_device_id: uint8 = 0

    class Response(Message):
        """The response of GimbalManagerPitchyaw."""

        success: bool = False
        result: uint8 = 0


class GimbalManagerSetRoi(ServiceType, typename="mavros_msgs/srv/GimbalManagerSetRoi"):
    """GimbalManagerSetRoi, as MAVROS defines it."""

    class Request(Message):
        """The request of GimbalManagerSetRoi."""

        ROI_MODE_LOCATION: ClassVar[uint8] = 0
        ROI_MODE_WP_NEXT_OFFSET: ClassVar[uint8] = 1
        ROI_MODE_SYSID: ClassVar[uint8] = 2
        ROI_MODE_NONE: ClassVar[uint8] = 3

        mode: uint8 = 0
        gimbal_device_id: uint8 = 0
        latitude: float32 = 0.0
        longitude: float32 = 0.0
        altitude: float32 = 0.0
        pitch_offset: float32 = 0.0
        roll_offset: float32 = 0.0
        yaw_offset: float32 = 0.0
        sysid: uint8 = 0

    class Response(Message):
        """The response of GimbalManagerSetRoi."""

        success: bool = False
        result: uint8 = 0


class LogRequestData(ServiceType, typename="mavros_msgs/srv/LogRequestData"):
    """LogRequestData, as MAVROS defines it."""

    class Request(Message):
        """The request of LogRequestData."""

        id: uint16 = 0
        offset: uint32 = 0
        count: uint32 = 0

    class Response(Message):
        """The response of LogRequestData."""

        success: bool = False


class LogRequestEnd(ServiceType, typename="mavros_msgs/srv/LogRequestEnd"):
    """LogRequestEnd, as MAVROS defines it."""

    class Request(Message):
        """The request of LogRequestEnd."""

    class Response(Message):
        """The response of LogRequestEnd."""

        success: bool = False


class LogRequestList(ServiceType, typename="mavros_msgs/srv/LogRequestList"):
    """LogRequestList, as MAVROS defines it."""

    class Request(Message):
        """The request of LogRequestList."""

        start: uint16 = 0
        end: uint16 = 0

    class Response(Message):
        """The response of LogRequestList."""

        success: bool = False


class MessageInterval(ServiceType, typename="mavros_msgs/srv/MessageInterval"):
    """MessageInterval, as MAVROS defines it."""

    class Request(Message):
        """The request of MessageInterval."""

        message_id: uint32 = 0
        message_rate: float32 = 0.0

    class Response(Message):
        """The response of MessageInterval."""

        success: bool = False


class MountConfigure(ServiceType, typename="mavros_msgs/srv/MountConfigure"):
    """MountConfigure, as MAVROS defines it."""

    class Request(Message):
        """The request of MountConfigure."""

        MODE_RETRACT: ClassVar[uint8] = 0
        MODE_NEUTRAL: ClassVar[uint8] = 1
        MODE_MAVLINK_TARGETING: ClassVar[uint8] = 2
        MODE_RC_TARGETING: ClassVar[uint8] = 3
        MODE_GPS_POINT: ClassVar[uint8] = 4
        INPUT_ANGLE_BODY_FRAME: ClassVar[uint8] = 0
        INPUT_ANGULAR_RATE: ClassVar[uint8] = 1
        INPUT_ANGLE_ABSOLUTE_FRAME: ClassVar[uint8] = 2

        header: Header = DEFAULT
        mode: uint8 = 0
        stabilize_roll: bool = False
        stabilize_pitch: bool = False
        stabilize_yaw: bool = False
        roll_input: uint8 = 0
        pitch_input: uint8 = 0
        yaw_input: uint8 = 0

    class Response(Message):
        """The response of MountConfigure."""

        success: bool = False
        result: uint8 = 0


class ParamGet(ServiceType, typename="mavros_msgs/srv/ParamGet"):
    """ParamGet, as MAVROS defines it."""

    class Request(Message):
        """The request of ParamGet."""

        param_id: str = ""

    class Response(Message):
        """The response of ParamGet."""

        success: bool = False
        value: ParamValue = DEFAULT


class ParamPull(ServiceType, typename="mavros_msgs/srv/ParamPull"):
    """ParamPull, as MAVROS defines it."""

    class Request(Message):
        """The request of ParamPull."""

        force_pull: bool = False

    class Response(Message):
        """The response of ParamPull."""

        success: bool = False
        param_received: uint32 = 0


class ParamPush(ServiceType, typename="mavros_msgs/srv/ParamPush"):
    """ParamPush, as MAVROS defines it."""

    class Request(Message):
        """The request of ParamPush."""

    class Response(Message):
        """The response of ParamPush."""

        success: bool = False
        param_transfered: uint32 = 0


class ParamSet(ServiceType, typename="mavros_msgs/srv/ParamSet"):
    """ParamSet, as MAVROS defines it."""

    class Request(Message):
        """The request of ParamSet."""

        param_id: str = ""
        value: ParamValue = DEFAULT

    class Response(Message):
        """The response of ParamSet."""

        success: bool = False
        value: ParamValue = DEFAULT


class ParamSetV2(ServiceType, typename="mavros_msgs/srv/ParamSetV2"):
    """ParamSetV2, as MAVROS defines it."""

    class Request(Message):
        """The request of ParamSetV2."""

        force_set: bool = False
        param_id: str = ""
        value: ParameterValue = DEFAULT

    class Response(Message):
        """The response of ParamSetV2."""

        success: bool = False
        value: ParameterValue = DEFAULT


class SetMavFrame(ServiceType, typename="mavros_msgs/srv/SetMavFrame"):
    """SetMavFrame, as MAVROS defines it."""

    class Request(Message):
        """The request of SetMavFrame."""

        FRAME_GLOBAL: ClassVar[uint8] = 0
        FRAME_LOCAL_NED: ClassVar[uint8] = 1
        FRAME_MISSION: ClassVar[uint8] = 2
        FRAME_GLOBAL_RELATIVE_ALT: ClassVar[uint8] = 3
        FRAME_LOCAL_ENU: ClassVar[uint8] = 4
        FRAME_GLOBAL_INT: ClassVar[uint8] = 5
        FRAME_GLOBAL_RELATIVE_ALT_INT: ClassVar[uint8] = 6
        FRAME_LOCAL_OFFSET_NED: ClassVar[uint8] = 7
        FRAME_BODY_NED: ClassVar[uint8] = 8
        FRAME_BODY_OFFSET_NED: ClassVar[uint8] = 9
        FRAME_GLOBAL_TERRAIN_ALT: ClassVar[uint8] = 10
        FRAME_GLOBAL_TERRAIN_ALT_INT: ClassVar[uint8] = 11
        FRAME_BODY_FRD: ClassVar[uint8] = 12
        FRAME_RESERVED_13: ClassVar[uint8] = 13
        FRAME_RESERVED_14: ClassVar[uint8] = 14
        FRAME_RESERVED_15: ClassVar[uint8] = 15
        FRAME_RESERVED_16: ClassVar[uint8] = 16
        FRAME_RESERVED_17: ClassVar[uint8] = 17
        FRAME_RESERVED_18: ClassVar[uint8] = 18
        FRAME_RESERVED_19: ClassVar[uint8] = 19
        FRAME_LOCAL_FRD: ClassVar[uint8] = 20
        FRAME_LOCAL_FLU: ClassVar[uint8] = 21

        mav_frame: uint8 = 0

    class Response(Message):
        """The response of SetMavFrame."""

        success: bool = False


class SetMode(ServiceType, typename="mavros_msgs/srv/SetMode"):
    """SetMode, as MAVROS defines it."""

    class Request(Message):
        """The request of SetMode."""

        MAV_MODE_PREFLIGHT: ClassVar[uint8] = 0
        MAV_MODE_STABILIZE_DISARMED: ClassVar[uint8] = 80
        MAV_MODE_STABILIZE_ARMED: ClassVar[uint8] = 208
        MAV_MODE_MANUAL_DISARMED: ClassVar[uint8] = 64
        MAV_MODE_MANUAL_ARMED: ClassVar[uint8] = 192
        MAV_MODE_GUIDED_DISARMED: ClassVar[uint8] = 88
        MAV_MODE_GUIDED_ARMED: ClassVar[uint8] = 216
        MAV_MODE_AUTO_DISARMED: ClassVar[uint8] = 92
        MAV_MODE_AUTO_ARMED: ClassVar[uint8] = 220
        MAV_MODE_TEST_DISARMED: ClassVar[uint8] = 66
        MAV_MODE_TEST_ARMED: ClassVar[uint8] = 194

        base_mode: uint8 = 0
        custom_mode: str = ""

    class Response(Message):
        """The response of SetMode."""

        mode_sent: bool = False


class StreamRate(ServiceType, typename="mavros_msgs/srv/StreamRate"):
    """StreamRate, as MAVROS defines it."""

    class Request(Message):
        """The request of StreamRate."""

        STREAM_ALL: ClassVar[uint8] = 0
        STREAM_RAW_SENSORS: ClassVar[uint8] = 1
        STREAM_EXTENDED_STATUS: ClassVar[uint8] = 2
        STREAM_RC_CHANNELS: ClassVar[uint8] = 3
        STREAM_RAW_CONTROLLER: ClassVar[uint8] = 4
        STREAM_POSITION: ClassVar[uint8] = 6
        STREAM_EXTRA1: ClassVar[uint8] = 10
        STREAM_EXTRA2: ClassVar[uint8] = 11
        STREAM_EXTRA3: ClassVar[uint8] = 12

        stream_id: uint8 = 0
        message_rate: uint16 = 0
        on_off: bool = False

    class Response(Message):
        """The response of StreamRate."""


class VehicleInfoGet(ServiceType, typename="mavros_msgs/srv/VehicleInfoGet"):
    """VehicleInfoGet, as MAVROS defines it."""

    class Request(Message):
        """The request of VehicleInfoGet."""

        GET_MY_SYSID: ClassVar[uint8] = 0
        GET_MY_COMPID: ClassVar[uint8] = 0

        sysid: uint8 = 0
        compid: uint8 = 0
        get_all: bool = False

    class Response(Message):
        """The response of VehicleInfoGet."""

        success: bool = False
        vehicles: Annotated[list_[VehicleInfo], Sequence[VehicleInfo]] = DEFAULT


class WaypointClear(ServiceType, typename="mavros_msgs/srv/WaypointClear"):
    """WaypointClear, as MAVROS defines it."""

    class Request(Message):
        """The request of WaypointClear."""

    class Response(Message):
        """The response of WaypointClear."""

        success: bool = False


class WaypointPull(ServiceType, typename="mavros_msgs/srv/WaypointPull"):
    """WaypointPull, as MAVROS defines it."""

    class Request(Message):
        """The request of WaypointPull."""

    class Response(Message):
        """The response of WaypointPull."""

        success: bool = False
        wp_received: uint32 = 0


class WaypointPush(ServiceType, typename="mavros_msgs/srv/WaypointPush"):
    """WaypointPush, as MAVROS defines it."""

    class Request(Message):
        """The request of WaypointPush."""

        start_index: uint16 = 0
        waypoints: Annotated[list_[Waypoint], Sequence[Waypoint]] = DEFAULT

    class Response(Message):
        """The response of WaypointPush."""

        success: bool = False
        wp_transfered: uint32 = 0


class WaypointSetCurrent(ServiceType, typename="mavros_msgs/srv/WaypointSetCurrent"):
    """WaypointSetCurrent, as MAVROS defines it."""

    class Request(Message):
        """The request of WaypointSetCurrent."""

        wp_seq: uint16 = 0

    class Response(Message):
        """The response of WaypointSetCurrent."""

        success: bool = False
