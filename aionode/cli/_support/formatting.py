"""Messages and endpoints as text, in ros2's layout."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING, Any

from aionode.cli._support.field_path import field_of
from aionode.errors import CommandError
from aionode.graph import SERVICE_KINDS
from aionode.message import Message
from aionode.message.conversion import Form, plain, plain_value
from aionode.qos import HistoryPolicy

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from aionode.cli._support.output import Output
    from aionode.graph import EndpointInfo
    from aionode.message import FieldType

__all__ = [
    "Printer",
    "csv_line",
    "endpoint_record",
    "endpoint_text",
    "names_text",
    "yaml_text",
]


def yaml_text(plain: object, *, flow_style: bool = False) -> str:
    """Return plain values as YAML; with `flow_style`, lists are in brackets on one line."""
    import yaml

    text: str = yaml.dump(
        plain,
        Dumper=block_mappings(),
        allow_unicode=True,
        default_flow_style=flow_style,
        sort_keys=False,
        width=2**31 - 1,
    )
    return text


@functools.cache
def block_mappings() -> Any:
    """Return PyYAML's dumper, modified to print each key on its own line, as ros2 does."""
    import yaml

    base: Any = getattr(yaml, "CSafeDumper", yaml.SafeDumper)  # libyaml is optional
    dumper: Any = type("BlockMappings", (base,), {})
    tag = "tag:yaml.org,2002:map"
    dumper.add_representer(
        dict, lambda to, mapping: to.represent_mapping(tag, mapping, flow_style=False)
    )
    return dumper


def csv_line(plain: Any) -> str:
    """Return all values on one line, separated by commas, with line breaks escaped."""
    if isinstance(plain, dict):
        return ",".join(csv_line(value) for value in plain.values())
    if isinstance(plain, list):
        return ",".join(csv_line(value) for value in plain)
    return str(plain).replace("\n", "\\n").replace("\r", "\\r")


class Printer:
    """Prints messages in the format selected by the options of ``echo``.

    Args:
        output: Where to print.
        csv: Whether to print all values on one line.
        flow_style: Whether to print each array on one line, in brackets.
        truncate_length: Maximum number of elements or characters to print; None prints all, as
        ``--json`` always does.
        no_arr: Whether to describe arrays instead of printing them.
        no_str: Whether to describe strings instead of printing them.
        fields: Paths of the fields to print; if empty, the whole message is printed.

    Raises:
        CommandError: a path is empty.
    """

    def __init__(
        self,
        output: Output,
        *,
        csv: bool = False,
        flow_style: bool = False,
        truncate_length: int | None = 128,
        no_arr: bool = False,
        no_str: bool = False,
        fields: Sequence[str] = (),
    ) -> None:
        for path in fields:
            if not path.strip("."):
                raise CommandError(
                    f"Invalid field value '{path}': expected a path such as pose.position"
                )
        self._output = output
        self._csv = csv
        self._flow_style = flow_style
        self._fields = fields
        # ros2 prints a `byte` as a character, but in CSV and as a single field as bytes.
        as_byte = chr if not (csv or fields) else lambda number: bytes((number,))
        self._form = Form(
            as_byte=int if output.json else as_byte,
            truncate=None if output.json else truncate_length,
            no_arr=no_arr,
            no_str=no_str,
        )

    def part_of(self, msg: Any) -> Any:
        """Return the part of a message to print: all of it, one field, or a list of fields."""
        parts = [part for part, _ in self._parts(msg)]
        return parts[0] if len(parts) == 1 else parts

    def show(self, msg: Any, info: Mapping[str, int] | None = None) -> None:
        """Print one message, or its bytes, preceded by `info` if given."""
        if isinstance(msg, Message):
            parts = self._parts(msg)
            if len(parts) == 1:
                ((part, type_),) = parts
                self.show_plain(self.plain(part, type_), info, as_yaml=isinstance(part, Message))
            else:
                self._show_fields([self.plain(part, type_) for part, type_ in parts], info)
        elif self._output.json:
            self.show_plain(bytes(msg), info)  # as Base64
        else:
            if info is not None:
                self._output.text("---Got new message, message info:---")
                self._output.text(f"{info}\n---Message data:---")
            self._output.text(f"{bytes(msg)!r}\n---")

    def plain(self, part: Any, type_: FieldType | None = None) -> Any:
        """Return a message, or a part of one with the given type, as plain values."""
        if isinstance(part, Message):
            return plain(part, self._form)
        if type_ is None or isinstance(part, int):  # an element of an array of bytes is a number
            return part
        return plain_value(type_, part, self._form)

    def show_plain(
        self, plain: Any, info: Mapping[str, int] | None = None, *, as_yaml: bool = True
    ) -> None:
        """Print plain values, preceded by `info` if given."""
        if self._output.json:
            self._output.item("", plain if info is None else {"info": info, "message": plain})
        elif self._csv:
            first = "" if info is None else f"{csv_line(info)},"
            self._output.text(first + csv_line(plain))
        else:
            head = "" if info is None else f"{yaml_text(info)}---\n"
            body = yaml_text(plain, flow_style=self._flow_style) if as_yaml else f"{plain}\n"
            self._output.text(f"{head}{body}---")

    def _show_fields(self, values: list[Any], info: Mapping[str, int] | None) -> None:
        """Print several fields, in the order of the command line."""
        if self._output.json or self._csv:
            self.show_plain(dict(zip(self._fields, values, strict=True)), info)
            return
        head = "" if info is None else f"{yaml_text(info)}---\n"
        bodies = [
            yaml_text(value, flow_style=self._flow_style)
            if isinstance(value, dict)
            else f"{value}\n"
            for value in values
        ]
        self._output.text(f"{head}{''.join(bodies)}---")

    def _parts(self, msg: Any) -> list[tuple[Any, FieldType | None]]:
        if not self._fields or not isinstance(msg, Message):
            return [(msg, None)]
        return [field_of(msg, path) for path in self._fields]


def names_text(names: list[str]) -> str:
    """Return a single name unchanged, several names as a list."""
    return names[0] if len(names) == 1 else str(names)


def endpoint_text(endpoint: EndpointInfo) -> str:
    """Return the details of an endpoint of a topic or service, in ros2's layout.

    A client or server is one endpoint, as over Zenoh.
    """
    profile = endpoint.qos
    is_service = endpoint.kind in SERVICE_KINDS
    of, count = ("Service", ["Endpoint count: 1"]) if is_service else ("Topic", [])
    depth = f" ({profile.depth})" if profile.history is HistoryPolicy.KEEP_LAST else ""
    return "\n".join(
        (
            f"Node name: {endpoint.node.name}",
            f"Node namespace: {endpoint.node.namespace}",
            f"{of} type: {endpoint.type_name}",
            f"{of} type hash: {endpoint.type_hash}",
            f"Endpoint type: {endpoint.kind.name}",
            *count,
            f"GID: {'.'.join(f'{byte:02x}' for byte in endpoint.gid)}",
            "QoS profile:",
            f"  Reliability: {profile.reliability.name}",
            f"  History (Depth): {profile.history.name}{depth}",
            f"  Durability: {profile.durability.name}",
            f"  Lifespan: {profile.lifespan}",
            f"  Deadline: {profile.deadline}",
            f"  Liveliness: {profile.liveliness.name}",
            f"  Liveliness lease duration: {profile.liveliness_lease_duration}",
        )
    )


def endpoint_record(user: EndpointInfo) -> dict[str, Any]:
    """Return the record of an endpoint; times are in nanoseconds."""
    profile = user.qos
    return {
        "node": user.node.fully_qualified_name,
        "type": user.type_name,
        "type_hash": user.type_hash,
        "gid": user.gid.hex(),
        "qos": {
            "reliability": profile.reliability.short_key,
            "history": profile.history.short_key,
            "depth": profile.depth,
            "durability": profile.durability.short_key,
            "lifespan_ns": profile.lifespan.nanoseconds,
            "deadline_ns": profile.deadline.nanoseconds,
            "liveliness": profile.liveliness.short_key,
            "liveliness_lease_duration_ns": profile.liveliness_lease_duration.nanoseconds,
        },
    }
