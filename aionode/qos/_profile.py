"""QoS policies, profiles and presets."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from enum import Enum, IntEnum
from typing import TYPE_CHECKING, Any, Self, TypeVar

from aionode.clock import CONST_INFINITE_NS, Duration
from aionode.errors import InvalidQoSProfileException, brief

__all__ = [
    "DEFAULT_DEPTH",
    "KEEP_ALL_DEPTH",
    "DeadlineBestAvailable",
    "DurabilityPolicy",
    "HistoryPolicy",
    "LivelinessLeaseDurationBestAvailable",
    "LivelinessPolicy",
    "QoSDurabilityPolicy",
    "QoSHistoryPolicy",
    "QoSLivelinessPolicy",
    "QoSPolicyEnum",
    "QoSPolicyKind",
    "QoSPresetProfiles",
    "QoSProfile",
    "QoSReliabilityPolicy",
    "ReliabilityPolicy",
    "as_profile",
    "depth_of",
    "duration_text",
    "is_unlimited",
    "keeps_all",
    "qos_policy_name_from_kind",
    "qos_profile_action_status_default",
    "qos_profile_best_available",
    "qos_profile_default",
    "qos_profile_parameter_events",
    "qos_profile_parameters",
    "qos_profile_rosout_default",
    "qos_profile_sensor_data",
    "qos_profile_services_default",
    "qos_profile_system_default",
    "qos_profile_unknown",
]

DEFAULT_DEPTH = 42
"""The depth used for a depth of 0 (rmw_zenoh_cpp, src/detail/qos.cpp)."""

DeadlineBestAvailable = Duration(nanoseconds=CONST_INFINITE_NS - 1)
"""A deadline that is compatible with the endpoints visible when the entity is created."""

LivelinessLeaseDurationBestAvailable = DeadlineBestAvailable
"""A lease duration that is compatible with the endpoints visible when the entity is created."""

PolicyT = TypeVar("PolicyT", bound="QoSPolicyEnum")

# Policies: values and names are those of rclpy and rmw.


class QoSPolicyEnum(IntEnum):
    """Base class of the policies, whose members have short, lower-case names."""

    @classmethod
    def short_keys(cls) -> list[str]:
        """Return the names of all values, as used on the command line."""
        return [key.lower() for key in cls.__members__]

    @classmethod
    def get_from_short_key(cls, name: str) -> Self:
        """Return the value called `name`, in upper or lower case.

        Raises:
            KeyError: The name is unknown.
        """
        return cls[name.upper()]

    @property
    def short_key(self) -> str:
        """The name in lower case."""
        return self.name.lower()


class HistoryPolicy(QoSPolicyEnum):
    """Which messages are kept for a slow subscription: the newest `depth`, or all."""

    SYSTEM_DEFAULT = 0
    KEEP_LAST = 1
    KEEP_ALL = 2
    UNKNOWN = 3


class ReliabilityPolicy(QoSPolicyEnum):
    """Whether lost messages are sent again."""

    SYSTEM_DEFAULT = 0
    RELIABLE = 1
    BEST_EFFORT = 2
    UNKNOWN = 3
    BEST_AVAILABLE = 4


class DurabilityPolicy(QoSPolicyEnum):
    """Whether a late subscription receives the newest of the earlier messages."""

    SYSTEM_DEFAULT = 0
    TRANSIENT_LOCAL = 1
    VOLATILE = 2
    UNKNOWN = 3
    BEST_AVAILABLE = 4


class LivelinessPolicy(QoSPolicyEnum):
    """How the liveliness of a publisher is asserted: by its node, or by the publisher itself."""

    SYSTEM_DEFAULT = 0
    AUTOMATIC = 1
    MANUAL_BY_TOPIC = 3
    UNKNOWN = 4
    BEST_AVAILABLE = 5


QoSHistoryPolicy = HistoryPolicy

QoSReliabilityPolicy = ReliabilityPolicy

QoSDurabilityPolicy = DurabilityPolicy

QoSLivelinessPolicy = LivelinessPolicy


class QoSPolicyKind(IntEnum):
    """The kinds of policies; the values are those of rmw."""

    INVALID = 1 << 0
    DURABILITY = 1 << 1
    DEADLINE = 1 << 2
    LIVELINESS = 1 << 3
    RELIABILITY = 1 << 4
    HISTORY = 1 << 5
    LIFESPAN = 1 << 6
    DEPTH = 1 << 7
    LIVELINESS_LEASE_DURATION = 1 << 8
    AVOID_ROS_NAMESPACE_CONVENTIONS = 1 << 9


def qos_policy_name_from_kind(policy_kind: QoSPolicyKind | int) -> str:
    """Return the name of a policy, such as ``RELIABILITY``."""
    return QoSPolicyKind(policy_kind).name


# The profile


def policy(name: str, kind: type[PolicyT]) -> Callable[[object], PolicyT]:
    """Create the validation function of a policy field."""
    fits = ", ".join(f"{member.short_key} ({member.value})" for member in kind)

    def check(value: object) -> PolicyT:
        if isinstance(value, kind):
            return value
        if isinstance(value, int) and not isinstance(value, Enum | bool):
            try:
                return kind(value)
            except ValueError:
                problem = f"{name}={value} is unknown; {kind.__name__} has {fits}"
                raise InvalidQoSProfileException(problem) from None
        message = f"{name} must be a {kind.__name__} ({fits}), not {brief(value)}"
        raise TypeError(message)

    return check


def duration(name: str) -> Callable[[object], Duration]:
    """Create the validation function of a duration field."""

    def check(value: object) -> Duration:
        if not isinstance(value, Duration):
            message = (
                f"{name} must be a Duration, such as Duration(seconds=0.1), not {brief(value)}"
            )
            raise TypeError(message)
        if value.nanoseconds < 0:
            problem = f"{name}={value} is negative; use zero for no limit"
            raise InvalidQoSProfileException(problem)
        return value

    return check


def check_depth(value: object) -> int:
    """Check the field `depth`."""
    if not isinstance(value, int) or isinstance(value, bool):
        message = f"depth must be an int, the number of messages kept, not {brief(value)}"
        raise TypeError(message)
    if value < 0:
        problem = f"depth={value} is negative; a queue holds at least one message"
        raise InvalidQoSProfileException(problem)
    return value


def check_flag(value: object) -> bool:
    """Check the field `avoid_ros_namespace_conventions`."""
    if not isinstance(value, bool):
        message = f"avoid_ros_namespace_conventions must be True or False, not {brief(value)}"
        raise TypeError(message)
    return value


CHECKS: dict[str, Callable[[object], object]] = {
    "history": policy("history", HistoryPolicy),
    "depth": check_depth,
    "reliability": policy("reliability", ReliabilityPolicy),
    "durability": policy("durability", DurabilityPolicy),
    "lifespan": duration("lifespan"),
    "deadline": duration("deadline"),
    "liveliness": policy("liveliness", LivelinessPolicy),
    "liveliness_lease_duration": duration("liveliness_lease_duration"),
    "avoid_ros_namespace_conventions": check_flag,
}

DEFAULTS: dict[str, Any] = {
    "history": HistoryPolicy.KEEP_LAST,
    "depth": 10,
    "reliability": ReliabilityPolicy.RELIABLE,
    "durability": DurabilityPolicy.VOLATILE,
    "lifespan": Duration(),
    "deadline": Duration(),
    "liveliness": LivelinessPolicy.SYSTEM_DEFAULT,
    "liveliness_lease_duration": Duration(),
    "avoid_ros_namespace_conventions": False,
}


class QoSProfile:
    """The policies of one endpoint.

    A history or a depth must be given, so that the queue size is chosen explicitly. The other
    policies default to reliable, volatile, and no time limits.

    A profile is mutable, and values are validated when they are set. Entities copy the profile when
    they are created, so later changes do not affect them. Do not change a profile that is a key of
    a dict.

    Attributes:
        history: Whether the newest `depth` messages are kept, or all.
        depth: How many messages are kept with KEEP_LAST.
        reliability: Whether lost messages are sent again.
        durability: Whether late subscriptions get the messages that are kept.
        lifespan: How long a message is valid.
        deadline: The longest time between two messages.
        liveliness: How a publisher shows that it is alive.
        liveliness_lease_duration: The longest time between two such signs.
        avoid_ros_namespace_conventions: Whether topic names get no prefix over DDS.

    Raises:
        InvalidQoSProfileException: Neither history nor depth is given, KEEP_LAST is given without a
            depth, or a value is out of range.
        TypeError: A value has the wrong type.
    """

    __slots__ = tuple(CHECKS)

    history: HistoryPolicy
    depth: int
    reliability: ReliabilityPolicy
    durability: DurabilityPolicy
    lifespan: Duration
    deadline: Duration
    liveliness: LivelinessPolicy
    liveliness_lease_duration: Duration
    avoid_ros_namespace_conventions: bool

    def __init__(
        self,
        history: HistoryPolicy | int | None = None,
        depth: int | None = None,
        reliability: ReliabilityPolicy | int | None = None,
        durability: DurabilityPolicy | int | None = None,
        lifespan: Duration | None = None,
        deadline: Duration | None = None,
        liveliness: LivelinessPolicy | int | None = None,
        liveliness_lease_duration: Duration | None = None,
        avoid_ros_namespace_conventions: bool | None = None,
    ) -> None:
        if history is None and depth is None:
            problem = "History and/or depth settings are required, as in QoSProfile(depth=10)"
            raise InvalidQoSProfileException(problem)
        if history == HistoryPolicy.KEEP_LAST and depth is None:
            problem = (
                "History set to KEEP_LAST without a depth setting, the number of messages kept"
            )
            raise InvalidQoSProfileException(problem)
        given = (
            history,
            depth,
            reliability,
            durability,
            lifespan,
            deadline,
            liveliness,
            liveliness_lease_duration,
            avoid_ros_namespace_conventions,
        )
        for (name, default), value in zip(DEFAULTS.items(), given, strict=True):
            setattr(self, name, default if value is None else value)

    if not TYPE_CHECKING:  # otherwise type checkers would accept misspelled fields

        def __setattr__(self, name: str, value: object) -> None:
            check = CHECKS.get(name)
            if check is None:
                message = f"QoSProfile has no {brief(name)}; it has {', '.join(CHECKS)}"
                raise AttributeError(message)
            checked = check(value)
            if (
                name == "depth"
                and checked == 0
                and getattr(self, "history", None) is HistoryPolicy.KEEP_LAST
            ):
                warnings.warn(
                    "A zero depth with KEEP_LAST doesn't make sense; no data could be stored. "
                    f"This will be interpreted as SYSTEM_DEFAULT ({DEFAULT_DEPTH} messages)",
                    stacklevel=2,
                )
            object.__setattr__(self, name, checked)

    def replace(self, **changes: Any) -> QoSProfile:
        """Return a copy with the given fields changed."""
        copy = object.__new__(QoSProfile)
        for name in CHECKS:
            if name in changes:
                setattr(copy, name, changes.pop(name))
            else:
                object.__setattr__(copy, name, getattr(self, name))
        for name, value in changes.items():
            setattr(copy, name, value)  # raises AttributeError, which lists the valid names
        return copy

    def resolved(self) -> QoSProfile:
        """Return a copy with all system defaults replaced by the values that endpoints use.

        Depth 0 becomes 42, a zero duration becomes infinite, and SYSTEM_DEFAULT becomes the default
        of rmw_zenoh: keep_last, reliable, volatile, automatic.
        """
        changes: dict[str, object] = {
            name: choice for name, choice in SYSTEM_CHOICES.items() if not getattr(self, name)
        }
        infinite = Duration(nanoseconds=CONST_INFINITE_NS)
        for name in ("lifespan", "deadline", "liveliness_lease_duration"):
            if getattr(self, name).nanoseconds == 0:
                changes[name] = infinite
        return self.replace(**changes)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, QoSProfile):
            return NotImplemented
        return all(getattr(self, name) == getattr(other, name) for name in CHECKS)

    def __hash__(self) -> int:
        return hash(tuple(getattr(self, name) for name in CHECKS))

    def __repr__(self) -> str:
        """Return an expression for an equal profile: the depth and all non-default values."""
        shown = []
        for name, default in DEFAULTS.items():
            value = getattr(self, name)
            if name == "depth" or value != default:
                text = str(value) if not isinstance(value, QoSPolicyEnum) else enum_text(value)
                shown.append(f"{name}={repr(value) if isinstance(value, Duration) else text}")
        return f"QoSProfile({', '.join(shown)})"

    def __str__(self) -> str:
        """Return a short description, such as ``keep_last(10) reliable volatile``."""
        words = [
            f"{self.history.short_key}({self.depth})",
            self.reliability.short_key,
            self.durability.short_key,
        ]
        for name in ("lifespan", "deadline", "liveliness_lease_duration"):
            value: Duration = getattr(self, name)
            if not is_unlimited(value):
                words.append(f"{name}={duration_text(value)}")
        if self.liveliness not in {LivelinessPolicy.SYSTEM_DEFAULT, LivelinessPolicy.AUTOMATIC}:
            words.append(self.liveliness.short_key)
        return " ".join(words)


SYSTEM_CHOICES = {
    "history": HistoryPolicy.KEEP_LAST,
    "depth": DEFAULT_DEPTH,
    "reliability": ReliabilityPolicy.RELIABLE,
    "durability": DurabilityPolicy.VOLATILE,
    "liveliness": LivelinessPolicy.AUTOMATIC,
}


def enum_text(value: QoSPolicyEnum) -> str:
    """Return the Python expression of a policy value."""
    return f"{type(value).__name__}.{value.name}"


def is_unlimited(value: Duration) -> bool:
    """Return whether a duration sets no limit: zero, or infinite."""
    return value.nanoseconds in {0, CONST_INFINITE_NS}


def duration_text(value: Duration) -> str:
    """Return a duration in seconds as readable text."""
    if value == DeadlineBestAvailable:
        return "best_available"
    return "infinite" if is_unlimited(value) else f"{value.nanoseconds / 1e9:g} s"


def as_profile(qos: object) -> QoSProfile:
    """Return a new profile for an entity: a copy, or KEEP_LAST with the given depth.

    Raises:
        ValueError: The depth is negative.
        TypeError: `qos` is neither.
    """
    if isinstance(qos, QoSProfile):
        return qos.replace()
    if isinstance(qos, int) and not isinstance(qos, bool):
        if qos < 0:
            message = f"history depth must be greater than or equal to zero, not {qos}"
            raise ValueError(message)
        return QoSProfile(depth=qos)
    message = f"Expected QoSProfile or int (the depth), but received {brief(qos)}"
    raise TypeError(message)


# Presets


qos_profile_default = QoSProfile(depth=10)
"""Ten messages, reliable, volatile."""

qos_profile_sensor_data = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
"""For data that is soon outdated: a short queue, and no retransmission of lost messages."""

qos_profile_services_default = QoSProfile(depth=10)
"""For services and their clients."""

qos_profile_parameters = QoSProfile(depth=1000)
"""For parameter services: a long queue for bursts of requests when many nodes start."""

qos_profile_parameter_events = QoSProfile(depth=1000)
"""For `/parameter_events`."""

qos_profile_action_status_default = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
"""For action status: late subscriptions receive the newest message."""

qos_profile_rosout_default = QoSProfile(
    depth=1000, durability=DurabilityPolicy.TRANSIENT_LOCAL, lifespan=Duration(seconds=10)
)
"""For `/rosout`: late subscriptions receive the messages of the last 10 s."""

qos_profile_system_default = QoSProfile(
    history=HistoryPolicy.SYSTEM_DEFAULT,
    depth=0,
    reliability=ReliabilityPolicy.SYSTEM_DEFAULT,
    durability=DurabilityPolicy.SYSTEM_DEFAULT,
)
"""All policies are left to the system."""

qos_profile_best_available = QoSProfile(
    depth=10,
    reliability=ReliabilityPolicy.BEST_AVAILABLE,
    durability=DurabilityPolicy.BEST_AVAILABLE,
    deadline=DeadlineBestAvailable,
    liveliness=LivelinessPolicy.BEST_AVAILABLE,
    liveliness_lease_duration=LivelinessLeaseDurationBestAvailable,
)
"""The strongest policies compatible with the endpoints visible when the entity is created."""

qos_profile_unknown = QoSProfile(
    history=HistoryPolicy.UNKNOWN,
    depth=0,
    reliability=ReliabilityPolicy.UNKNOWN,
    durability=DurabilityPolicy.UNKNOWN,
    liveliness=LivelinessPolicy.UNKNOWN,
)
"""The profile of an endpoint whose policies are unknown; not valid for creating one."""


class QoSPresetProfiles(Enum):
    """The presets by name."""

    UNKNOWN = qos_profile_unknown
    DEFAULT = qos_profile_default
    SYSTEM_DEFAULT = qos_profile_system_default
    SENSOR_DATA = qos_profile_sensor_data
    SERVICES_DEFAULT = qos_profile_services_default
    PARAMETERS = qos_profile_parameters
    PARAMETER_EVENTS = qos_profile_parameter_events
    ACTION_STATUS_DEFAULT = qos_profile_action_status_default
    ROSOUT_DEFAULT = qos_profile_rosout_default
    BEST_AVAILABLE = qos_profile_best_available

    @classmethod
    def short_keys(cls) -> list[str]:
        """Return the names of all presets, as used on the command line."""
        return [key.lower() for key in cls.__members__]

    @classmethod
    def get_from_short_key(cls, name: str) -> QoSProfile:
        """Return the preset called `name`, in upper or lower case.

        Raises:
            KeyError: The name is unknown.
        """
        return cls[name.upper()].value


KEEP_ALL_DEPTH = 10_000
"""Minimum queue size of a KEEP_ALL endpoint, in messages."""


def depth_of(qos: QoSProfile) -> int:
    """Return the queue size of an endpoint, in messages."""
    resolved = qos.resolved()
    if resolved.history is HistoryPolicy.KEEP_ALL:
        return max(resolved.depth, KEEP_ALL_DEPTH)
    return resolved.depth


def keeps_all(qos: QoSProfile) -> bool:
    """Return whether an endpoint must not drop messages: KEEP_ALL and reliable."""
    resolved = qos.resolved()
    return (
        resolved.history is HistoryPolicy.KEEP_ALL
        and resolved.reliability is ReliabilityPolicy.RELIABLE
    )
