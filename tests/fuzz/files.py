"""The parsers of files: bags of each storage, definitions in them, launch files, policies, IDL."""

from __future__ import annotations

import os
import sqlite3
import tempfile
from collections.abc import Callable
from contextlib import closing
from functools import cache
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Final

from mcap.writer import CompressionType, IndexType
from mcap.writer import Writer as McapWriter

from aionode import bag
from aionode.bag.files.qos import qos_overrides
from aionode.bag.yaml_files import inputs_in, outputs_in, static_topics_in
from aionode.engine.wire import cdr
from aionode.errors import (
    BagError,
    DecodeError,
    IdlError,
    InterfaceNotFoundError,
    LaunchFileError,
    PolicyFileError,
)
from aionode.gateway import Policy
from aionode.idl import define
from aionode.interfaces.std_msgs.msg import String
from aionode.launch._markup import read_xml, read_yaml
from aionode.rclpy import install

__all__ = [
    "definition_seeds",
    "idl_seeds",
    "launch_xml_seeds",
    "launch_yaml_seeds",
    "mcap_seeds",
    "metadata_seeds",
    "policy_seeds",
    "run_definition",
    "run_idl_file",
    "run_launch_xml",
    "run_launch_yaml",
    "run_mcap",
    "run_metadata",
    "run_policy",
    "run_sqlite",
    "run_zstd",
    "sqlite_seeds",
    "zstd_seeds",
]

WORDS: Final = ("a", "b", "c")
QOS: Final = "- {history: 1, depth: 4, reliability: 1, durability: 2, deadline: {sec: 1, nsec: 0}}"
TYPE: Final = "std_msgs/msg/String"


@cache
def folder() -> Path:
    """Return a folder for files, which is left to the system."""
    return Path(tempfile.mkdtemp(prefix="aionode-fuzz-"))


def run_bag(path: Path) -> object:
    """Read all of a bag, and what it says of itself."""
    try:
        opened = bag.open(path)
    except BagError as error:
        return str(error)
    heard: list[object] = []
    with opened:
        heard += [opened.start, opened.end, opened.duration, opened.losses, opened.files]
        try:
            for record in opened.read():
                heard += [record.time, record.publish_time, decoded(record)]
        except BagError as error:
            heard.append(str(error))
    return heard


def decoded(record: bag.Record) -> object:
    """Return a message, or why it is none."""
    try:
        return record.message
    except (DecodeError, InterfaceNotFoundError) as error:
        return str(error)


def run_file(name: str, data: bytes) -> object:
    """Read one file of a bag, then check it, and read what the check has made of it."""
    file = folder() / name
    file.write_bytes(data)
    os.utime(file, (1, 1))  # else another program may be recording it
    found = run_bag(file)
    try:
        bag.check(file)
    except BagError as error:
        return [found, str(error)]
    with bag.open(file) as opened:  # what a check calls sound can be read to its end
        return [found, [decoded(record) for record in opened.read()]]


def run_mcap(data: bytes) -> object:
    """Read an MCAP file."""
    return run_file("x.mcap", data)


def run_sqlite(data: bytes) -> object:
    """Read a database."""
    for ending in ("-wal", "-shm", "-journal"):
        (folder() / f"x.db3{ending}").unlink(missing_ok=True)
    return run_file("x.db3", data)


def run_zstd(data: bytes) -> object:
    """Read a compressed file."""
    file = folder() / "x.mcap.zstd"
    file.write_bytes(data)
    return run_bag(file)


def mcap_seeds() -> list[bytes]:
    """Return files with checksums and without, in chunks of each kind and without."""
    options = [
        {"compression": CompressionType.NONE, "enable_crcs": False},
        {"compression": CompressionType.NONE},
        {"compression": CompressionType.ZSTD, "enable_crcs": False},
        {"compression": CompressionType.LZ4, "enable_crcs": False},
        {"use_chunking": False, "index_types": IndexType.NONE, "enable_crcs": False},
    ]
    return [mcap_bytes(**each) for each in options]  # type: ignore[arg-type]


def mcap_bytes(**options: object) -> bytes:
    """Return an MCAP file of few messages in several chunks."""
    file = folder() / "seed"
    with file.open("wb") as stream:
        out = McapWriter(stream, chunk_size=64, **options)  # type: ignore[arg-type]
        out.start("ros2", "test")
        schema = out.register_schema(TYPE, "ros2msg", b"string data\n")
        other = out.register_schema("my/msg/Own", "ros2msg", b"float64 x\nint32[<=3] y\n")
        qos = {"offered_qos_profiles": QOS}
        words = out.register_channel("/words", "cdr", schema, metadata=qos)
        own = out.register_channel("/own", "cdr", other, metadata={})
        for at, word in enumerate(WORDS):
            raw = bytes(cdr.encode(String(data=word)))
            out.add_message(words, 10**18 + at, raw, 10**18 + at, sequence=at)
        out.add_message(own, 10**18, b"\0\1\0\0" + bytes(16), 10**18)
        out.finish()  # type: ignore[no-untyped-call]  # of the library
    return file.read_bytes()


def sqlite_seeds() -> list[bytes]:
    """Return small databases of the oldest and the newest version."""
    return [sqlite_bytes(is_new=is_new) for is_new in (False, True)]


def sqlite_bytes(*, is_new: bool) -> bytes:
    """Return a database."""
    file = folder() / "seed.db3"
    file.unlink(missing_ok=True)
    with closing(sqlite3.connect(file)) as base:
        base.execute("PRAGMA page_size = 512")
        new = ", offered_qos_profiles TEXT, type_description_hash TEXT" if is_new else ""
        base.execute(
            f"CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, "
            f"serialization_format TEXT{new})"
        )
        values = [1, "/words", TYPE, "cdr", *([QOS, ""] if is_new else [])]
        marks = ", ".join("?" * len(values))
        base.execute(f"INSERT INTO topics VALUES ({marks})", values)  # noqa: S608  # of marks
        if is_new:
            base.execute(
                "CREATE TABLE message_definitions(id INTEGER PRIMARY KEY, topic_type TEXT, "
                "encoding TEXT, encoded_message_definition TEXT, type_description_hash TEXT)"
            )
            base.execute(
                "INSERT INTO message_definitions VALUES (1, ?, 'ros2msg', 'string data', '')",
                (TYPE,),
            )
        base.execute(
            "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, "
            "timestamp INTEGER NOT NULL, data BLOB NOT NULL)"
        )
        base.execute("CREATE INDEX timestamp_idx ON messages (timestamp ASC)")
        for at, word in enumerate(WORDS):
            raw = bytes(cdr.encode(String(data=word)))
            base.execute("INSERT INTO messages VALUES (?, 1, ?, ?)", (at, 10**18 + at, raw))
        base.commit()
    return file.read_bytes()


def zstd_seeds() -> list[bytes]:
    """Return compressed MCAP files, of one frame and of two."""
    import zstandard

    whole = mcap_bytes(compression=CompressionType.NONE)
    half = len(whole) // 2
    parts = [zstandard.compress(part) for part in (whole[:half], whole[half:])]
    return [zstandard.compress(whole), b"".join(parts)]


# Metadata and other YAML of rosbag2


def run_metadata(data: bytes) -> object:
    """Open a folder whose ``metadata.yaml`` somebody has written, and read it as other files."""
    place = folder() / "run"
    place.mkdir(exist_ok=True)
    file = place / "run_0.mcap"
    if not file.exists():
        file.write_bytes(mcap_bytes(compression=CompressionType.NONE))
    (place / "metadata.yaml").write_bytes(data)
    results = [run_bag(place)]
    for read in READERS:
        try:
            results.append(read(str(place / "metadata.yaml")))
        except ValueError as error:
            results.append(str(error))
    return results


READERS: Final[tuple[Callable[[str], object], ...]] = (
    qos_overrides,
    static_topics_in,
    inputs_in,
    outputs_in,
)


def metadata_seeds() -> list[bytes]:
    """Return metadata of the newest and of an old version, and rosbag2's other files."""
    topic = f"{{name: /words, type: {TYPE}, serialization_format: cdr, offered_qos_profiles: "
    head = (
        "rosbag2_bagfile_information:\n  version: {version}\n  storage_identifier: mcap\n"
        "  relative_file_paths: [run_0.mcap]\n  message_count: 4\n"
        "  starting_time: {{nanoseconds_since_epoch: 1000000000000000000}}\n"
        "  duration: {{nanoseconds: 2}}\n  compression_format: ''\n  compression_mode: ''\n"
        "  custom_data: {{robot: r2}}\n  topics_with_message_count:\n"
    )
    new = f"  - topic_metadata: {topic}[{QOS[2:]}], type_description_hash: RIHS01_0}}\n"
    old = f"  - topic_metadata: {topic}'{QOS}'}}\n"
    count = "    message_count: 3\n"
    return [
        (head.format(version=9) + new + count).encode(),
        (head.format(version=4) + old + count).encode(),
        b"/words: {history: keep_last, depth: 3, deadline: {sec: 1, nsec: 2}}\n",
        b"static_topics_and_types_list: [[/a, std_msgs/msg/String], [b, c/d]]\n",
        b"input_bags: [{uri: a}]\noutput_bags: [{uri: b, all: true, regex: x, start_time_ns: 5}]\n",
    ]


# Definitions


def run_definition(data: bytes) -> object:
    """Make the class of a type whose definition is in a bag; the first byte says in which form."""
    encoding = ("ros2msg", "ros2idl")[data[0] % 2 if data else 0]
    text = data[1:].decode("utf-8", "replace")
    info = bag.TopicInfo(name="/x", type="fuzz/msg/Words", encoding=encoding, definition=text)
    try:
        return info.msg_type
    except InterfaceNotFoundError as error:
        return str(error)


def run_idl_file(data: bytes) -> object:
    """Make a class of an ``.idl`` file; the first byte says of which kind."""
    kind = ("msg", "srv", "action")[data[0] % 3 if data else 0]
    text = data[1:].decode("utf-8", "replace")
    try:
        return define(f"fuzz/{kind}/Words", text, encoding="ros2idl")
    except IdlError as error:
        return str(error)


IDL: Final = """#include "std_msgs/msg/Header.idl"
// Words.
module fuzz { module msg {
  module Words_Constants { const int32 LIMIT = 0x10; const string NAME = "a\\"b"; };
  typedef double double__9[9];
  @verbatim (language="comment", text="A text.")
  struct Words { sequence<string<5>, 3> names; double__9 x; @default (value=5) int8 y;
    wstring w; @unit("m") sequence<float> z; /* end */ };
}; };
"""


def idl_seeds() -> list[bytes]:
    """Return files of messages and of a service."""
    service = IDL.replace("module msg", "module srv")
    request = service.replace("struct Words", "struct Words_Request")
    response = "module fuzz { module srv { struct Words_Response { boolean ok; }; }; };"
    return [b"\0" + IDL.encode(), b"\1" + (request + response).encode()]


def definition_seeds() -> list[bytes]:
    """Return definitions in both forms, with types that they use."""
    nested = (
        "# Words\nstd_msgs/Header header\nInner[<=3] list\nfloat64 from 0.5\nint32 iTOW\n"
        + "=" * 80
        + "\nMSG: fuzz/Inner\nstring<=5 name 'x'\nint8 A=3\n"
        + "=" * 80
        + "\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n"
    )
    two = "=" * 80 + "\nIDL: fuzz/msg/Words\n" + IDL
    return [b"\0" + nested.encode(), b"\1" + two.encode()]


# Launch files and policies


@cache
def frontend() -> ModuleType:
    """Return the meaning of launch files, which is made of ROS's classes."""
    install()
    return import_module("aionode.launch._frontend")


def run_launch_xml(data: bytes) -> object:
    """Read a launch file in XML; nothing of it is evaluated."""
    try:
        return frontend().description_of("x.launch.xml", read_xml("x.launch.xml", data))
    except LaunchFileError as error:
        return str(error)


def run_launch_yaml(data: bytes) -> object:
    """Read a launch file in YAML; nothing of it is evaluated."""
    try:
        return frontend().description_of("x.launch.yaml", read_yaml("x.launch.yaml", data))
    except LaunchFileError as error:
        return str(error)


def launch_xml_seeds() -> list[bytes]:
    """Return a file with most elements."""
    text = (
        b'<launch><arg name="x" default="5"/><let name="y" value="$(eval \'$(var x) + 1\')"/>\n'
        b'<group if="$(equals $(var y) 6)"><push_ros_namespace namespace="r"/>\n'
        b'<node pkg="demo" exec="talker" name="t" args="--a \'$(var x) m\'" respawn="true">\n'
        b'<param name="a" value="1" type="str"/><param name="b"><param name="c" value="x"/></param>'
        b'<remap from="chatter" to="/c"/><env name="C" value="$(env HOME)"/></node></group>\n'
        b'<include file="$(dirname)/other.launch.xml"><arg name="z" value="1"/></include>\n'
        b'<timer period="2.0"><executable cmd="echo later"/></timer></launch>\n'
    )
    return [text]


def launch_yaml_seeds() -> list[bytes]:
    """Return a file with most elements."""
    text = (
        b"launch:\n- arg: {name: x, default: '5', description: d}\n"
        b"- let: {name: y, value: $(eval '$(var x) + 1')}\n- group:\n"
        b"  - push_ros_namespace: {namespace: robot}\n  - node:\n      pkg: demo\n"
        b"      exec: talker\n      args: --fast '$(var x) m'\n      if: $(equals $(var y) 6)\n"
        b"      param:\n      - {name: a, value: 1}\n      - name: b\n        param:\n"
        b"        - {name: c, value: x}\n      remap:\n      - {from: chatter, to: /c}\n"
        b"- include: {file: $(dirname)/a.launch.xml}\n- timer: {period: 2.0, children: []}\n"
    )
    return [text]


def run_policy(data: bytes) -> object:
    """Read a policy of the gateway."""
    try:
        return Policy.parse(data, "x.toml")
    except PolicyFileError as error:
        return str(error)


def policy_seeds() -> list[bytes]:
    """Return a policy with most keys."""
    text = (
        b"hosts = ['robot.local']\norigins = ['https://a.example']\naudit_file = 'audit.log'\n"
        b"[[who]]\nname = 'operator'\ngroups = ['team']\ntoken_sha256 = '" + b"0" * 64 + b"'\n"
        b"[[who]]\nname = 'local'\nloopback = true\n[[allow]]\nsee = '/**'\nsubscribe = '/**'\n"
        b"[[allow]]\npublish = '/cmd_vel'\nwho = ['team']\nlease = {ttl_sec = 0.5}\n"
        b"fields = {'linear.x' = [-0.5, 0.5]}\n[[refuse]]\ncall = '/*/set_*'\nbecause = 'no'\n"
        b"[limits]\nclients = 20\n"
    )
    return [text]
