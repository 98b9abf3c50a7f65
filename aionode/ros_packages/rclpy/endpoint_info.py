"""Descriptions of endpoints of topics and services, as in rclpy of ROS 2 Lyrical."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rclpy.qos import QoSProfile
from rclpy.topic_endpoint_info import TopicEndpointInfo, TopicEndpointTypeEnum, from_dict
from rclpy.type_hash import Checked, TypeHash

if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = ["EndpointTypeEnum", "ServiceEndpointInfo", "TopicEndpointInfo"]

EndpointTypeEnum = TopicEndpointTypeEnum


class ServiceEndpointInfo:
    """One client or server of a service.

    Over Zenoh it is one endpoint, with one id and one profile.

    Attributes:
        node_name, node_namespace: Its node.
        service_type: The name of its type.
        service_type_hash: The hash of its type.
        qos_profiles: The profiles of its endpoints.
        endpoint_gids: The gid of each of them, as numbers.
        endpoint_type: Client or server.
        endpoint_count: The number of endpoints of which it consists.
    """

    __slots__ = (
        "_endpoint_count",
        "_endpoint_gids",
        "_endpoint_type",
        "_node_name",
        "_node_namespace",
        "_qos_profiles",
        "_service_type",
        "_service_type_hash",
    )

    node_name = Checked(str)
    node_namespace = Checked(str)
    service_type = Checked(str)
    service_type_hash = Checked(TypeHash, from_dict(TypeHash))
    qos_profiles = Checked(list, list)
    endpoint_gids = Checked(list, list)
    endpoint_type = Checked(
        TopicEndpointTypeEnum,
        lambda value: TopicEndpointTypeEnum(value) if isinstance(value, int) else value,
    )
    endpoint_count = Checked(int)

    def __init__(
        self,
        node_name: str = "",
        node_namespace: str = "",
        service_type: str = "",
        service_type_hash: TypeHash | dict[str, Any] | None = None,
        qos_profiles: Sequence[QoSProfile | dict[str, Any]] = (),
        endpoint_gids: Sequence[list[int]] = (),
        endpoint_type: TopicEndpointTypeEnum | int = TopicEndpointTypeEnum.INVALID,
        endpoint_count: int = 0,
    ) -> None:
        given = {
            "node_name": node_name,
            "node_namespace": node_namespace,
            "service_type": service_type,
            "service_type_hash": TypeHash() if service_type_hash is None else service_type_hash,
            "qos_profiles": list(map(from_dict(QoSProfile), qos_profiles)),
            "endpoint_gids": endpoint_gids,
            "endpoint_type": endpoint_type,
            "endpoint_count": endpoint_count,
        }
        for name, value in given.items():
            setattr(self, name, value)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, ServiceEndpointInfo):
            return False
        return all(getattr(self, slot) == getattr(other, slot) for slot in self.__slots__)

    __hash__ = None  # type: ignore[assignment] # its attributes can be set

    def __str__(self) -> str:
        lines = [
            f"Node name: {self.node_name}",
            f"Node namespace: {self.node_namespace}",
            f"Service type: {self.service_type}",
            f"Service type hash: {self.service_type_hash}",
            f"Endpoint type: {self.endpoint_type.name}",
            f"Endpoint count: {self.endpoint_count}",
        ]
        gids = [".".join(format(number, "02x") for number in gid) for gid in self.endpoint_gids]
        if self.endpoint_count == 1:
            lines += [f"GID: {gids[0]}", "QoS profile:", *lines_of(self.qos_profiles[0], "  ")]
        elif self.endpoint_count == 2:
            names = ("Request Reader", "Response Writer")
            if self.endpoint_type == EndpointTypeEnum.CLIENT:
                names = ("Response Reader", "Request Writer")
            parts = sorted(
                zip(names, gids, self.qos_profiles, strict=True), key=lambda part: part[0]
            )
            lines += ["GIDs:", *(f" - {name} : {gid}" for name, gid, _ in parts), "QoS profiles:"]
            for name, _, profile in parts:
                lines += [f" - {name} :", *lines_of(profile, "      ")]
        return "\n".join(lines)


def lines_of(profile: QoSProfile, indent: str) -> list[str]:
    """Return the lines that describe a profile."""
    return [
        f"{indent}Reliability: {profile.reliability.name}",
        f"{indent}History (Depth): {profile.history.name} ({profile.depth})",
        f"{indent}Durability: {profile.durability.name}",
        f"{indent}Lifespan: {profile.lifespan}",
        f"{indent}Deadline: {profile.deadline}",
        f"{indent}Liveliness: {profile.liveliness.name}",
        f"{indent}Liveliness lease duration: {profile.liveliness_lease_duration}",
    ]
