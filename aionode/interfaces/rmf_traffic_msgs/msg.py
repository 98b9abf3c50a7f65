"""Messages of rmf_traffic_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.interfaces.geometry_msgs.msg import Pose2D
from aionode.message import (
    DEFAULT,
    Array,
    Floats,
    Ints,
    Message,
    Sequence,
    float64,
    int64,
    uint8,
    uint16,
    uint64,
)

__all__ = [
    "BlockadeCancel",
    "BlockadeCheckpoint",
    "BlockadeHeartbeat",
    "BlockadeReached",
    "BlockadeReady",
    "BlockadeRelease",
    "BlockadeSet",
    "BlockadeStatus",
    "Circle",
    "ConvexShape",
    "ConvexShapeContext",
    "Heartbeat",
    "Itinerary",
    "ItineraryClear",
    "ItineraryDelay",
    "ItineraryExtend",
    "ItineraryReached",
    "ItinerarySet",
    "MirrorUpdate",
    "NegotiationAck",
    "NegotiationConclusion",
    "NegotiationForfeit",
    "NegotiationKey",
    "NegotiationNotice",
    "NegotiationParticipantAck",
    "NegotiationProposal",
    "NegotiationRefusal",
    "NegotiationRejection",
    "NegotiationRepeat",
    "NegotiationState",
    "NegotiationStates",
    "NegotiationStatus",
    "NegotiationStatuses",
    "NegotiationTreeNode",
    "Participant",
    "ParticipantDescription",
    "Participants",
    "Profile",
    "Region",
    "Route",
    "ScheduleChangeAdd",
    "ScheduleChangeAddItem",
    "ScheduleChangeCull",
    "ScheduleChangeDelay",
    "ScheduleChangeProgress",
    "ScheduleIdentity",
    "ScheduleInconsistency",
    "ScheduleInconsistencyRange",
    "ScheduleParticipantPatch",
    "SchedulePatch",
    "ScheduleQueries",
    "ScheduleQuery",
    "ScheduleQueryParticipants",
    "ScheduleQuerySpacetime",
    "Shape",
    "ShapeContext",
    "Space",
    "Timespan",
    "TrafficDependency",
    "Trajectory",
    "TrajectoryWaypoint",
]


class BlockadeCancel(Message, typename="rmf_traffic_msgs/msg/BlockadeCancel"):
    """BlockadeCancel, as Open-RMF defines it."""

    participant: uint64 = 0
    all_reservations: bool = False
    reservation: uint64 = 0


class BlockadeCheckpoint(Message, typename="rmf_traffic_msgs/msg/BlockadeCheckpoint"):
    """BlockadeCheckpoint, as Open-RMF defines it."""

    position: Annotated[Floats, Array[float64, 2]] = DEFAULT
    map_name: str = ""
    can_hold: bool = False


class BlockadeStatus(Message, typename="rmf_traffic_msgs/msg/BlockadeStatus"):
    """BlockadeStatus, as Open-RMF defines it."""

    participant: uint64 = 0
    reservation: uint64 = 0
    any_ready: bool = False
    last_ready: uint64 = 0
    last_reached: uint64 = 0
    assignment_begin: uint64 = 0
    assignment_end: uint64 = 0


class BlockadeHeartbeat(Message, typename="rmf_traffic_msgs/msg/BlockadeHeartbeat"):
    """BlockadeHeartbeat, as Open-RMF defines it."""

    statuses: Annotated[list[BlockadeStatus], Sequence[BlockadeStatus]] = DEFAULT
    has_gridlock: bool = False


class BlockadeReached(Message, typename="rmf_traffic_msgs/msg/BlockadeReached"):
    """BlockadeReached, as Open-RMF defines it."""

    participant: uint64 = 0
    reservation: uint64 = 0
    checkpoint: uint64 = 0


class BlockadeReady(Message, typename="rmf_traffic_msgs/msg/BlockadeReady"):
    """BlockadeReady, as Open-RMF defines it."""

    participant: uint64 = 0
    reservation: uint64 = 0
    checkpoint: uint64 = 0


class BlockadeRelease(Message, typename="rmf_traffic_msgs/msg/BlockadeRelease"):
    """BlockadeRelease, as Open-RMF defines it."""

    participant: uint64 = 0
    reservation: uint64 = 0
    checkpoint: uint64 = 0


class BlockadeSet(Message, typename="rmf_traffic_msgs/msg/BlockadeSet"):
    """BlockadeSet, as Open-RMF defines it."""

    participant: uint64 = 0
    reservation: uint64 = 0
    radius: float64 = 0.0
    path: Annotated[list[BlockadeCheckpoint], Sequence[BlockadeCheckpoint]] = DEFAULT


class Circle(Message, typename="rmf_traffic_msgs/msg/Circle"):
    """Circle, as Open-RMF defines it."""

    radius: float64 = 0.0


class ConvexShape(Message, typename="rmf_traffic_msgs/msg/ConvexShape"):
    """ConvexShape, as Open-RMF defines it."""

    NONE: ClassVar[uint8] = 0
    BOX: ClassVar[uint8] = 1
    CIRCLE: ClassVar[uint8] = 2

    type: uint8 = 0
    index: uint8 = 0


class ConvexShapeContext(Message, typename="rmf_traffic_msgs/msg/ConvexShapeContext"):
    """ConvexShapeContext, as Open-RMF defines it."""

    circles: Annotated[list[Circle], Sequence[Circle]] = DEFAULT


class Heartbeat(Message, typename="rmf_traffic_msgs/msg/Heartbeat"):
    """Heartbeat, as Open-RMF defines it."""


class TrajectoryWaypoint(Message, typename="rmf_traffic_msgs/msg/TrajectoryWaypoint"):
    """TrajectoryWaypoint, as Open-RMF defines it."""

    time: int64 = 0
    position: Annotated[Floats, Array[float64, 3]] = DEFAULT
    velocity: Annotated[Floats, Array[float64, 3]] = DEFAULT


class Trajectory(Message, typename="rmf_traffic_msgs/msg/Trajectory"):
    """Trajectory, as Open-RMF defines it."""

    waypoints: Annotated[list[TrajectoryWaypoint], Sequence[TrajectoryWaypoint]] = DEFAULT


class TrafficDependency(Message, typename="rmf_traffic_msgs/msg/TrafficDependency"):
    """TrafficDependency, as Open-RMF defines it."""

    dependent_checkpoint: uint64 = 0
    on_participant: uint64 = 0
    on_plan: uint64 = 0
    on_route: uint64 = 0
    on_checkpoint: uint64 = 0


class Route(Message, typename="rmf_traffic_msgs/msg/Route"):
    """Route, as Open-RMF defines it."""

    map: str = ""
    trajectory: Trajectory = DEFAULT
    checkpoints: Annotated[Ints, Sequence[uint64]] = DEFAULT
    dependencies: Annotated[list[TrafficDependency], Sequence[TrafficDependency]] = DEFAULT


class Itinerary(Message, typename="rmf_traffic_msgs/msg/Itinerary"):
    """Itinerary, as Open-RMF defines it."""

    routes: Annotated[list[Route], Sequence[Route]] = DEFAULT


class ItineraryClear(Message, typename="rmf_traffic_msgs/msg/ItineraryClear"):
    """ItineraryClear, as Open-RMF defines it."""

    participant: uint64 = 0
    itinerary_version: uint64 = 0


class ItineraryDelay(Message, typename="rmf_traffic_msgs/msg/ItineraryDelay"):
    """ItineraryDelay, as Open-RMF defines it."""

    participant: uint64 = 0
    delay: int64 = 0
    itinerary_version: uint64 = 0


class ItineraryExtend(Message, typename="rmf_traffic_msgs/msg/ItineraryExtend"):
    """ItineraryExtend, as Open-RMF defines it."""

    participant: uint64 = 0
    routes: Annotated[list[Route], Sequence[Route]] = DEFAULT
    itinerary_version: uint64 = 0


class ItineraryReached(Message, typename="rmf_traffic_msgs/msg/ItineraryReached"):
    """ItineraryReached, as Open-RMF defines it."""

    participant: uint64 = 0
    plan: uint64 = 0
    reached_checkpoints: Annotated[Ints, Sequence[uint64]] = DEFAULT
    progress_version: uint64 = 0


class ItinerarySet(Message, typename="rmf_traffic_msgs/msg/ItinerarySet"):
    """ItinerarySet, as Open-RMF defines it."""

    participant: uint64 = 0
    plan: uint64 = 0
    itinerary: Annotated[list[Route], Sequence[Route]] = DEFAULT
    storage_base: uint64 = 0
    itinerary_version: uint64 = 0


class ScheduleIdentity(Message, typename="rmf_traffic_msgs/msg/ScheduleIdentity"):
    """ScheduleIdentity, as Open-RMF defines it."""

    node_uuid: str = ""
    timestamp: Time = DEFAULT


class ScheduleChangeDelay(Message, typename="rmf_traffic_msgs/msg/ScheduleChangeDelay"):
    """ScheduleChangeDelay, as Open-RMF defines it."""

    delay: int64 = 0


class ScheduleChangeAddItem(Message, typename="rmf_traffic_msgs/msg/ScheduleChangeAddItem"):
    """ScheduleChangeAddItem, as Open-RMF defines it."""

    route_id: uint64 = 0
    storage_id: uint64 = 0
    route: Route = DEFAULT


class ScheduleChangeAdd(Message, typename="rmf_traffic_msgs/msg/ScheduleChangeAdd"):
    """ScheduleChangeAdd, as Open-RMF defines it."""

    plan_id: uint64 = 0
    items: Annotated[list[ScheduleChangeAddItem], Sequence[ScheduleChangeAddItem]] = DEFAULT


class ScheduleChangeProgress(Message, typename="rmf_traffic_msgs/msg/ScheduleChangeProgress"):
    """ScheduleChangeProgress, as Open-RMF defines it."""

    has_progress: bool = False
    version: uint64 = 0
    checkpoints: Annotated[Ints, Sequence[uint64]] = DEFAULT


class ScheduleParticipantPatch(Message, typename="rmf_traffic_msgs/msg/ScheduleParticipantPatch"):
    """ScheduleParticipantPatch, as Open-RMF defines it."""

    participant_id: uint64 = 0
    itinerary_version: uint64 = 0
    erasures: Annotated[Ints, Sequence[uint64]] = DEFAULT
    delays: Annotated[list[ScheduleChangeDelay], Sequence[ScheduleChangeDelay]] = DEFAULT
    additions: ScheduleChangeAdd = DEFAULT
    progress: ScheduleChangeProgress = DEFAULT


class ScheduleChangeCull(Message, typename="rmf_traffic_msgs/msg/ScheduleChangeCull"):
    """ScheduleChangeCull, as Open-RMF defines it."""

    time: int64 = 0


class SchedulePatch(Message, typename="rmf_traffic_msgs/msg/SchedulePatch"):
    """SchedulePatch, as Open-RMF defines it."""

    participants: Annotated[list[ScheduleParticipantPatch], Sequence[ScheduleParticipantPatch]] = (
        DEFAULT
    )
    cull: Annotated[list[ScheduleChangeCull], Sequence[ScheduleChangeCull]] = DEFAULT
    has_base_version: bool = False
    base_version: uint64 = 0
    latest_version: uint64 = 0


class MirrorUpdate(Message, typename="rmf_traffic_msgs/msg/MirrorUpdate"):
    """MirrorUpdate, as Open-RMF defines it."""

    node_id: ScheduleIdentity = DEFAULT
    database_version: uint64 = 0
    patch: SchedulePatch = DEFAULT
    is_remedial_update: bool = False


class NegotiationParticipantAck(Message, typename="rmf_traffic_msgs/msg/NegotiationParticipantAck"):
    """NegotiationParticipantAck, as Open-RMF defines it."""

    participant: uint64 = 0
    updating: bool = False
    itinerary_version: uint64 = 0


class NegotiationAck(Message, typename="rmf_traffic_msgs/msg/NegotiationAck"):
    """NegotiationAck, as Open-RMF defines it."""

    conflict_version: uint64 = 0
    acknowledgments: Annotated[
        list[NegotiationParticipantAck], Sequence[NegotiationParticipantAck]
    ] = DEFAULT


class NegotiationKey(Message, typename="rmf_traffic_msgs/msg/NegotiationKey"):
    """NegotiationKey, as Open-RMF defines it."""

    participant: uint64 = 0
    version: uint64 = 0


class NegotiationConclusion(Message, typename="rmf_traffic_msgs/msg/NegotiationConclusion"):
    """NegotiationConclusion, as Open-RMF defines it."""

    conflict_version: uint64 = 0
    resolved: bool = False
    table: Annotated[list[NegotiationKey], Sequence[NegotiationKey]] = DEFAULT


class NegotiationForfeit(Message, typename="rmf_traffic_msgs/msg/NegotiationForfeit"):
    """NegotiationForfeit, as Open-RMF defines it."""

    conflict_version: uint64 = 0
    table: Annotated[list[NegotiationKey], Sequence[NegotiationKey]] = DEFAULT


class NegotiationNotice(Message, typename="rmf_traffic_msgs/msg/NegotiationNotice"):
    """NegotiationNotice, as Open-RMF defines it."""

    conflict_version: uint64 = 0
    participants: Annotated[Ints, Sequence[uint64]] = DEFAULT


class NegotiationProposal(Message, typename="rmf_traffic_msgs/msg/NegotiationProposal"):
    """NegotiationProposal, as Open-RMF defines it."""

    conflict_version: uint64 = 0
    proposal_version: uint64 = 0
    for_participant: uint64 = 0
    to_accommodate: Annotated[list[NegotiationKey], Sequence[NegotiationKey]] = DEFAULT
    plan_id: uint64 = 0
    itinerary: Annotated[list[Route], Sequence[Route]] = DEFAULT


class NegotiationRefusal(Message, typename="rmf_traffic_msgs/msg/NegotiationRefusal"):
    """NegotiationRefusal, as Open-RMF defines it."""

    conflict_version: uint64 = 0


class NegotiationRejection(Message, typename="rmf_traffic_msgs/msg/NegotiationRejection"):
    """NegotiationRejection, as Open-RMF defines it."""

    conflict_version: uint64 = 0
    table: Annotated[list[NegotiationKey], Sequence[NegotiationKey]] = DEFAULT
    rejected_by: uint64 = 0
    alternatives: Annotated[list[Itinerary], Sequence[Itinerary]] = DEFAULT


class NegotiationRepeat(Message, typename="rmf_traffic_msgs/msg/NegotiationRepeat"):
    """NegotiationRepeat, as Open-RMF defines it."""

    conflict_version: uint64 = 0
    table: Annotated[Ints, Sequence[uint64]] = DEFAULT


class NegotiationStatus(Message, typename="rmf_traffic_msgs/msg/NegotiationStatus"):
    """NegotiationStatus, as Open-RMF defines it."""

    conflict_version: uint64 = 0
    participants: Annotated[Ints, Sequence[uint64]] = DEFAULT
    start_time: Time = DEFAULT
    last_response_time: Time = DEFAULT


class NegotiationTreeNode(Message, typename="rmf_traffic_msgs/msg/NegotiationTreeNode"):
    """NegotiationTreeNode, as Open-RMF defines it."""

    parent: int64 = 0
    key: NegotiationKey = DEFAULT
    rejected: bool = False
    itinerary: Annotated[list[Route], Sequence[Route]] = DEFAULT


class NegotiationState(Message, typename="rmf_traffic_msgs/msg/NegotiationState"):
    """NegotiationState, as Open-RMF defines it."""

    status: NegotiationStatus = DEFAULT
    tree: Annotated[list[NegotiationTreeNode], Sequence[NegotiationTreeNode]] = DEFAULT
    orphan_proposals: Annotated[list[NegotiationProposal], Sequence[NegotiationProposal]] = DEFAULT
    orphan_rejections: Annotated[list[NegotiationRejection], Sequence[NegotiationRejection]] = (
        DEFAULT
    )
    orphan_forfeits: Annotated[list[NegotiationForfeit], Sequence[NegotiationForfeit]] = DEFAULT


class NegotiationStates(Message, typename="rmf_traffic_msgs/msg/NegotiationStates"):
    """NegotiationStates, as Open-RMF defines it."""

    negotiations: Annotated[list[NegotiationState], Sequence[NegotiationState]] = DEFAULT


class NegotiationStatuses(Message, typename="rmf_traffic_msgs/msg/NegotiationStatuses"):
    """NegotiationStatuses, as Open-RMF defines it."""

    negotiations: Annotated[list[NegotiationStatus], Sequence[NegotiationStatus]] = DEFAULT


class Profile(Message, typename="rmf_traffic_msgs/msg/Profile"):
    """Profile, as Open-RMF defines it."""

    footprint: ConvexShape = DEFAULT
    vicinity: ConvexShape = DEFAULT
    shape_context: ConvexShapeContext = DEFAULT


class ParticipantDescription(Message, typename="rmf_traffic_msgs/msg/ParticipantDescription"):
    """ParticipantDescription, as Open-RMF defines it."""

    RX_INVALID: ClassVar[uint8] = 0
    RX_UNRESPONSIVE: ClassVar[uint8] = 1
    RX_RESPONSIVE: ClassVar[uint8] = 2

    name: str = ""
    owner: str = ""
    responsiveness: uint8 = 0
    profile: Profile = DEFAULT


class Participant(Message, typename="rmf_traffic_msgs/msg/Participant"):
    """Participant, as Open-RMF defines it."""

    id: uint64 = 0
    description: ParticipantDescription = DEFAULT


class Participants(Message, typename="rmf_traffic_msgs/msg/Participants"):
    """Participants, as Open-RMF defines it."""

    node_id: ScheduleIdentity = DEFAULT
    participants: Annotated[list[Participant], Sequence[Participant]] = DEFAULT


class Shape(Message, typename="rmf_traffic_msgs/msg/Shape"):
    """Shape, as Open-RMF defines it."""

    NONE: ClassVar[uint8] = 0
    BOX: ClassVar[uint8] = 1
    CIRCLE: ClassVar[uint8] = 2

    type: uint8 = 0
    index: uint8 = 0


class Space(Message, typename="rmf_traffic_msgs/msg/Space"):
    """Space, as Open-RMF defines it."""

    shape: Shape = DEFAULT
    pose: Pose2D = DEFAULT


class Timespan(Message, typename="rmf_traffic_msgs/msg/Timespan"):
    """Timespan, as Open-RMF defines it."""

    maps: Annotated[list[str], Sequence[str]] = DEFAULT
    has_lower_bound: bool = False
    lower_bound: int64 = 0
    has_upper_bound: bool = False
    upper_bound: int64 = 0


class Region(Message, typename="rmf_traffic_msgs/msg/Region"):
    """Region, as Open-RMF defines it."""

    map: str = ""
    spaces: Annotated[list[Space], Sequence[Space]] = DEFAULT
    timespan: Timespan = DEFAULT


class ScheduleInconsistencyRange(
    Message, typename="rmf_traffic_msgs/msg/ScheduleInconsistencyRange"
):
    """ScheduleInconsistencyRange, as Open-RMF defines it."""

    lower: uint64 = 0
    upper: uint64 = 0


class ScheduleInconsistency(Message, typename="rmf_traffic_msgs/msg/ScheduleInconsistency"):
    """ScheduleInconsistency, as Open-RMF defines it."""

    participant: uint64 = 0
    ranges: Annotated[list[ScheduleInconsistencyRange], Sequence[ScheduleInconsistencyRange]] = (
        DEFAULT
    )
    last_known_itinerary: uint64 = 0
    last_known_progress: uint64 = 0


class ShapeContext(Message, typename="rmf_traffic_msgs/msg/ShapeContext"):
    """ShapeContext, as Open-RMF defines it."""

    convex_shapes: ConvexShapeContext = DEFAULT


class ScheduleQuerySpacetime(Message, typename="rmf_traffic_msgs/msg/ScheduleQuerySpacetime"):
    """ScheduleQuerySpacetime, as Open-RMF defines it."""

    ALL: ClassVar[uint16] = 1
    REGIONS: ClassVar[uint16] = 2
    TIMESPAN: ClassVar[uint16] = 3

    type: uint16 = 0
    regions: Annotated[list[Region], Sequence[Region]] = DEFAULT
    shape_context: ShapeContext = DEFAULT
    timespan: Timespan = DEFAULT


class ScheduleQueryParticipants(Message, typename="rmf_traffic_msgs/msg/ScheduleQueryParticipants"):
    """ScheduleQueryParticipants, as Open-RMF defines it."""

    ALL: ClassVar[uint16] = 1
    INCLUDE: ClassVar[uint16] = 2
    EXCLUDE: ClassVar[uint16] = 3

    type: uint16 = 0
    ids: Annotated[Ints, Sequence[uint64]] = DEFAULT


class ScheduleQuery(Message, typename="rmf_traffic_msgs/msg/ScheduleQuery"):
    """ScheduleQuery, as Open-RMF defines it."""

    spacetime: ScheduleQuerySpacetime = DEFAULT
    participants: ScheduleQueryParticipants = DEFAULT


class ScheduleQueries(Message, typename="rmf_traffic_msgs/msg/ScheduleQueries"):
    """ScheduleQueries, as Open-RMF defines it."""

    node_id: ScheduleIdentity = DEFAULT
    queries: Annotated[list[ScheduleQuery], Sequence[ScheduleQuery]] = DEFAULT
    query_ids: Annotated[Ints, Sequence[uint64]] = DEFAULT
