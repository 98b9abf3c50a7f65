"""Services of rai_interfaces.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.geometry_msgs.msg import Pose, PoseStamped
from aionode.interfaces.rai_interfaces.msg import RAIDetectionArray
from aionode.interfaces.sensor_msgs.msg import Image
from aionode.message import DEFAULT, Floats, Message, Sequence, ServiceType, float32, float64

__all__ = [
    "EmbodimentInfo",
    "ManipulatorMoveTo",
    "RAIGroundedSam",
    "RAIGroundingDino",
    "StringList",
    "VectorStoreRetrieval",
    "WhatISee",
]


class EmbodimentInfo(ServiceType, typename="rai_interfaces/srv/EmbodimentInfo"):
    """EmbodimentInfo, as RAI defines it."""

    class Request(Message):
        """The request of EmbodimentInfo."""

    class Response(Message):
        """The response of EmbodimentInfo."""

        rules: Annotated[list[str], Sequence[str]] = DEFAULT
        capabilities: Annotated[list[str], Sequence[str]] = DEFAULT
        behaviors: Annotated[list[str], Sequence[str]] = DEFAULT
        description: str = ""
        images: Annotated[list[str], Sequence[str]] = DEFAULT


class ManipulatorMoveTo(ServiceType, typename="rai_interfaces/srv/ManipulatorMoveTo"):
    """ManipulatorMoveTo, as RAI defines it."""

    class Request(Message):
        """The request of ManipulatorMoveTo."""

        initial_gripper_state: bool = False
        final_gripper_state: bool = False
        target_pose: PoseStamped = DEFAULT

    class Response(Message):
        """The response of ManipulatorMoveTo."""

        success: bool = False


class RAIGroundedSam(ServiceType, typename="rai_interfaces/srv/RAIGroundedSam"):
    """RAIGroundedSam, as RAI defines it."""

    class Request(Message):
        """The request of RAIGroundedSam."""

        detections: RAIDetectionArray = DEFAULT
        source_img: Image = DEFAULT

    class Response(Message):
        """The response of RAIGroundedSam."""

        masks: Annotated[list[Image], Sequence[Image]] = DEFAULT


class RAIGroundingDino(ServiceType, typename="rai_interfaces/srv/RAIGroundingDino"):
    """RAIGroundingDino, as RAI defines it."""

    class Request(Message):
        """The request of RAIGroundingDino."""

        classes: str = ""
        box_threshold: float64 = 0.0
        text_threshold: float64 = 0.0
        source_img: Image = DEFAULT

    class Response(Message):
        """The response of RAIGroundingDino."""

        detections: RAIDetectionArray = DEFAULT


class StringList(ServiceType, typename="rai_interfaces/srv/StringList"):
    """StringList, as RAI defines it."""

    class Request(Message):
        """The request of StringList."""

    class Response(Message):
        """The response of StringList."""

        success: bool = False
        string_list: Annotated[list[str], Sequence[str]] = DEFAULT


class VectorStoreRetrieval(ServiceType, typename="rai_interfaces/srv/VectorStoreRetrieval"):
    """VectorStoreRetrieval, as RAI defines it."""

    class Request(Message):
        """The request of VectorStoreRetrieval."""

        query: str = ""

    class Response(Message):
        """The response of VectorStoreRetrieval."""

        success: bool = False
        message: str = ""
        documents: Annotated[list[str], Sequence[str]] = DEFAULT
        scores: Annotated[Floats, Sequence[float32]] = DEFAULT


class WhatISee(ServiceType, typename="rai_interfaces/srv/WhatISee"):
    """WhatISee, as RAI defines it."""

    class Request(Message):
        """The request of WhatISee."""

    class Response(Message):
        """The response of WhatISee."""

        observations: Annotated[list[str], Sequence[str]] = DEFAULT
        perception_source: str = ""
        image: Image = DEFAULT
        pose: Pose = DEFAULT
