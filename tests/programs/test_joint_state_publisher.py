"""The program that publishes a position for each joint."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from aionode import Context, Parameter
from aionode.errors import CommandError
from aionode.interfaces.sensor_msgs.msg import JointState
from aionode.interfaces.std_msgs.msg import String
from aionode.programs._joint_state_publisher import JointStatePublisher, main
from aionode.qos import DurabilityPolicy, QoSProfile
from aionode.testing import ManualClock, settle
from tests.programs.conftest import Start

URDF = """
<robot name="arm">
  <link name="a"/> <link name="b"/> <link name="c"/> <link name="d"/> <link name="e"/>
  <joint name="one" type="revolute">
    <parent link="a"/> <child link="b"/> <limit lower="1" upper="3"/>
    <safety_controller soft_lower_limit="2" soft_upper_limit="4" k_velocity="1"/>
  </joint>
  <joint name="two" type="continuous"> <parent link="b"/> <child link="c"/> </joint>
  <joint name="three" type="prismatic">
    <parent link="c"/> <child link="d"/> <limit lower="-1" upper="1"/>
    <mimic joint="two" multiplier="2" offset="1"/>
  </joint>
  <joint name="four" type="fixed"> <parent link="d"/> <child link="e"/> </joint>
</robot>
"""


@pytest.fixture
def joints(
    manual_clock: ManualClock, start: Start, node_factory: Callable[..., Any]
) -> Callable[..., Any]:
    """Start the program, publish a description, and return what it says after 100 ms."""
    heard: list[JointState] = []

    async def run(urdf: str = URDF, **parameters: Any) -> list[JointState]:
        start(JointStatePublisher, **parameters)
        robot = node_factory("robot")
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        robot.create_publisher(String, "robot_description", latched).publish(String(data=urdf))
        robot.create_subscription(JointState, "joint_states", heard.append)
        await manual_clock.advance(0.1)
        await settle()
        return heard

    return run


async def test_joints_are_at_zero_or_in_the_middle_if_they_cannot_be(
    joints: Callable[..., Any],
) -> None:
    """Limits of a safety controller count, and a joint that mimics another one follows it."""
    (state,) = await joints()

    assert state.name == ["one", "two", "three"]
    assert state.position.tolist() == [2.5, 0.0, 1.0]
    assert state.velocity.size == state.effort.size == 0


async def test_parameters_say_where_joints_are_and_which_follow(
    joints: Callable[..., Any],
) -> None:
    """A chain of joints that follow is followed to its end."""
    (state,) = await joints(
        **{
            "zeros.two": 0.5,
            "use_smallest_joint_limits": False,
            "dependent_joints.one.parent": "three",
            "dependent_joints.one.factor": 10.0,
            "publish_default_velocities": True,
            "publish_default_efforts": True,
        }
    )

    assert state.position.tolist() == [20.0, 0.5, 2.0]
    assert state.velocity.tolist() == state.effort.tolist() == [0.0, 0.0, 0.0]


async def test_mimic_tags_can_be_left_out(joints: Callable[..., Any]) -> None:
    """Then such a joint is one like others."""
    (state,) = await joints(use_mimic_tags=False)

    assert state.position.tolist() == [2.5, 0.0, 0.0]


async def test_what_sources_say_is_taken_over(
    joints: Callable[..., Any], manual_clock: ManualClock, node_factory: Callable[..., Any]
) -> None:
    """Each of them knows a part of the robot; unknown joints and short lists hurt nobody."""
    heard = await joints(source_list=["arm_states"])
    driver = node_factory("driver").create_publisher(JointState, "arm_states", 10)
    driver.publish(JointState(name=["two", "no"], position=[0.25], velocity=[1.0, 2.0]))
    await settle()
    await manual_clock.advance(0.1)

    assert heard[-1].position.tolist() == [2.5, 0.25, 1.5]
    assert heard[-1].velocity.tolist() == [0.0, 1.0, 2.0]


async def test_delta_moves_joints_to_and_fro(
    joints: Callable[..., Any], manual_clock: ManualClock
) -> None:
    """Joints that turn without end go around."""
    heard = await joints(delta=2.0)
    await manual_clock.advance(0.2)

    assert [msg.position.tolist()[0] for msg in heard] == [3.0, 2.0, 3.0]
    assert [msg.position.tolist()[1] for msg in heard] == pytest.approx(
        [2.0, -3.14159265, -1.14159265]
    )


async def test_a_file_is_an_argument(
    tmp_path: Path, start: Start, aionode_context: Context, capfd: pytest.CaptureFixture[str]
) -> None:
    """Then nothing is waited for."""
    file = tmp_path / "robot.urdf"
    file.write_text(URDF)

    assert start(JointStatePublisher, str(file)).joints == ["one", "two", "three"]
    assert "Waiting" not in capfd.readouterr().err
    with pytest.raises(CommandError, match="No such file"):
        JointStatePublisher(str(tmp_path / "none"))


async def test_what_is_no_description_is_not_used(
    joints: Callable[..., Any], capfd: pytest.CaptureFixture[str]
) -> None:
    """The program waits for a better one, and says why."""
    circle = URDF.replace(
        '<child link="c"/> </joint>', '<child link="c"/> <mimic joint="three"/> </joint>'
    )

    assert await joints(circle) == []
    assert (
        "Found an infinite recursive mimic chain: ['two', 'three', 'two']" in capfd.readouterr().err
    )


@pytest.mark.parametrize(
    ("parameters", "text"),
    [
        ({"dependent_joints.one": 1.0}, "Invalid dependent_joint name 'one'"),
        ({"dependent_joints.one.speed": 1.0}, "Invalid dependent_joint name 'speed'"),
        ({"dependent_joints.one.factor": 1.0}, "All dependent_joints must at least have a parent"),
        ({"rate": 0}, "rate is 0; use a number above 0"),
        ({"delta": "fast"}, "delta is 'fast'; use a number"),
        ({"use_mimic_tags": "yes"}, "use_mimic_tags is 'yes'; use true or false"),
        ({"source_list": "arm"}, "source_list is 'arm'; use a list of topics"),
        ({"zeros.one": "up"}, "zeros.one is 'up'; use a number"),
        (
            {"dependent_joints.one.parent": "two", "dependent_joints.one.factor": "half"},
            "dependent_joints.one.factor is 'half'; use a number",
        ),
    ],
)
async def test_parameters_that_do_not_fit_are_named(
    start: Start, parameters: dict[str, Any], text: str
) -> None:
    """In the words of the original, where it has some."""
    with pytest.raises(CommandError, match=text):
        start(JointStatePublisher, **parameters)


async def test_a_parameter_set_later_does_not_end_the_program(
    start: Start, tmp_path: Path, manual_clock: ManualClock, node_factory: Callable[..., Any]
) -> None:
    """It is read at the start only, as in the original; of another type it is refused."""
    file = tmp_path / "robot.urdf"
    file.write_text(URDF)
    node = start(JointStatePublisher, str(file))
    heard: list[JointState] = []
    node_factory("watcher").create_subscription(JointState, "joint_states", heard.append)

    assert not node.set_parameters([Parameter("delta", value="fast")])[0].successful
    assert node.set_parameters([Parameter("delta", value=0.5)])[0].successful
    await manual_clock.advance(0.2)
    await settle()

    assert heard[-1].position.tolist() == heard[0].position.tolist()


def test_in_the_place_of_the_one_with_a_window_it_says_what_moves_the_joints(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    """Whoever starts it looks for sliders."""
    monkeypatch.setattr("sys.argv", ["joint_state_publisher_gui", "--help"])

    with pytest.raises(SystemExit):
        main()

    assert "the topics of the parameter 'source_list'" in capfd.readouterr().err
