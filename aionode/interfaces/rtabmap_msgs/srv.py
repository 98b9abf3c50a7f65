"""Services of rtabmap_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.geometry_msgs.msg import Pose, PoseStamped
from aionode.interfaces.rtabmap_msgs.msg import Link, MapData, Node, Path
from aionode.message import DEFAULT, Floats, Ints, Message, Sequence, ServiceType, float32, int32

__all__ = [
    "AddLink",
    "CleanupLocalGrids",
    "DetectMoreLoopClosures",
    "GetMap",
    "GetMap2",
    "GetNodeData",
    "GetNodesInRadius",
    "GetPlan",
    "GlobalBundleAdjustment",
    "ListLabels",
    "LoadDatabase",
    "PublishMap",
    "RemoveLabel",
    "ResetPose",
    "SetGoal",
    "SetLabel",
]


class AddLink(ServiceType, typename="rtabmap_msgs/srv/AddLink"):
    """AddLink, as RTAB-Map defines it."""

    class Request(Message):
        """The request of AddLink."""

        link: Link = DEFAULT

    class Response(Message):
        """The response of AddLink."""


class CleanupLocalGrids(ServiceType, typename="rtabmap_msgs/srv/CleanupLocalGrids"):
    """CleanupLocalGrids, as RTAB-Map defines it."""

    class Request(Message):
        """The request of CleanupLocalGrids."""

        radius: int32 = 0
        filter_scans: bool = False

    class Response(Message):
        """The response of CleanupLocalGrids."""

        modified: int32 = 0


class DetectMoreLoopClosures(ServiceType, typename="rtabmap_msgs/srv/DetectMoreLoopClosures"):
    """DetectMoreLoopClosures, as RTAB-Map defines it."""

    class Request(Message):
        """The request of DetectMoreLoopClosures."""

        cluster_radius_max: float32 = 0.0
        cluster_radius_min: float32 = 0.0
        cluster_angle: float32 = 0.0
        iterations: int32 = 0
        intra_only: bool = False
        inter_only: bool = False

    class Response(Message):
        """The response of DetectMoreLoopClosures."""

        detected: int32 = 0


class GetMap(ServiceType, typename="rtabmap_msgs/srv/GetMap"):
    """GetMap, as RTAB-Map defines it."""

    class Request(Message):
        """The request of GetMap."""

        global_map: bool = False
        optimized: bool = False
        graph_only: bool = False

    class Response(Message):
        """The response of GetMap."""

        data: MapData = DEFAULT


class GetMap2(ServiceType, typename="rtabmap_msgs/srv/GetMap2"):
    """GetMap2, as RTAB-Map defines it."""

    class Request(Message):
        """The request of GetMap2."""

        global_map: bool = False
        optimized: bool = False
        with_images: bool = False
        with_scans: bool = False
        with_user_data: bool = False
        with_grids: bool = False
        with_words: bool = False
        with_global_descriptors: bool = False

    class Response(Message):
        """The response of GetMap2."""

        data: MapData = DEFAULT


class GetNodeData(ServiceType, typename="rtabmap_msgs/srv/GetNodeData"):
    """GetNodeData, as RTAB-Map defines it."""

    class Request(Message):
        """The request of GetNodeData."""

        ids: Annotated[Ints, Sequence[int32]] = DEFAULT
        images: bool = False
        scan: bool = False
        grid: bool = False
        user_data: bool = False

    class Response(Message):
        """The response of GetNodeData."""

        data: Annotated[list[Node], Sequence[Node]] = DEFAULT


class GetNodesInRadius(ServiceType, typename="rtabmap_msgs/srv/GetNodesInRadius"):
    """GetNodesInRadius, as RTAB-Map defines it."""

    class Request(Message):
        """The request of GetNodesInRadius."""

        node_id: int32 = 0
        x: float32 = 0.0
        y: float32 = 0.0
        z: float32 = 0.0
        radius: float32 = 0.0
        k: int32 = 0

    class Response(Message):
        """The response of GetNodesInRadius."""

        ids: Annotated[Ints, Sequence[int32]] = DEFAULT
        poses: Annotated[list[Pose], Sequence[Pose]] = DEFAULT
        dists_sqr: Annotated[Floats, Sequence[float32]] = DEFAULT


class GetPlan(ServiceType, typename="rtabmap_msgs/srv/GetPlan"):
    """GetPlan, as RTAB-Map defines it."""

    class Request(Message):
        """The request of GetPlan."""

        goal_node: int32 = 0
        goal: PoseStamped = DEFAULT
        tolerance: float32 = 0.0

    class Response(Message):
        """The response of GetPlan."""

        plan: Path = DEFAULT


class GlobalBundleAdjustment(ServiceType, typename="rtabmap_msgs/srv/GlobalBundleAdjustment"):
    """GlobalBundleAdjustment, as RTAB-Map defines it."""

    class Request(Message):
        """The request of GlobalBundleAdjustment."""

        type: int32 = 0
        iterations: int32 = 0
        pixel_variance: float32 = 0.0
        voc_matches: bool = False

    class Response(Message):
        """The response of GlobalBundleAdjustment."""


class ListLabels(ServiceType, typename="rtabmap_msgs/srv/ListLabels"):
    """ListLabels, as RTAB-Map defines it."""

    class Request(Message):
        """The request of ListLabels."""

    class Response(Message):
        """The response of ListLabels."""

        ids: Annotated[Ints, Sequence[int32]] = DEFAULT
        labels: Annotated[list[str], Sequence[str]] = DEFAULT


class LoadDatabase(ServiceType, typename="rtabmap_msgs/srv/LoadDatabase"):
    """LoadDatabase, as RTAB-Map defines it."""

    class Request(Message):
        """The request of LoadDatabase."""

        database_path: str = ""
        clear: bool = False

    class Response(Message):
        """The response of LoadDatabase."""


class PublishMap(ServiceType, typename="rtabmap_msgs/srv/PublishMap"):
    """PublishMap, as RTAB-Map defines it."""

    class Request(Message):
        """The request of PublishMap."""

        global_map: bool = False
        optimized: bool = False
        graph_only: bool = False

    class Response(Message):
        """The response of PublishMap."""


class RemoveLabel(ServiceType, typename="rtabmap_msgs/srv/RemoveLabel"):
    """RemoveLabel, as RTAB-Map defines it."""

    class Request(Message):
        """The request of RemoveLabel."""

        label: str = ""

    class Response(Message):
        """The response of RemoveLabel."""


class ResetPose(ServiceType, typename="rtabmap_msgs/srv/ResetPose"):
    """ResetPose, as RTAB-Map defines it."""

    class Request(Message):
        """The request of ResetPose."""

        x: float32 = 0.0
        y: float32 = 0.0
        z: float32 = 0.0
        roll: float32 = 0.0
        pitch: float32 = 0.0
        yaw: float32 = 0.0

    class Response(Message):
        """The response of ResetPose."""


class SetGoal(ServiceType, typename="rtabmap_msgs/srv/SetGoal"):
    """SetGoal, as RTAB-Map defines it."""

    class Request(Message):
        """The request of SetGoal."""

        node_id: int32 = 0
        node_label: str = ""
        frame_id: str = ""

    class Response(Message):
        """The response of SetGoal."""

        path_ids: Annotated[Ints, Sequence[int32]] = DEFAULT
        path_poses: Annotated[list[Pose], Sequence[Pose]] = DEFAULT
        planning_time: float32 = 0.0


class SetLabel(ServiceType, typename="rtabmap_msgs/srv/SetLabel"):
    """SetLabel, as RTAB-Map defines it."""

    class Request(Message):
        """The request of SetLabel."""

        node_id: int32 = 0
        node_label: str = ""

    class Response(Message):
        """The response of SetLabel."""
