"""The base of topic_tools' programs: a topic of any type is republished on another one."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from aionode import (
    DurabilityPolicy,
    LivelinessPolicy,
    Node,
    Parameter,
    Publisher,
    QoSProfile,
    ReliabilityPolicy,
    Subscription,
)
from aionode.errors import AionodeError, CommandError
from aionode.parameter import ParameterType
from aionode.programs._wall_timer import create_wall_timer

__all__ = ["AnyTypeNode", "given_number"]

DISCOVERY_SEC = 0.1
"""How often publishers and subscriptions are searched for."""


class AnyTypeNode(Node):
    """Subscribes to `input_topic` as its publishers offer it, and publishes on `output_topic`.

    Type and QoS are those of the current publishers; messages are not decoded.

    Args:
        name: The name of the node.
        given: The parameters given as arguments, which take precedence over all others.

    Attributes:
        input_topic: The topic that is read.
        output_topic: The topic that is published.
        output: Its publisher, while the input has a publisher.
    """

    def __init__(self, name: str, given: Mapping[str, Any]) -> None:
        super().__init__(
            name,
            parameter_overrides=[Parameter(key, value=value) for key, value in given.items()],
        )
        self.input_topic = ""
        self.output_topic = ""
        self.is_lazy = False
        self.output: Publisher[Any] | None = None
        self.__input: Subscription[bytes] | None = None
        self.__found: tuple[str, QoSProfile] | None = None
        self.__warned = ""
        create_wall_timer(self, DISCOVERY_SEC, self.discover)

    def needed(self, name: str, kind: ParameterType) -> Any:
        """Return the value of a parameter that has no default.

        Raises:
            CommandError: It has no value.
        """
        parameter = self.declare_parameter(name, kind)
        if parameter.type_ is ParameterType.NOT_SET:
            raise CommandError(
                f"parameter '{name}' is required: set it, or pass the argument for it"
            )
        return parameter.value

    def declare_topics(self, suffix: str) -> None:
        """Declare the parameters that most of the programs have."""
        self.input_topic = self.needed("input_topic", Parameter.Type.STRING)
        self.output_topic = self.declare_parameter("output_topic", self.input_topic + suffix).value
        self.is_lazy = self.declare_parameter("lazy", False).value
        if self.resolve_topic_name(self.input_topic) == self.resolve_topic_name(self.output_topic):
            raise CommandError(
                f"{self.output_topic}: input and output are the same topic, so each message "
                "would return endlessly"
            )

    def process(self, data: bytes) -> None:
        """Process a message, as CDR bytes."""
        self.send(data)

    def send(self, data: bytes) -> None:
        """Publish a message if the input still has a publisher."""
        if self.output is not None:
            self.output.publish(data)

    def forget(self) -> None:
        """End the subscription and the publisher."""
        if self.__input is not None:
            self.__input.destroy()
        if self.output is not None:
            self.output.destroy()
        self.__input = self.output = self.__found = None

    def listen(self, topic: str) -> None:
        """Switch to a different input topic."""
        full = self.resolve_topic_name(topic)
        if self.__input is not None and full != self.resolve_topic_name(self.input_topic):
            self.__input.destroy()
            self.__input = None
        self.input_topic = topic

    async def discover(self) -> None:
        """Subscribe and publish according to the input's publishers; without any, do neither."""
        publishers = self.get_publishers_info_by_topic(self.input_topic)
        if not publishers:
            self.forget()
            return
        found = publishers[0].topic_type, self.common_qos([each.qos_profile for each in publishers])
        if found != self.__found or self.output is None:
            self.forget()
            try:
                message = await self.find_type(found[0])
            except (AionodeError, LookupError) as error:
                self.warn_once(f"{self.input_topic}: {error}")
                return
            self.output = self.create_publisher(message, self.output_topic, found[1])
            self.__found = found
            self.__type = message
        if self.is_lazy and not self.output.get_subscription_count():
            if self.__input is not None:
                self.__input.destroy()
            self.__input = None
        elif self.__input is None:
            self.__input = self.create_subscription(
                self.__type, self.input_topic, self.process, found[1], raw=True
            )

    def common_qos(self, offered: list[QoSProfile]) -> QoSProfile:
        """Return a QoS that is compatible with all of these offers."""
        reliable = {each.reliability is ReliabilityPolicy.RELIABLE for each in offered}
        latched = {each.durability is DurabilityPolicy.TRANSIENT_LOCAL for each in offered}
        for both, policy, other in (
            (reliable, "'reliable' reliability", "'best effort' reliability"),
            (latched, "'transient local' durability", "'volatile' durability"),
        ):
            if len(both) == 2:
                self.warn_once(
                    f"Some, but not all, publishers on topic {self.input_topic} offer {policy}. "
                    f"Falling back to {other} in order to connect to all publishers."
                )
        return QoSProfile(
            depth=10,
            reliability=(
                ReliabilityPolicy.RELIABLE if reliable == {True} else ReliabilityPolicy.BEST_EFFORT
            ),
            durability=(
                DurabilityPolicy.TRANSIENT_LOCAL if latched == {True} else DurabilityPolicy.VOLATILE
            ),
            liveliness=LivelinessPolicy.AUTOMATIC,
            deadline=max(each.deadline for each in offered),
            lifespan=max(each.lifespan for each in offered),
        )

    def warn_once(self, text: str) -> None:
        """Warn, unless that was the last warning; discovery runs ten times a second."""
        if text != self.__warned:
            self.get_logger().warning(text)
        self.__warned = text


def given_number(text: str, kind: type[int | float], name: str) -> int | float:
    """Parse a number in an argument.

    Raises:
        CommandError: It is not a number.
    """
    try:
        return kind(text)
    except ValueError:
        raise CommandError(f"{name} is {text!r}; use a number") from None
