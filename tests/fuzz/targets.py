"""The parsers of what others send or write, each with inputs to begin from.

A target takes any bytes. It returns what the parser made of them, or the one documented error as
text; anything else that it raises is a defect.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from functools import cache
from typing import Any, Final

import msgspec

from aionode.arguments import parse_arguments, remove_ros_args
from aionode.arguments._parameter_yaml import parse_parameter_yaml, parse_value
from aionode.engine.transport.link import _protocol as protocol
from aionode.engine.transport.link._listener import Advertisement
from aionode.engine.transport.link._protocol import BufferRef, Frame, FrameParser, Kind
from aionode.engine.transport.network import network_from
from aionode.engine.transport.zenoh.endpoints.services import error_payload, parse_error
from aionode.engine.wire import _attachment as attachment
from aionode.engine.wire import cdr
from aionode.engine.wire._key_expression import parse_data_key
from aionode.engine.wire._liveliness import parse_qos, parse_token
from aionode.errors import (
    ConfigurationError,
    DecodeError,
    FrameError,
    IdlError,
    InvalidROSArgsError,
    NameValidationException,
    ParameterFileError,
)
from aionode.idl import define
from aionode.message import Message, type_name
from aionode.names import resolve
from tests.fuzz import files
from tests.support.samples import all_samples

__all__ = ["TARGETS", "Target", "cdr_input"]


class Target(msgspec.Struct, frozen=True):
    """A parser.

    Attributes:
        name: What it is called on the command line.
        run: Takes any bytes.
        seeds: Returns inputs that it understands.
        overhead: How many bytes of memory each byte of input may take while it is parsed, at most.
        words: What inputs consist of: a fuzzer puts them together.
    """

    name: str
    run: Callable[[bytes], object]
    seeds: Callable[[], list[bytes]]
    overhead: int = 500
    words: tuple[str, ...] = ()


def text_of(data: bytes) -> str:
    """Return bytes as a text."""
    return data.decode("utf-8", "replace")


# CDR: two bytes choose the type


@cache
def sampled_types() -> list[type[Message]]:
    """Return the types of which there are samples."""
    found = {type_name(type(each.message)): type(each.message) for each in all_samples()}
    return [found[name] for name in sorted(found)]


def cdr_input(message_type: type[Message], data: bytes) -> bytes:
    """Return the input for one encoded message."""
    return sampled_types().index(message_type).to_bytes(2, "little") + data


def run_cdr(data: bytes) -> object:
    """Decode one message, and what it is encoded to."""
    types = sampled_types()
    message_type = types[int.from_bytes(data[:2], "little") % len(types)]
    try:
        message = cdr.decode(message_type, data[2:])
    except DecodeError as error:
        return str(error)
    again = cdr.encode(message)
    if cdr.encode(cdr.decode(message_type, again)) != again:
        raise AssertionError(f"{message_type}: {again.hex()} is not what it is decoded to")
    return message


def cdr_seeds() -> list[bytes]:
    """Return a message of each type."""
    seeds = {type(each.message): cdr_input(type(each.message), each.data) for each in all_samples()}
    return list(seeds.values())


# What comes over Zenoh


def run_attachment(data: bytes) -> object:
    """Read what goes with a message."""
    return attachment.unpack(data)


def run_keys(data: bytes) -> object:
    """Read the key of a message, and what a context announces."""
    text = text_of(data)
    return parse_data_key(text), Advertisement.parse(text)


def run_tokens(data: bytes) -> object:
    """Read a liveliness token."""
    text = text_of(data)
    return parse_token(text), parse_qos(text)


def run_errors(data: bytes) -> object:
    """Read the error with which a service answers; it can be printed."""
    return str(parse_error(data, "/add")).encode()


HASH: Final = "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"
TYPE: Final = "std_msgs::msg::dds_::String_"
TOKEN: Final = f"@ros2_lv/0/8b2/0/10/MP/%/%/talker/%chatter/{TYPE}/{HASH}/"


# The link


def run_frames(data: bytes) -> object:
    """Take a stream apart, in pieces whose length the first byte says."""
    parser = FrameParser()
    step = data[0] + 1 if data else 1
    frames: list[Frame] = []
    try:
        for at in range(1, len(data), step):
            frames += parser.feed(data[at : at + step])
            if parser.missing < 1:
                raise AssertionError(f"{parser.missing} bytes are missing")
        return [BufferRef.unpack(each.payload) for each in frames if each.in_shm]
    except FrameError as error:
        return str(error)


def frame_seeds() -> list[bytes]:
    """Return a stream of frames of every kind."""
    gid = bytes(range(16))
    place = BufferRef(7, 20, 200_000).pack()
    one = b"".join(
        protocol.pack(kind, 1, 2, gid, place, in_shm=True)
        if kind == Kind.DATA
        else protocol.pack(kind, 1, 2, gid, b"payload")
        for kind in Kind
    )
    return [
        b"\xff" + one,
        b"\x06" + one,
        b"\x28" + protocol.has_fd(protocol.pack(8, 1, 2, gid, place)),
    ]


# What users write


def run_idl(data: bytes) -> object:
    """Make a class of a definition; the first byte says of which kind."""
    kind = ("msg", "srv", "action")[data[0] % 3 if data else 0]
    try:
        return define(f"fuzz/{kind}/Words", text_of(data[1:]))
    except IdlError as error:
        return str(error)


def run_arguments(data: bytes) -> object:
    """Read the words of a command line, which NUL separates; files are made of their names."""
    words = text_of(data).split("\0")
    try:
        arguments = parse_arguments(words, read_file=lambda path: parse_parameter_yaml(path, path))
    except InvalidROSArgsError as error:
        return str(error)
    if list(arguments.non_ros_args) != remove_ros_args(words):
        raise AssertionError(f"{words}: {arguments.non_ros_args} are the program's own")
    with suppress(NameValidationException):  # what a rule makes of a name
        resolve("scan", "driver", "/robot", arguments.remap_rules)
    return arguments.parameters_for("/robot/driver")


def run_parameters(data: bytes) -> object:
    """Read a parameter file, and a value."""
    text = text_of(data)
    results: list[object] = []
    for parse in (parse_parameter_yaml, parse_value):
        try:
            parsed: Any = parse(text)
        except ParameterFileError as error:
            parsed = str(error)
        results.append(parsed)
    for rule in results[0] if isinstance(results[0], tuple) else ():
        rule.matches("/robot/driver")
    return results


VARIABLES: Final = (
    "ROS_DOMAIN_ID",
    "ROS_AUTOMATIC_DISCOVERY_RANGE",
    "ROS_STATIC_PEERS",
    "ZENOH_CONFIG_OVERRIDE",
    "AIONODE_MEETING_PORTS",
    "AIONODE_ROUTER_PORT",
)


def run_environment(data: bytes) -> object:
    """Read the variables of an environment, which NUL separates."""
    environ = dict(zip(VARIABLES, text_of(data).split("\0"), strict=False))
    try:
        return network_from(environ)
    except ConfigurationError as error:
        return str(error)


TARGETS: Final = {
    target.name: target
    for target in (
        Target("cdr", run_cdr, cdr_seeds, overhead=3000),
        Target(
            "attachment",
            run_attachment,
            lambda: [
                attachment.pack(1, 2, bytes(range(16))),
                b"\x0fsequence_number"
                + bytes(8)
                + b"\x10source_timestamp"
                + bytes(8)
                + b"\x0asource_gid\x10"
                + bytes(16),
            ],
        ),
        Target(
            "keys",
            run_keys,
            lambda: [f"0/robot/chatter/{TYPE}/{HASH}".encode(), b"a1b2/link/1/0f0f/1000"],
            words=("/", TYPE, "dds_::", "_buf_cpu", "link", "*", "%"),
        ),
        Target(
            "tokens",
            run_tokens,
            lambda: [
                b"@ros2_lv/0/8b2/0/0/NN/%/%/talker",
                f"{TOKEN}::,7:,:,:,,".encode(),
                f"{TOKEN}2:1:2,5:1,500000000:2,0:3,3,0/backends:cpu:".encode(),
                b"::,10:,:,:,,",
            ],
            words=("@ros2_lv", "NN", "MP", "MS", "SS", "SC", "%", "/", ":", ",", TYPE),
        ),
        Target(
            "errors",
            run_errors,
            lambda: [error_payload("ValueError", "why"), error_payload("Värde", "\U0001f600 \0")],
            words=('"type"', '"text"', "[", "{", "\\u"),
        ),
        Target("frames", run_frames, frame_seeds),
        Target(
            "idl",
            run_idl,
            lambda: [
                b"\0# Words.\nint32 LIMIT=5\nstring<=10[<=3] names ['a', \"b\"]\nfloat64[9] x\n",
                b"\1geometry_msgs/Point[] points\n---\nbool ok true\nstring why 'it\\'s \\x41'\n",
                b'\0string x "\\U0001F600"\nint8[12] y\nstring<=12 z\n',
                b"\2int32 order\n---\nint32[] sequence [1, 2]\n---\nbyte[<=2] part\n",
            ],
            overhead=20_000,
            words=("int32", "string", "<=", "[", "]", "---", "=", "#", "'", '"', "\\u", "\\U"),
        ),
        Target(
            "arguments",
            run_arguments,
            lambda: [
                b"robot.py\0--ros-args\0-r\0chatter:=/talk\0-p\0driver:rate:=10.0\0--\0--verbose",
                b"--ros-args\0--params-file\0/**: {ros__parameters: {rate: 1}}\0-e\0/a",
                b"--ros-args\0--log-level\0robot:=debug\0--disable-rosout-logs\0__ns:=/x",
                b"--ros-args\0-r\0/**/a*:=/\\2b\0-r\0rosservice://~/x:=y",
            ],
            overhead=5000,
            words=("--ros-args", "--", "-r", "-p", ":=", "~/", "/**", "/*", "\\1", "__node", "\0"),
        ),
        Target(
            "parameters",
            run_parameters,
            lambda: [
                b"/robot/driver:\n  ros__parameters:\n    rate: 10.0\n    names: [a, 'b']\n",
                b"/**: {ros__parameters: {a: {b: 0x1F, c: 1e3, d: !!str 5}}}\n---\n",
                b"[1, 2, 3]",
            ],
            overhead=5000,
            words=("ros__parameters", ": ", "- ", "{", "}", "[", "]", "/**", "!!str", "&a", "*a"),
        ),
        Target(
            "environment",
            run_environment,
            lambda: [
                b"7\0SUBNET\0robot.local;tcp/10.0.0.7:7447;[::1]:7447\0a/b=1;c=[2]\0"
                b"18449,18450\0" + b"7447",
            ],
            overhead=5000,
            words=("SUBNET", "OFF", "tcp/", "[::1]", ";", "=", ",", "\0"),
        ),
        Target("mcap", files.run_mcap, files.mcap_seeds, overhead=200_000),
        Target("sqlite3", files.run_sqlite, files.sqlite_seeds, overhead=200_000),
        Target("zstd", files.run_zstd, files.zstd_seeds, overhead=200_000),
        Target(
            "metadata",
            files.run_metadata,
            files.metadata_seeds,
            overhead=20_000,
            words=(
                ": ",
                "- ",
                "{",
                "}",
                "[",
                "]",
                "!!int",
                "!!binary",
                "&a ",
                "*a",
                "<<: *a",
                "9" * 20,
            ),
        ),
        Target(
            "definitions",
            files.run_definition,
            files.definition_seeds,
            overhead=20_000,
            words=(
                "=" * 80,
                "MSG: ",
                "IDL: ",
                "fuzz/Inner",
                "int32",
                "[",
                "]",
                "<=",
                "module ",
                "{",
            ),
        ),
        Target(
            "idl_files",
            files.run_idl_file,
            files.idl_seeds,
            overhead=20_000,
            words=(
                "module ",
                "struct ",
                "sequence<",
                ">",
                "{",
                "};",
                "@default (value=",
                "<<",
                "/*",
            ),
        ),
        Target(
            "launch_xml",
            files.run_launch_xml,
            files.launch_xml_seeds,
            overhead=5000,
            words=("<node ", "<group>", "<arg ", "/>", "$(", ")", "&#0;", "<!DOCTYPE", "if=", "'"),
        ),
        Target(
            "launch_yaml",
            files.run_launch_yaml,
            files.launch_yaml_seeds,
            overhead=20_000,
            words=(
                "- node: ",
                "- group:",
                "$(",
                ")",
                "{",
                "}",
                "[",
                "]",
                "&a ",
                "*a",
                "!!int ",
                "? ",
            ),
        ),
        Target(
            "policy",
            files.run_policy,
            files.policy_seeds,
            overhead=5000,
            words=("[[allow]]", "[[who]]", "= ", "'", "/**", "[", "{", "1e999", "nan", "9" * 30),
        ),
    )
}
"""Each target by its name."""
