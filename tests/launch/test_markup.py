"""What launch files in XML and YAML start."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from aionode.errors import LaunchFileError
from aionode.launch import Plan
from aionode.launch._frontend import command_words
from launch.frontend.parse_substitution import parse_words
from launch.launch_context import LaunchContext
from launch.substitution import perform_substitutions

if TYPE_CHECKING:
    from tests.launch.conftest import Files

XML = """
<launch>
  <arg name="x" default="5"/>
  <let name="y" value="$(eval '$(var x) + 1')"/>
  <group>
    <push_ros_namespace namespace="robot"/>
    <set_parameter name="use_sim_time" value="true"/>
    <node exec="talker" name="t" args="--fast '$(var x) m'" if="$(equals $(var y) 6)">
      <param name="a" value="1"/>
      <param name="b"><param name="c" value="x"/></param>
      <param name="s" value="$(var x)" type="str"/>
      <remap from="chatter" to="/c"/>
      <env name="COLOR" value="red"/>
    </node>
  </group>
  <timer period="2.0"><executable cmd="echo later"/></timer>
  <executable cmd="never" unless="true"/>
</launch>
"""

YAML = """
launch:
- arg: {name: x, default: '5'}
- let: {name: y, value: $(eval '$(var x) + 1')}
- group:
  - push_ros_namespace: {namespace: robot}
  - set_parameter: {name: use_sim_time, value: true}
  - node:
      exec: talker
      name: t
      args: --fast '$(var x) m'
      if: $(equals $(var y) 6)
      param:
      - {name: a, value: 1}
      - name: b
        param:
        - {name: c, value: x}
      - {name: s, value: $(var x), type: str}
      remap:
      - {from: chatter, to: /c}
      env:
      - {name: COLOR, value: red}
- timer:
    period: 2.0
    children:
    - executable: {cmd: echo later}
- executable: {cmd: never, unless: true}
"""


def test_the_same_file_in_xml_and_yaml_starts_the_same(files: Files) -> None:
    """One reader of elements serves both languages."""
    xml = files.plan("a.launch.xml", XML)
    yaml = files.plan("a.launch.yaml", YAML)

    def parts(name: str, value: object) -> dict[str, object]:
        return {"/robot/t": {"ros__parameters": {name: value}}}

    assert [record["argv"] for record in xml] == [
        [
            "talker", "--fast", "5 m", "--ros-args", "-r", "__node:=t", "-r", "__ns:=/robot",
            "-p", "use_sim_time:=True",
            "--params-file", parts("a", 1),
            "--params-file", parts("b.c", "x"),
            "--params-file", parts("s", "5"),
            "-r", "chatter:=/c",
        ],
        ["echo", "later"],
    ]  # fmt: skip
    assert [record["argv"] for record in yaml] == [record["argv"] for record in xml]
    assert xml[0]["env"] == yaml[0]["env"] == {"COLOR": "red"}
    assert xml[1]["when"] == yaml[1]["when"] == ["after 2 s"]


def test_loops_have_their_values_in_substitutions(files: Files) -> None:
    """The values of an outer loop exist in an inner one, and none do after it."""
    records = files.plan(
        "a.launch.xml",
        """<launch>
        <for_each values="{name: a};{name: b}">
          <for len="2" name="i">
            <executable cmd="echo $(for-var name) $(index i) $(for-var other none)"/>
          </for>
        </for_each>
        <executable cmd="echo $(for-var name none)"/>
        </launch>""",
    )

    said = [" ".join(record["argv"][1:]) for record in records]
    assert said == ["a 0 none", "a 1 none", "b 0 none", "b 1 none", "none"]


BAD_XML = {
    "<launch><nod/></launch>": (1, "'nod' is not an action; there are: append_env"),
    '<launch>\n<node exec="a" pgk="b"/></launch>': (2, "'node' has no 'pgk'; it has: "),
    "<launch>\n\n<node/></launch>": (3, "'node' needs 'exec'"),
    '<launch><node exec="$(vr x)"/></launch>': (1, "'$(vr …)' is not a substitution"),
    '<launch><node exec="$(var x"/></launch>': (1, "')' is missing"),
    '<launch><node exec="a"><param name="b"/></node></launch>': (1, "'param' needs 'value'"),
    '<launch><node exec="a" if="1" unless="1"/></launch>': (1, "use one of them"),
    '<launch>\n<executable cmd="$(for-var x)"/></launch>': (2, "no enclosing loop has 'x'"),
    '<launch>\n<for len="0" name="i"><nod/></for></launch>': (2, "'nod' is not an action"),
    "<launch>\n</lunch>": (2, "not valid XML: mismatched tag"),
    "<robot/>": (1, "begins with 'robot'; begin with 'launch'"),
    '<!DOCTYPE launch [<!ENTITY a "b">]><launch/>': (1, "a document type (<!DOCTYPE>)"),
}


@pytest.mark.parametrize("text", BAD_XML)
def test_a_bad_file_in_xml_is_one_error_with_its_line(files: Files, text: str) -> None:
    """Even a mistake that could be ignored: a misspelt attribute is not a default."""
    line, problem = BAD_XML[text]
    with pytest.raises(LaunchFileError) as caught:
        files.plan("a.launch.xml", text)

    assert (caught.value.line, problem in caught.value.problem) == (line, True), str(caught.value)


BAD_YAML = {
    "launch: [": (1, "not valid YAML"),
    "- a": (1, "expected 'launch:'"),
    "launch:\n- node\n": (2, "is not an action"),
    "launch:\n- node: {exec: a, pgk: b}\n": (2, "'node' has no 'pgk'"),
    "launch:\n- nodes:\n    exec: a\n": (2, "'nodes' is not an action"),
}


@pytest.mark.parametrize("text", BAD_YAML)
def test_a_bad_file_in_yaml_is_one_error_with_its_line(files: Files, text: str) -> None:
    """As for XML."""
    line, problem = BAD_YAML[text]
    with pytest.raises(LaunchFileError) as caught:
        files.plan("a.launch.yaml", text)

    assert problem in caught.value.problem
    assert caught.value.line == line


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("", ""),
        ("plain $ text", "plain $ text"),
        ("a$(var x)b", "a5b"),
        (r"\$(var x)", "$(var x)"),
        ("$(var none 'a b')", "a b"),
        ('$(eval "$(var x) * 2")', "10"),
        ('$(eval \'"$(var x)" == "5"\')', "True"),
        ("$(env NOT_THERE default)", "default"),
        ("$(if $(equals $(var x) 5) yes no)", "yes"),
    ],
)
def test_substitutions_stand_within_texts(text: str, value: str) -> None:
    """With quotes and backslashes as in ROS's launch."""
    context = LaunchContext()
    context.launch_configurations["x"] = "5"

    assert perform_substitutions(context, parse_words(text)) == value


def test_a_command_line_is_split_around_substitutions() -> None:
    """A substitution belongs to the word that it touches."""
    context = LaunchContext()
    context.launch_configurations["x"] = "5"
    words = command_words("a --b=$(var x)c 'd e' $(var x)/f $(var x) g")

    texts = [perform_substitutions(context, word) for word in words]
    assert texts == ["a", "--b=5c", "d e", "5/f", "5", "g"]


BOMB = "a0: &a0 [x, x]\n" + "".join(
    f"a{n + 1}: &a{n + 1} [{', '.join([f'*a{n}'] * 9)}]\n" for n in range(8)
)


def test_aliases_of_aliases_are_refused(files: Files) -> None:
    """A few lines expand to billions of values."""
    path = files.write("a.launch.yaml", f"launch:\n- arg: {{name: a}}\n{BOMB}")

    with pytest.raises(LaunchFileError, match="more than 80000 values") as caught:
        Plan(path)

    assert caught.value.line is not None


@pytest.mark.parametrize("name", ["a.launch.py", "a.launch.xml", "a.launch.yaml", "a"])
def test_a_pipe_is_no_launch_file(name: str, tmp_path: Path) -> None:
    """Nobody may ever write to it."""
    os.mkfifo(tmp_path / name)

    with pytest.raises(LaunchFileError, match="cannot be read: a pipe or a device, not a file"):
        Plan(str(tmp_path / name))


@pytest.mark.parametrize(
    "parameters",
    ["f", "ParameterFile(f, allow_substs=True)", "{'a': FileContent(f)}", "RewrittenYaml(f, {})"],
)
def test_a_pipe_is_no_parameter_file(parameters: str, files: Files, tmp_path: Path) -> None:
    """It is named, with the line of the launch file, before anything starts."""
    os.mkfifo(tmp_path / "pipe")
    component = f"ComposableNode(package='p', plugin='P', name='n', parameters=[{parameters}])"

    with pytest.raises(LaunchFileError, match="pipe"):
        files.python(
            f"ComposableNodeContainer(name='c', namespace='', package='p', executable='e', "
            f"composable_node_descriptions=[{component}])",
            imports="from launch_ros.parameter_descriptions import ParameterFile\n"
            f"from nav2_common.launch import RewrittenYaml\nf = {str(tmp_path / 'pipe')!r}",
        )
