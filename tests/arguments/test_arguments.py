"""The arguments of a ROS program, and parameter files."""

from __future__ import annotations

import math
from collections.abc import Iterable
from pathlib import Path

import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from msgspec.structs import replace

from aionode.arguments import (
    Arguments,
    ParameterRule,
    parse_arguments,
    parse_parameter_yaml,
    parse_scalar,
    parse_value,
    read_parameter_file,
    remove_ros_args,
)
from aionode.errors import InvalidROSArgsError, ParameterFileError, UnknownROSArgsError
from aionode.logging import LoggingSeverity


def parse(line: str, **files: str) -> Arguments:
    """Parse a command line; `files` are the existing parameter files, by stem."""

    def read(path: str) -> Iterable[ParameterRule]:
        return parse_parameter_yaml(files[Path(path).stem], path)

    return parse_arguments(line.split(), read_file=read)


# Blocks


def test_only_what_stands_in_a_block_is_read() -> None:
    """There may be several blocks, and the last one needs no `--`."""
    args = parse("prog -r x --ros-args -p a:=1 -- -p b:=2 --ros-args -p c:=3")

    assert [rule.name for rule in args.parameter_rules] == ["a", "c"]
    assert args.non_ros_args == ("prog", "-r", "x", "-p", "b:=2")


def test_a_second_start_inside_a_block_changes_nothing() -> None:
    """As in rcl."""
    args = parse("--ros-args -p a:=1 --ros-args -p b:=2 -- own")

    assert [rule.name for rule in args.parameter_rules] == ["a", "b"]
    assert args.non_ros_args == ("own",)


def test_no_arguments_say_nothing() -> None:
    """A program without arguments gets the defaults."""
    assert parse("") == Arguments() == parse("--ros-args")


def test_a_double_dash_outside_of_a_block_is_the_programs() -> None:
    """Outside a block it belongs to the program."""
    assert parse("-- a --ros-args").non_ros_args == ("--", "a")


@pytest.mark.parametrize(
    ("line", "own"),
    [
        ("p a --ros-args -r x:=y -- b", ["p", "a", "b"]),
        ("p --ros-args --unknown z", ["p"]),
        ("p x:=y 1:=2", ["p", "1:=2"]),
        ("", []),
    ],
)
def test_removing_ros_args_leaves_the_programs_own(line: str, own: list[str]) -> None:
    """For argparse and similar parsers; it never raises."""
    assert remove_ros_args(line.split()) == own


# Flags


@pytest.mark.parametrize("flag", ["-r", "--remap"])
def test_remap_rules_are_kept_in_order(flag: str) -> None:
    """The first that matches wins."""
    args = parse(f"--ros-args {flag} a:=b {flag} node:__ns:=/c")

    assert [str(rule) for rule in args.remap_rules] == ["a:=b", "node:__ns:=/c"]


def test_a_bare_remap_rule_outside_is_read_with_a_warning() -> None:
    """Deprecated, but old launch files have it."""
    args = parse("prog a:=b")

    assert [str(rule) for rule in args.remap_rules] == ["a:=b"]
    assert args.non_ros_args == ("prog",)
    (warning,) = args.warnings
    assert warning == (
        "Found remap rule 'a:=b'. This syntax is deprecated. Use '--ros-args --remap a:=b' instead."
    )


@pytest.mark.parametrize(
    ("flag", "rule"),
    [
        ("-p mode:=server", ParameterRule("/**", "mode", "server")),
        ("--param a.b:=[1,2]", ParameterRule("/**", "a.b", [1, 2])),
        ("-p node:a:=1", ParameterRule("/**/node", "a", 1)),
        ("-p /ns/node:a:=1", ParameterRule("/ns/node", "a", 1)),
        (
            "-p qos_overrides./chatter.publisher.depth:=5",
            ParameterRule("/**", "qos_overrides./chatter.publisher.depth", 5),
        ),
        ("-p text:=a:b:=c", ParameterRule("/**", "text", "a:b:=c")),
        ("-p empty:=''", ParameterRule("/**", "empty", "")),
    ],
)
def test_a_parameter_has_a_name_a_value_and_maybe_a_node(flag: str, rule: ParameterRule) -> None:
    """The value is YAML."""
    (parsed,) = parse(f"--ros-args {flag}").parameter_rules

    assert parsed == replace(rule, typed=flag.split()[1])


def test_a_log_level_is_for_all_or_for_one_logger_and_the_last_wins() -> None:
    """In upper or lower case."""
    args = parse(
        "--ros-args --log-level INFO --log-level a.b:=warn --log-level a.b:=Error --log-level debug"
    )

    assert args.log_level is LoggingSeverity.DEBUG
    assert args.log_levels == {"a.b": LoggingSeverity.ERROR}


def test_the_remaining_flags_take_their_word_as_it_is() -> None:
    """The last one wins."""
    args = parse(
        "--ros-args --log-config-file c --log-file-name x --log-file-name y -e /a --enclave /b"
    )

    assert (args.log_config_file, args.log_file_name, args.enclave) == ("c", "y", "/b")


def test_logs_are_switched_on_and_off() -> None:
    """All logs are on by default, and the last flag wins."""
    args = parse(
        "--ros-args --disable-stdout-logs --disable-rosout-logs --enable-rosout-logs "
        "--disable-external-lib-logs"
    )

    assert (args.stdout_logs, args.rosout_logs, args.external_lib_logs) == (False, True, False)


@pytest.mark.parametrize(
    ("flags", "prefix"),
    [
        ("", None),
        ("--log-file-name robot", "robot"),
        ("--enable-external-lib-logs", "prog.py"),
        ("--enable-external-lib-logs --log-file-name robot", "robot"),
        ("--log-file-name robot --disable-external-lib-logs", None),
    ],
)
def test_a_log_file_is_written_only_when_asked_for(flags: str, prefix: str | None) -> None:
    """ROS always writes one, but a robot's disk is small."""
    assert parse(f"/bin/prog.py --ros-args {flags}").log_file_prefix() == prefix


# Errors


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("-r", "'-r': no value follows; it needs a rule 'from:=to'"),
        ("-p --", "'-p': no value follows; it needs a parameter"),
        ("--params-file", "'--params-file': no value follows; it needs the path"),
        ("-r foo", "'-r foo': no ':='; a rule is 'from:=to'"),
        ("-r a:=*", "'-r a:=*': '*' is not a name"),
        ("-p foo", "'-p foo': a parameter is 'name:=value' or 'node:name:=value'"),
        ("-p :=1", "'-p :=1': a parameter is"),
        ("-p a:=", "'-p a:=': no value; for an empty string write ''"),
        ("-p a:=[1,b]", "'-p a:=[1,b]': Sequence should be of same type"),
        ("-p a:={b:1}", "'-p a:={b:1}': a mapping where a scalar was expected"),
        ("-p a:=[", "'-p a:=[': not YAML"),
        ("--log-level loud", "'--log-level loud': unknown log level 'loud'; valid levels"),
        ("--log-level :=info", "the name of the logger is empty"),
        ("--params-file missing", "'--params-file missing': cannot be read: No such file"),
    ],
)
def test_a_value_that_cannot_be_read_is_shown_with_what_fits(line: str, says: str) -> None:
    """The error shows the word at fault."""
    with pytest.raises(InvalidROSArgsError) as info:
        parse_arguments(["prog", "--ros-args", *line.split()])

    assert says in str(info.value)
    assert info.value.argument in line


def test_an_error_in_a_file_has_its_line() -> None:
    """The error also has the path of the file."""
    with pytest.raises(InvalidROSArgsError, match=r"--params-file f\.yaml': line 3: no value"):
        parse("--ros-args --params-file f.yaml", f="node:\n  ros__parameters:\n    a:\n")


def test_an_unknown_flag_is_kept_for_the_caller_to_judge() -> None:
    """rcl leaves it as unparsed; rclpy refuses it."""  # noqa: D403
    args = parse("--ros-args --remapp a:=b -p c:=1")

    assert args.unparsed_ros_args == ("--remapp", "a:=b")
    with pytest.raises(UnknownROSArgsError, match="'--remapp a:=b': unknown; did you mean --remap"):
        args.refuse_unknown()
    Arguments().refuse_unknown()


# Parameters: order and wildcards


ORDER = """
/**:
  node2:
    ros__parameters: {a_value: first, foo: foo}
/ns:
  node2:
    ros__parameters: {a_value: second, bar: bar}
/*:
  node2:
    ros__parameters: {a_value: last_one_win}
"""


def test_the_last_match_wins_however_exact_the_others_are() -> None:
    """As rclpy's params_by_order.yaml shows."""
    args = parse("--ros-args --params-file f.yaml", f=ORDER)

    assert args.parameters_for("/ns/node2") == {
        "a_value": "last_one_win",
        "foo": "foo",
        "bar": "bar",
    }


def test_files_and_rules_apply_in_the_order_of_the_command_line() -> None:
    """A rule after a file beats the file; a file after a rule beats the rule."""
    line = "--ros-args -p a:=rule -p b:=rule --params-file f.yaml -p c:=rule"
    text = "/**: {ros__parameters: {b: file, c: file}}"

    assert parse(line, f=text).parameters_for("/n") == {"a": "rule", "b": "file", "c": "rule"}


def test_a_rule_for_one_node_is_not_for_others() -> None:
    """Several nodes of a process share the command line."""
    args = parse("--ros-args -p a:=1 -p talker:a:=2")

    assert args.parameters_for("/ns/talker") == {"a": 2}
    assert args.parameters_for("/listener") == {"a": 1}


@pytest.mark.parametrize(
    ("key", "matching", "other"),
    [
        ("/**", ["/n", "/a/n", "/a/b/n"], []),
        ("/*", ["/n"], ["/a/n"]),
        ("/**/n", ["/n", "/a/n", "/a/b/n"], ["/a/m", "/n/m"]),
        ("/*/n", ["/a/n"], ["/n", "/a/b/n"]),
        ("/a/**", ["/a/n", "/a/b/n"], ["/b/n"]),
        ("/a/*", ["/a/n"], ["/a/b/n", "/a"]),
        ("/a/**/n", ["/a/n", "/a/b/n", "/a/b/c/n"], ["/n"]),
        ("/a/*/n", ["/a/b/n"], ["/a/n", "/a/b/c/n"]),
        ("/**/foo/*/bar/n", ["/a/b/c/foo/d/bar/n", "/foo/d/bar/n"], ["/foo/bar/n"]),
        ("n", ["/n"], ["/a/n"]),
        ("a/n", ["/a/n"], ["/n"]),
    ],
)
def test_wildcards_of_a_file_match_as_in_rcl(
    key: str, matching: list[str], other: list[str]
) -> None:
    """`*` is one token, `**` any number."""
    rules = parse_parameter_yaml(f'"{key}": {{ros__parameters: {{x: 1}}}}')

    assert all(rules[0].matches(name) for name in matching)
    assert not any(rules[0].matches(name) for name in other)


WILDCARDS = """
/**:
  ros__parameters: {full_wild: full_wild}
/**/node2:
  ros__parameters: {namespace_wild_another: namespace_wild_another}
/*:
  node2:
    ros__parameters: {namespace_wild_one_star: namespace_wild_one_star}
ns:
  "*":
    ros__parameters: {node_wild_in_ns: node_wild_in_ns}
/ns/*:
  ros__parameters: {node_wild_in_ns_another: node_wild_in_ns_another}
"*":
  ros__parameters: {node_wild_no_ns: node_wild_no_ns}
node2:
  ros__parameters: {explicit_no_ns: explicit_no_ns}
/:
  node2:
    ros__parameters: {root_ns: root_ns}
nsX:
  node2:
    ros__parameters: {should_not_appear: incorrect_namespace}
"""


@pytest.mark.parametrize(
    ("node", "names"),
    [
        (
            "/ns/node2",
            {
                "full_wild",
                "namespace_wild_another",
                "namespace_wild_one_star",
                "node_wild_in_ns",
                "node_wild_in_ns_another",
            },
        ),
        (
            "/node2",
            {"full_wild", "namespace_wild_another", "node_wild_no_ns", "explicit_no_ns", "root_ns"},
        ),
    ],
)
def test_a_nodes_name_may_be_spread_over_keys(node: str, names: set[str]) -> None:
    """As rclpy's wildcards.yaml shows."""
    args = parse("--ros-args --params-file f.yaml", f=WILDCARDS)

    assert set(args.parameters_for(node)) == names


@pytest.mark.parametrize("key", ["/foo**", "/**foo", "/f*oo", "/**/n**ode", "/a//n", "/a/", "/1a"])
def test_a_key_that_is_no_nodes_name_is_refused(key: str) -> None:
    """A wildcard must be a whole token."""
    with pytest.raises(ParameterFileError, match=r"token|slashes"):
        parse_parameter_yaml(f'"{key}": {{ros__parameters: {{x: 1}}}}')


# Parameters: values


@pytest.mark.parametrize(
    ("text", "value"),
    [
        *((word, True) for word in ("true", "True", "TRUE", "yes", "Y", "on", "ON")),
        *((word, False) for word in ("false", "False", "FALSE", "no", "n", "off", "Off")),
        ("tRue", "tRue"),
        ("1", 1),
        ("-7", -7),
        ("+7", 7),
        ("0x1F", 31),
        ("-0x10", -16),
        ("010", 8),
        ("08", 8.0),
        ("9223372036854775807", 2**63 - 1),
        ("9223372036854775808", 2.0**63),
        ("1_000", "1_000"),
        ("1.5", 1.5),
        ("1.", 1.0),
        (".5", 0.5),
        ("1e3", 1000.0),
        ("-1E-3", -0.001),
        ("0x1p4", 16.0),
        ("1e999", "1e999"),
        ("1e-400", "1e-400"),
        ("-4.9e-325", "-4.9e-325"),
        ("0x1p-1080", "0x1p-1080"),
        ("0e-400", 0.0),
        (".inf", math.inf),
        ("+.Inf", math.inf),
        ("-.INF", -math.inf),
        ("inf", math.inf),
        (".infinity", ".infinity"),
        (".Nan", ".Nan"),
        ("null", "null"),
        ("~", "~"),
        ("2:1", "2:1"),
        ("2020-01-01", "2020-01-01"),
        ("0x", "0x"),
        (".", "."),
        ("1 2", "1 2"),
    ],
)
def test_a_plain_scalar_has_the_type_that_rcl_gives_it(text: str, value: object) -> None:
    """As C's strtoll and strtod parse it, after the words for booleans."""
    parsed = parse_scalar(text)

    assert parsed == value
    assert type(parsed) is type(value)


@pytest.mark.parametrize("text", [".nan", ".NaN", ".NAN", "nan"])
def test_not_a_number_is_a_number(text: str) -> None:
    """A double."""
    parsed = parse_scalar(text)

    assert isinstance(parsed, float)
    assert math.isnan(parsed)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("!!binary aGk=", "aGk="),
        ("[!!binary aGk=]", [b"hi"]),
        ('"7"', "7"),
        ("'true'", "true"),
        ("!!str 12.5", "12.5"),
        ("[a, b]", ["a", "b"]),
        ('["and", "7"]', ["and", "7"]),
        ("[true, off]", [True, False]),
        ("[1.0, .inf]", [1.0, math.inf]),
        ("[]", []),
        ("server", "server"),
        ("hello world", "hello world"),
    ],
)
def test_quotes_keep_a_string_and_lists_have_one_type(text: str, value: object) -> None:
    """The tag !!str has the same effect as quotes."""
    assert parse_value(text) == value


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("[1, 2.0]", "type integer, and '2.0' is of type double"),
        ("[true, 1]", "type bool, and '1' is of type integer"),
        ("[[1]]", "a sequence in a sequence; only scalars"),
        ("[{a: 1}]", "a mapping in a sequence"),
        ("{a: 1}", "a mapping where a scalar was expected"),
        ("", "no value"),
        ("a: b", "a mapping where a scalar"),
        ("]", "not YAML"),
        ("*x", "an alias|not YAML"),
        ("--- 1\n--- 2", "more than one value"),
    ],
)
def test_a_value_that_no_parameter_can_have_is_refused(text: str, says: str) -> None:
    """The error shows the value."""
    with pytest.raises(ParameterFileError, match=says):
        parse_value(text)


def test_nested_names_are_joined_by_dots() -> None:
    """The rules keep the order of the file."""
    text = """
# a comment
---
lidar_ns:
  lidar_1:
    ros__parameters:
      id: 10
      driver1: {dx: 4.56, specs: [12, 3]}
      name: "front lidar"
"""
    assert parse_parameter_yaml(text) == (
        ParameterRule("/lidar_ns/lidar_1", "id", 10),
        ParameterRule("/lidar_ns/lidar_1", "driver1.dx", 4.56),
        ParameterRule("/lidar_ns/lidar_1", "driver1.specs", [12, 3]),
        ParameterRule("/lidar_ns/lidar_1", "name", "front lidar"),
    )


@pytest.mark.parametrize("text", ["", "---\n", "# nothing\n", "a: {ros__parameters: {}}"])
def test_an_empty_file_has_no_rules(text: str) -> None:
    """A newly created file is empty."""
    assert parse_parameter_yaml(text) == ()


@pytest.mark.parametrize(
    ("text", "line", "says"),
    [
        ("a:\n  ros__parameters:\n    id:\n    x: 1\n", 3, "no value"),
        ("a:\n  b: 1\n", 2, "the value '1' before 'ros__parameters'"),
        ("ros__parameters:\n  x: 1\n", 2, "there is no name of a node"),
        ("a:\n  ros__parameters:\n  - x: 1\n", 3, "a sequence where parameters were expected"),
        ("a:\n  ros__parameters: 5\n", 2, "the value '5' where parameters were expected"),
        ("a:\n- b\n", 2, "a sequence before 'ros__parameters'"),
        ("- a\n", 1, "maps names of nodes"),
        ("just text", 1, "maps names of nodes"),
        ("a:\n  ros__parameters:\n    x: &q 1\n    y: *q\n", 4, "an alias"),
        ("a:\n  ros__parameters:\n    ? [k]\n    : 1\n", 3, "a sequence cannot be a key"),
        ("a:\n  ros__parameters:\n    '': 1\n", 3, "no key"),
        ("a:\n  ros__parameters:\n    x: [1\n", 4, "not YAML"),
        ("a: \x01", 0, "not YAML"),
    ],
)
def test_a_malformed_file_is_refused_with_line_and_reason(text: str, line: int, says: str) -> None:
    """The error says what was given, where, and what is allowed."""
    with pytest.raises(ParameterFileError) as info:
        parse_parameter_yaml(text, "robot.yaml")

    assert says in str(info.value)
    assert (info.value.source, info.value.line) == ("robot.yaml", line)


def test_a_file_that_cannot_be_read_is_an_error_with_its_path(tmp_path: Path) -> None:
    """A directory, a missing file, or bytes that are not text."""
    binary = tmp_path / "binary.yaml"
    binary.write_bytes(b"\xff\xfe\x00")
    for path in (tmp_path, tmp_path / "missing.yaml", binary):
        with pytest.raises(ParameterFileError, match="cannot be read"):
            read_parameter_file(path)


def test_a_file_is_read_from_disk(tmp_path: Path) -> None:
    """As `--params-file` does."""
    file = tmp_path / "robot.yaml"
    file.write_text("/**: {ros__parameters: {rate: 1e1}}", encoding="utf-8")

    args = parse_arguments(["--ros-args", "--params-file", str(file)])

    assert args.parameters_for("/n") == {"rate": 10.0}
    assert args.params_files == (str(file),)


# Laws

yaml_text = st.text("ab:{}[],-'\"\n *&!#|>~1.e\t/?%@", max_size=40)


@given(yaml_text)
@example("{" * 500)
@example("? " * 300)
@example("a: " + "1" * 5000)
def test_any_text_is_a_parameter_file_or_an_error_with_a_line(text: str) -> None:
    """Nothing but the documented error."""
    for parse_any in (parse_parameter_yaml, parse_value):
        try:
            parse_any(text)
        except ParameterFileError as error:
            problem = error.problem
        else:
            problem = "none"
        assert problem


words = st.one_of(
    st.sampled_from(["--ros-args", "--", "-r", "-p", "--remap", "--param", "--log-level", "-e"]),
    st.sampled_from(["a:=b", "n:a:=[1, 2]", "__ns:=/x", "debug", "--disable-stdout-logs", "--no"]),
    st.text("ab:=/*~{}[]-1 ", max_size=8),
)


@given(st.lists(words, max_size=10))
def test_any_words_are_arguments_or_an_error_that_shows_one(args: list[str]) -> None:
    """It raises only the documented error, and keeps the program's own arguments."""
    own = tuple(remove_ros_args(args))
    try:
        parsed = parse_arguments(args).non_ros_args
    except InvalidROSArgsError as error:
        parsed = own
        assert error.argument.split(" ")[0] in args  # noqa: PT017 - the law is about both ends
    assert parsed == own


@given(st.integers(-(2**63), 2**63 - 1) | st.booleans() | st.floats(allow_nan=False))
def test_what_python_prints_is_read_back(value: float) -> None:
    """A file from `ros2 param dump` can be read."""
    text = {math.inf: ".inf", -math.inf: "-.inf"}.get(value, str(value))

    parsed = parse_scalar(text)

    assert parsed == value
    assert type(parsed) is type(value)
