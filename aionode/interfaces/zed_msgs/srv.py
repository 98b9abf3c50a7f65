"""Services of zed_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.message import (
    DEFAULT,
    Array,
    Floats,
    Message,
    ServiceType,
    float32,
    int32,
    uint8,
    uint32,
)

__all__ = ["SaveAreaMemory", "SetPose", "SetROI", "SetSvoFrame", "StartSvoRec"]


class SaveAreaMemory(ServiceType, typename="zed_msgs/srv/SaveAreaMemory"):
    """SaveAreaMemory, as ZED defines it."""

    class Request(Message):
        """The request of SaveAreaMemory."""

        area_file_path: str = ""

    class Response(Message):
        """The response of SaveAreaMemory."""

        success: bool = False
        message: str = ""


class SetPose(ServiceType, typename="zed_msgs/srv/SetPose"):
    """SetPose, as ZED defines it."""

    class Request(Message):
        """The request of SetPose."""

        pos: Annotated[Floats, Array[float32, 3]] = DEFAULT
        orient: Annotated[Floats, Array[float32, 3]] = DEFAULT

    class Response(Message):
        """The response of SetPose."""

        success: bool = False
        message: str = ""


class SetROI(ServiceType, typename="zed_msgs/srv/SetROI"):
    """SetROI, as ZED defines it."""

    class Request(Message):
        """The request of SetROI."""

        roi: str = ""

    class Response(Message):
        """The response of SetROI."""

        success: bool = False
        message: str = ""


class SetSvoFrame(ServiceType, typename="zed_msgs/srv/SetSvoFrame"):
    """SetSvoFrame, as ZED defines it."""

    class Request(Message):
        """The request of SetSvoFrame."""

        frame_id: int32 = 0

    class Response(Message):
        """The response of SetSvoFrame."""

        success: bool = False
        message: str = ""


class StartSvoRec(ServiceType, typename="zed_msgs/srv/StartSvoRec"):
    """StartSvoRec, as ZED defines it."""

    class Request(Message):
        """The request of StartSvoRec."""

        bitrate: uint32 = 0
        compression_mode: uint8 = 0
        target_framerate: uint32 = 0
        input_transcode: bool = False
        svo_filename: str = ""

    class Response(Message):
        """The response of StartSvoRec."""

        success: bool = False
        message: str = ""
