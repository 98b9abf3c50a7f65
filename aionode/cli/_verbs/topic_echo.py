"""``aionode topic echo``."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from aionode.cli._support import lookup
from aionode.cli._support.follow import Follower, filter_from
from aionode.cli._support.formatting import PrintOptions, byte_form, csv_line, field_of, yaml_text
from aionode.errors import CommandError
from aionode.graph import TOPIC_KINDS, EndpointKind
from aionode.message import Message
from aionode.qos import DurabilityPolicy, ReliabilityPolicy, qos_profile_sensor_data

if TYPE_CHECKING:
    from collections.abc import Sequence
    from enum import Enum

    from aionode.cli._support.output import Output
    from aionode.endpoints.subscription import MessageInfo, Subscription
    from aionode.graph import EndpointInfo
    from aionode.node import Node
    from aionode.qos import QoSProfile

__all__ = ["echo"]

DEPTH = 1000
"""Default queue depth: how many messages may wait to be printed."""


async def echo(
    node: Node,
    topic_name: str,
    message_type: str | None = None,
    *,
    output: Output,
    qos: QoSProfile | None = None,
    csv: bool = False,
    field: str | None = None,
    truncate_length: int | None = 128,
    no_arr: bool = False,
    no_str: bool = False,
    flow_style: bool = False,
    no_lost_messages: bool = False,
    raw: bool = False,
    filter_text: str | None = None,
    content_filter: str | None = None,
    once: bool = False,
    timeout: float | None = None,
    with_info: bool = False,
    clear: bool = False,
) -> int:
    """Print each message of a topic; return the exit status.

    The default profile is the strongest that all current publishers offer.

    Raises:
        CommandError: the type cannot be determined, or `field` or a filter is invalid.
    """
    if field is not None and not field.strip("."):
        raise CommandError(f"Invalid field value '{field}': expected a path such as pose.position")
    name = node.resolve_topic_name(topic_name)
    publishers = lookup.endpoints(node, EndpointKind.PUBLISHER, name=name)
    msg_type = await lookup.topic_type(node, name, message_type)
    if msg_type is None:
        raise no_type(node, name)
    if not publishers:
        output.warn(f"WARNING: topic [{name}] does not appear to be published yet")
    print_options = PrintOptions(
        None if output.json else truncate_length,
        no_arr=no_arr,
        no_str=no_str,
        as_byte=byte_form(output, csv=csv or field is not None),
    )
    printer = Printer(output, print_options, csv=csv, field=field, flow_style=flow_style)
    fits = filter_from(filter_text)
    follower = Follower(node)
    lost = 0

    def on_message(msg: Any, info: MessageInfo) -> None:
        nonlocal lost
        if not no_lost_messages and subscription.stats.lost > lost:
            print_lost(output, subscription, lost)
            lost = subscription.stats.lost
        if filter_text is not None and not fits(printer.part_of(msg)):
            return
        if clear:
            output.clear()
        printer.show(msg, info if with_info else None)
        if once:
            follower.finish()

    profile = qos or strongest(publishers, output)
    subscription = follower.follow(
        msg_type, name, on_message, profile, raw=raw, content_filter=content_filter or ""
    )
    if not await follower.finished(timeout) and not subscription.stats.received:
        output.warn(
            f"No message on '{name}' within {timeout:g} s; "
            f"publishers: {len(lookup.endpoints(node, EndpointKind.PUBLISHER, name=name))}"
        )
        return 1
    return 0


def no_type(node: Node, name: str) -> CommandError:
    """Return the error for a topic without endpoints."""
    hint = lookup.close_to(name, lookup.names_and_types(node, *TOPIC_KINDS, hidden=True))
    return CommandError(
        f"Could not determine the type for the passed topic '{name}': it has no "
        f"publisher or subscription{hint or '.'} To wait for it, give its type: aionode topic echo "
        f"{name} std_msgs/msg/String"
    )


def print_lost(output: Output, subscription: Subscription[Any], before: int) -> None:
    """Report messages that were published but did not arrive."""
    total = subscription.stats.lost
    output.warn(
        f"A message was lost!!!\n\ttotal count change:{total - before}\n\ttotal count: {total}---"
    )


def strongest(publishers: Sequence[EndpointInfo], output: Output) -> QoSProfile:
    """Return the strongest profile that all `publishers` offer; warn where they differ."""
    profile = qos_profile_sensor_data.replace(depth=DEPTH)
    if not publishers:
        return profile

    def choose(offered: list[Enum], strong: Enum, weak: Enum) -> Any:
        if all(value is strong for value in offered):
            return strong
        if strong in offered:
            output.warn(
                f"Some, but not all, publishers are offering {type(strong).__name__}."
                f"{strong.name}. Falling back to {type(weak).__name__}.{weak.name} as it will "
                "connect to all publishers"
            )
        return weak

    return profile.replace(
        reliability=choose(
            [publisher.qos.reliability for publisher in publishers],
            ReliabilityPolicy.RELIABLE,
            ReliabilityPolicy.BEST_EFFORT,
        ),
        durability=choose(
            [publisher.qos.durability for publisher in publishers],
            DurabilityPolicy.TRANSIENT_LOCAL,
            DurabilityPolicy.VOLATILE,
        ),
    )


@dataclass(frozen=True, slots=True)
class Printer:
    """Prints messages in the form that the options select."""

    output: Output
    print_options: PrintOptions
    csv: bool = False
    field: str | None = None
    flow_style: bool = False

    def part_of(self, msg: Any) -> Any:
        """Return the part of a message that is printed: all of it, or one field."""
        if self.field is None or not isinstance(msg, Message):
            return msg
        return field_of(msg, self.field)[0]

    def show(self, msg: Any, info: MessageInfo | None) -> None:
        """Print one message, preceded by `info` if given."""
        if not isinstance(msg, Message):
            self._show_raw(bytes(msg), info)
            return
        part, type_ = (msg, None) if self.field is None else field_of(msg, self.field)
        plain = self.print_options.value(part, type_)
        if self.output.json:
            self._show_json(plain, info)
        elif self.csv:
            first = "" if info is None else f"{','.join(str(v) for v in times(info).values())},"
            self.output.text(first + csv_line(plain))
        else:
            head = "" if info is None else f"{yaml_text(times(info))}---\n"
            body = (
                yaml_text(plain, flow_style=self.flow_style)
                if isinstance(part, Message)
                else f"{plain}\n"
            )
            self.output.text(f"{head}{body}---")

    def _show_raw(self, data: bytes, info: MessageInfo | None) -> None:
        if self.output.json:
            self._show_json(data, info)  # as Base64
            return
        if info is not None:
            self.output.text("---Got new message, message info:---")
            self.output.text(f"{times(info)}\n---Message data:---")
        self.output.text(f"{data!r}\n---")

    def _show_json(self, plain: Any, info: MessageInfo | None) -> None:
        self.output.item("", plain if info is None else {"info": times(info), "message": plain})


def times(info: MessageInfo) -> dict[str, int]:
    """Return the parts of a message's info that ros2 prints; times in nanoseconds since 1970."""
    return {
        "source_timestamp": info["source_timestamp"],
        "received_timestamp": info["received_timestamp"],
        "publication_sequence_number": info["publication_sequence_number"],
        "reception_sequence_number": info["reception_sequence_number"],
    }
