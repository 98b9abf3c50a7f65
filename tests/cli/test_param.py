"""``aionode param``."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner
from hypothesis import given
from hypothesis import strategies as st

from aionode import Node, Parameter
from aionode.arguments import matching_parameters, read_parameter_file
from aionode.cli._nouns.param import (
    delete,
    describe,
    dump,
    get,
    like,
    list_parameters,
    load,
    param_command,
    set_parameters,
)
from aionode.cli._nouns.param.text import file_form, file_text
from aionode.errors import CommandError, ParameterFileError
from aionode.interfaces.rcl_interfaces.msg import (
    FloatingPointRange,
    ParameterDescriptor,
)


@pytest.fixture
async def owner(node_factory: Callable[..., Node]) -> Node:
    """A node with the parameters of the recorded session."""
    node = node_factory("param_node")
    node.declare_parameter("name", "bob")
    node.declare_parameter("speed", 1.5)
    return node


async def test_list_prints_names_indented(tool: Node, owner: Node, screen: Any) -> None:
    """The list of a single node omits its name."""
    await list_parameters(tool, "/param_node", output=screen.output)

    assert screen.text == "  name\n  speed\n  start_type_description_service\n  use_sim_time\n"


async def test_list_of_all_prints_the_nodes(
    tool: Node, owner: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """Nodes without parameter services are skipped, not waited for."""
    node_factory("add_server")
    node_factory("silent", start_parameter_services=False)

    await list_parameters(tool, output=screen.output)

    assert screen.text == (
        "/add_server:\n"
        "  start_type_description_service\n"
        "  use_sim_time\n"
        "/param_node:\n"
        "  name\n"
        "  speed\n"
        "  start_type_description_service\n"
        "  use_sim_time\n"
    )


async def test_several_values_are_printed_below_their_names(
    tool: Node, owner: Node, screen: Any
) -> None:
    """As in ros2 of Lyrical."""
    await get(tool, "/param_node", ["name", "speed"], output=screen.output)
    await get(tool, "/param_node", ["name", "speed"], hide_type=True, output=screen.output)

    assert screen.text == (
        "name:\n  String value is: bob\nspeed:\n  Double value is: 1.5\nname: bob\nspeed: 1.5\n"
    )


async def test_one_that_is_missing_among_several_is_named(
    tool: Node, owner: Node, screen: Any
) -> None:
    """ROS then returns none of them."""
    with pytest.raises(CommandError, match="no parameter 'sped'"):
        await get(tool, "/param_node", ["name", "sped"], output=screen.output)


async def test_a_parameter_is_asked_of_all_nodes_without_the_name_of_one(
    tool: Node, owner: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """Nodes that do not have it are left out, as in ros2 of Lyrical."""
    other = node_factory("other")
    other.declare_parameter("speed", 2)
    node_factory("silent", start_parameter_services=False)

    assert await get(tool, "speed", [], output=screen.output) == 0
    assert await get(tool, "name", [], hide_type=True, output=screen.output) == 0

    assert screen.text == (
        "/other:\n  Integer value is: 2\n/param_node:\n  Double value is: 1.5\n/param_node: bob\n"
    )


@pytest.mark.parametrize(
    ("name", "problem"),
    [("sped", "'sped' is set on none of 1 nodes"), ("/param_node", "'/param_node' is a node")],
)
async def test_a_single_name_that_no_node_knows_is_an_error(
    tool: Node, owner: Node, screen: Any, name: str, problem: str
) -> None:
    """It may have been meant as the name of a node."""
    with pytest.raises(CommandError, match=problem):
        await get(tool, name, [], output=screen.output)


async def test_several_parameters_are_set_one_by_one(tool: Node, owner: Node, screen: Any) -> None:
    """Each has its result, and the status is that of the worst."""
    pairs = [("name", "ann"), ("speed", "fast")]
    status = await set_parameters(tool, "/param_node", pairs, output=screen.output)

    assert status == 1
    assert "name: Set parameter successful" in screen.text
    assert "speed: Setting parameter failed" in screen.errors
    assert owner.get_parameter("name").value == "ann"


async def test_parameters_are_set_all_or_none_if_asked(
    tool: Node, owner: Node, screen: Any
) -> None:
    """With one result for all of them."""
    refused = [("name", "ann"), ("speed", "fast")]
    fitting = [("name", "eve"), ("speed", "2.5")]

    assert await set_parameters(tool, "/param_node", refused, atomic=True, output=screen.output)
    assert owner.get_parameter("name").value == "bob"
    assert not await set_parameters(tool, "/param_node", fitting, atomic=True, output=screen.output)

    assert "Setting parameters atomically failed" in screen.errors
    assert "Set parameters atomically successful" in screen.text
    assert owner.get_parameter("speed").value == 2.5


def test_a_parameter_without_a_value_is_an_error_of_usage() -> None:
    """The network is not queried before."""
    done = CliRunner().invoke(param_command, ["set", "/param_node", "name", "ann", "speed"])

    assert done.exit_code == 2
    assert "'speed' has no value" in done.output


async def test_list_can_be_narrowed(tool: Node, owner: Node, screen: Any) -> None:
    """By a regular expression, and with types."""
    await list_parameters(tool, "param_node", pattern="s.*ed$", types=True, output=screen.output)

    assert screen.text == "  speed (type: double)\n"


@pytest.mark.parametrize(
    ("name", "value", "shown"),
    [
        ("text", "bob", "String value is: bob"),
        ("switch", False, "Boolean value is: False"),
        ("number", 3, "Integer value is: 3"),
        ("speed2", 1.5, "Double value is: 1.5"),
        ("data", b"\x01\x02", "Byte values are: [b'\\x01', b'\\x02']"),
        ("switches", [True, False], "Boolean values are: [True, False]"),
        ("numbers", [1, 2], "Integer values are: [1, 2]"),
        ("speeds", [0.5], "Double values are: [0.5]"),
        ("texts", ["a", "b"], "String values are: ['a', 'b']"),
    ],
)
async def test_get_prints_type_and_value(
    name: str, value: Any, shown: str, tool: Node, owner: Node, screen: Any
) -> None:
    """In ros2's words."""
    owner.declare_parameter(name, value)

    await get(tool, "/param_node", [name], output=screen.output)

    assert screen.text == f"{shown}\n"


async def test_get_can_print_the_value_alone(tool: Node, owner: Node, screen: Any) -> None:
    """For shell variables; programs have --json."""
    await get(tool, "/param_node", ["name"], hide_type=True, output=screen.output)
    await get(tool, "/param_node", ["speed"], output=screen.json_output)

    assert screen.text == (
        'bob\n{"node":"/param_node","name":"speed","type":"double","value":1.5}\n'
    )


@pytest.mark.parametrize(
    ("name", "text", "value"),
    [("speed", "2.5", 2.5), ("name", "alice", "alice"), ("name", "'5'", "5")],
)
async def test_set_says_that_it_is_done(
    name: str, text: str, value: Any, tool: Node, owner: Node, screen: Any
) -> None:
    """The value is YAML, so a string that looks like a number needs quotes."""
    status = await set_parameters(tool, "/param_node", [(name, text)], output=screen.output)

    assert status == 0
    assert screen.text == "Set parameter successful\n"
    assert owner.get_parameter(name).value == value


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("[x, y]", ["x", "y"]),
        ("[1_000, 2]", [1000, 2]),
        ("1_000", 1000),
        ("1:30", 90),
        ("1e3", "1e3"),
        ("y", "y"),
        ("[1, 2.0]", "[1, 2.0]"),
        ("2026-11-23", "2026-11-23"),
        ("null", "null"),
        ("[]", []),
        (str(2**63), str(2**63)),
        (f"[{2**63}]", f"[{2**63}]"),
    ],
)
async def test_set_reads_values_as_ros2_does(
    text: str, value: Any, tool: Node, owner: Node, screen: Any
) -> None:
    """With PyYAML; the rules of parameter files are those of rcl, where ``y`` is a bool."""
    owner.declare_parameter("any", None, ParameterDescriptor(dynamic_typing=True))

    await set_parameters(tool, "/param_node", [("any", text)], output=screen.output)

    assert owner.get_parameter("any").value == value


async def test_set_refuses_a_mapping(tool: Node, owner: Node, screen: Any) -> None:
    """No parameter holds one; ros2 ends with a traceback."""
    with pytest.raises(CommandError, match=r"value '\{a: 1\}': a mapping"):
        await set_parameters(tool, "/param_node", [("name", "{a: 1}")], output=screen.output)


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("name", "Wrong parameter type, expected 'Type.STRING' got 'Type.INTEGER'"),
        ("nope", "Invalid access to undeclared parameter(s): ['nope']"),
    ],
)
async def test_a_failed_set_is_an_error(
    name: str, reason: str, tool: Node, owner: Node, screen: Any
) -> None:
    """ros2 returns 0 here, so that scripts continue with the old value."""
    status = await set_parameters(tool, "/param_node", [(name, "5")], output=screen.output)

    assert status == 1
    assert screen.text == ""
    assert screen.errors == f"Setting parameter failed: {reason}\n"


async def test_malformed_yaml_is_no_string(tool: Node, owner: Node, screen: Any) -> None:
    """Otherwise text with an unclosed bracket would be stored as a string."""
    with pytest.raises(CommandError, match=r"value '\[1, 2'.*not YAML"):
        await set_parameters(tool, "/param_node", [("name", "[1, 2")], output=screen.output)


async def test_an_undeclared_parameter_is_named(tool: Node, owner: Node, screen: Any) -> None:
    """ros2 says only that it is not set."""
    with pytest.raises(
        CommandError, match=r"Parameter not set: no parameter 'sped'\. Did you mean"
    ):
        await get(tool, "/param_node", ["sped"], output=screen.output)
    with pytest.raises(CommandError, match="no parameter 'nope'"):
        await describe(tool, "/param_node", ["name", "nope"], output=screen.output)


async def test_an_unknown_node_is_named(tool: Node, owner: Node, screen: Any) -> None:
    """After the timeout."""
    with pytest.raises(CommandError, match=r"Node not found: '/param_nod'\. Did you mean"):
        await get(tool, "param_nod", ["name"], timeout=0.001, output=screen.output)


async def test_a_node_without_parameters_is_reported(
    tool: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """The command does not wait forever."""
    node_factory("silent", start_parameter_services=False)

    with pytest.raises(CommandError, match="Node '/silent' has no parameter services"):
        await get(tool, "/silent", ["name"], timeout=0.001, output=screen.output)


async def test_describe_prints_constraints(tool: Node, owner: Node, screen: Any) -> None:
    """Type, text, range and step."""
    owner.declare_parameter(
        "gain",
        0.5,
        ParameterDescriptor(
            description="How much",
            read_only=True,
            floating_point_range=[FloatingPointRange(from_value=0.0, to_value=1.0, step=0.5)],
        ),
    )

    await describe(tool, "/param_node", ["name", "gain"], output=screen.output)

    assert screen.text == (
        "Parameter name: name\n"
        "  Type: string\n"
        "  Constraints:\n"
        "Parameter name: gain\n"
        "  Type: double\n"
        "  Description: How much\n"
        "  Constraints:\n"
        "    Read only: true\n"
        "    Min value: 0.0\n"
        "    Max value: 1.0\n"
        "    Step: 0.5\n"
    )


async def test_dump_prints_a_parameter_file(tool: Node, owner: Node, screen: Any) -> None:
    """Sorted, nested names below each other, as ros2 does."""
    owner.declare_parameter("camera.frame", "front")

    await dump(tool, "/param_node", output=screen.output)

    assert screen.text == (
        "/param_node:\n"
        "  ros__parameters:\n"
        "    camera:\n"
        "      frame: front\n"
        "    name: bob\n"
        "    speed: 1.5\n"
        "    start_type_description_service: true\n"
        "    use_sim_time: false\n"
        "\n"
    )


async def test_dump_prints_the_lines_of_ros2(tool: Node, owner: Node, screen: Any) -> None:
    """Long strings are folded, other scripts escaped, bytes in Base64: PyYAML's defaults."""
    owner.set_parameters([Parameter("name", value="word " * 20 + "é")])
    owner.declare_parameter("data", b"\x01\xff")

    await dump(tool, "/param_node", output=screen.output)

    assert screen.text.startswith(
        "/param_node:\n"
        "  ros__parameters:\n"
        "    data:\n"
        "    - !!binary |\n"
        "      AQ==\n"
        "    - !!binary |\n"
        "      /w==\n"
        '    name: "word word word word word word word word word word word word word word word\\\n'
        '      \\ word word word word word \\xE9"\n'
    )


async def test_bytes_are_numbers_in_records(tool: Node, owner: Node, screen: Any) -> None:
    """JSON has no bytes."""
    owner.declare_parameter("data", b"\x01\xff")

    await get(tool, "/param_node", ["data"], output=screen.json_output)
    await dump(tool, "/param_node", output=screen.json_output)

    assert screen.records[0]["value"] == [1, 255]
    assert screen.records[1]["/param_node"]["ros__parameters"]["data"] == [1, 255]


async def test_what_dump_prints_load_reads(
    tool: Node, owner: Node, tmp_path: Path, screen: Any
) -> None:
    """A dumped file can be loaded; wildcards are used unless excluded."""
    file = tmp_path / "values.yaml"
    file.write_text(
        "/**:\n  ros__parameters:\n    name: alice\n"
        "/param_node:\n  ros__parameters:\n    speed: 3.0\n"
    )

    status = await load(tool, "/param_node", file, output=screen.output)

    assert status == 0
    assert screen.text == "Set parameter name successful\nSet parameter speed successful\n"
    assert owner.get_parameter("name").value == "alice"

    owner.set_parameters([type(owner.get_parameter("name"))("name", value="bob")])
    await load(tool, "/param_node", file, wildcards=False, output=screen.output)
    assert owner.get_parameter("name").value == "bob"


async def test_a_dump_is_loaded_as_it_is(
    tool: Node, owner: Node, tmp_path: Path, screen: Any
) -> None:
    """Read-only parameters and types that YAML lacks survive the round trip."""
    file = tmp_path / "values.yaml"
    values = {
        "data": b"\x01\xff",
        "no_data": b"",
        "camera.frame": "front",
        "camera.gain.red": 1e30,
        "texts": ["1", "true", "a\nb", "~"],
        "no_texts": [],
    }
    for name, value in values.items():
        type_ = Parameter.Type.STRING_ARRAY if value == [] else None
        owner.declare_parameter(name, type_ or value)
    owner.set_parameters([Parameter("no_texts", Parameter.Type.STRING_ARRAY, [])])
    before = file_form(owner.get_parameters(list(values)))
    await dump(tool, "/param_node", output=screen.output)
    file.write_text(screen.text)

    status = await load(tool, "/param_node", file, output=screen.output)

    assert screen.errors == ""
    assert status == 0
    assert "start_type_description_service successful: it already has this value" in screen.text
    assert file_form(owner.get_parameters(list(values))) == before


PLAIN = (
    st.booleans()
    | st.integers(-(2**63), 2**63 - 1)
    | st.floats(allow_nan=False)
    | st.text(st.characters(exclude_categories=["Cs"], exclude_characters="\0"))
)
VALUES = (
    PLAIN
    | st.binary(max_size=5)
    | st.lists(st.booleans(), max_size=3)
    | st.lists(st.integers(-(2**63), 2**63 - 1), min_size=1, max_size=3)
    | st.lists(st.floats(allow_nan=False), min_size=1, max_size=3)
    | st.lists(st.text(st.characters(exclude_categories=["Cs"])), min_size=1, max_size=3)
)
NAMES = st.from_regex(r"[a-z][a-z_0-9]{0,3}(\.[a-z][a-z_0-9]{0,3}){0,2}", fullmatch=True)


@given(st.dictionaries(NAMES, VALUES, max_size=5))
def test_every_value_goes_through_a_parameter_file(values: dict[str, Any]) -> None:
    """`load` reads every value as `dump` wrote it."""
    before = {name: Parameter(name, value=value) for name, value in values.items()}
    text = file_text({"/node": {"ros__parameters": file_form(before.values())}})

    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "values.yaml"
        file.write_text(text)
        loaded = matching_parameters(read_parameter_file(file), "/node")

    after = [like(before[name], name, value) for name, value in loaded.items()]
    assert [parameter.to_parameter_msg() for parameter in after] == [
        before[parameter.name].to_parameter_msg() for parameter in after
    ]
    assert len(after) == len(before)


async def test_load_says_what_failed(tool: Node, owner: Node, tmp_path: Path, screen: Any) -> None:
    """One line for each parameter, and one status for all."""
    file = tmp_path / "values.yaml"
    file.write_text("/param_node:\n  ros__parameters:\n    name: 5\n    speed: 3.0\n")

    status = await load(tool, "/param_node", file, output=screen.output)

    assert status == 1
    assert screen.text == "Set parameter speed successful\n"
    assert screen.errors.startswith("Set parameter name failed: Wrong parameter type")


async def test_load_of_a_file_for_others_is_an_error(
    tool: Node, owner: Node, tmp_path: Path, screen: Any
) -> None:
    """Setting nothing is a mistake, not a success."""
    file = tmp_path / "values.yaml"
    file.write_text("/other:\n  ros__parameters:\n    name: a\n")

    with pytest.raises(ParameterFileError, match="no parameters for /param_node, only for /other"):
        await load(tool, "/param_node", file, output=screen.output)
    with pytest.raises(ParameterFileError, match="cannot be read"):
        await load(tool, "/param_node", tmp_path / "nope.yaml", output=screen.output)


async def test_delete_undeclares_a_dynamic_parameter(tool: Node, owner: Node, screen: Any) -> None:
    """A static one stays, and the status says so."""
    owner.declare_parameter("extra", 1, ParameterDescriptor(dynamic_typing=True))

    gone = await delete(tool, "/param_node", "extra", output=screen.output)
    kept = await delete(tool, "/param_node", "name", output=screen.output)

    assert (gone, kept) == (0, 1)
    assert screen.text == "Deleted parameter successfully\n"
    assert screen.errors.startswith("Deleting parameter failed: ")
    assert not owner.has_parameter("extra")
