"""Descriptions of a topic's publishers and subscriptions."""

from __future__ import annotations

from enum import IntEnum
from typing import TYPE_CHECKING, Any

from aionode import qos as core
from rclpy.qos import QoSHistoryPolicy, QoSPresetProfiles, QoSProfile
from rclpy.type_hash import Checked, TypeHash

if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = ["TopicEndpointInfo", "TopicEndpointTypeEnum"]


class TopicEndpointTypeEnum(IntEnum):
    """The kind of an endpoint; Lyrical, whose name is `EndpointTypeEnum`, added services."""

    INVALID = 0
    PUBLISHER = 1
    SUBSCRIPTION = 2
    CLIENT = 3
    SERVER = 4


def from_dict(kind: Any) -> Any:
    """Return a function that creates an object from a dict, and returns other values unchanged."""
    return lambda value: kind(**value) if isinstance(value, dict) else value


class TopicEndpointInfo:
    """One publisher or subscription.

    Attributes:
        node_name, node_namespace: Its node.
        topic_type: The name of its type.
        topic_type_hash: The hash of its type.
        endpoint_type: Publisher or subscription.
        endpoint_gid: Its gid, as numbers.
        qos_profile: Its profile.
    """

    __slots__ = (
        "_endpoint_gid",
        "_endpoint_type",
        "_node_name",
        "_node_namespace",
        "_qos_profile",
        "_topic_type",
        "_topic_type_hash",
    )

    node_name = Checked(str)
    node_namespace = Checked(str)
    topic_type = Checked(str)
    topic_type_hash = Checked(TypeHash, from_dict(TypeHash))
    endpoint_type = Checked(
        TopicEndpointTypeEnum,
        lambda value: TopicEndpointTypeEnum(value) if isinstance(value, int) else value,
    )
    endpoint_gid = Checked(list, list)
    qos_profile = Checked(core.QoSProfile, from_dict(QoSProfile))

    def __init__(
        self,
        node_name: str = "",
        node_namespace: str = "",
        topic_type: str = "",
        topic_type_hash: TypeHash | dict[str, Any] | None = None,
        endpoint_type: TopicEndpointTypeEnum | int = TopicEndpointTypeEnum.INVALID,
        endpoint_gid: Sequence[int] = (),
        qos_profile: QoSProfile | dict[str, Any] = QoSPresetProfiles.UNKNOWN.value,
    ) -> None:
        given = {
            "node_name": node_name,
            "node_namespace": node_namespace,
            "topic_type": topic_type,
            "topic_type_hash": TypeHash() if topic_type_hash is None else topic_type_hash,
            "endpoint_type": endpoint_type,
            "endpoint_gid": endpoint_gid,
            "qos_profile": qos_profile,
        }
        for name, value in given.items():
            setattr(self, name, value)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, TopicEndpointInfo):
            return False
        return all(getattr(self, slot) == getattr(other, slot) for slot in self.__slots__)

    __hash__ = None  # type: ignore[assignment] # its attributes can be set

    def __str__(self) -> str:
        profile = self.qos_profile
        history = profile.history.name
        if profile.history == QoSHistoryPolicy.KEEP_LAST:
            history = f"{history} ({profile.depth})"
        gid = ".".join(format(number, "02x") for number in self.endpoint_gid)
        return "\n".join(
            (
                f"Node name: {self.node_name}",
                f"Node namespace: {self.node_namespace}",
                f"Topic type: {self.topic_type}",
                f"Topic type hash: {self.topic_type_hash}",
                f"Endpoint type: {self.endpoint_type.name}",
                f"GID: {gid}",
                "QoS profile:",
                f"  Reliability: {profile.reliability.name}",
                f"  History (Depth): {history}",
                f"  Durability: {profile.durability.name}",
                f"  Lifespan: {profile.lifespan}",
                f"  Deadline: {profile.deadline}",
                f"  Liveliness: {profile.liveliness.name}",
                f"  Liveliness lease duration: {profile.liveliness_lease_duration}",
            )
        )
