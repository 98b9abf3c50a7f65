"""The controller manager with mock hardware, its controllers, and the programs that spawn them."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from aionode.errors import CommandError
from aionode.interfaces.control_msgs.msg import DynamicJointState
from aionode.interfaces.control_msgs.srv import SetOdometry
from aionode.interfaces.controller_manager_msgs import srv
from aionode.interfaces.controller_manager_msgs.msg import ControllerManagerActivity
from aionode.interfaces.geometry_msgs.msg import Twist, TwistStamped, Vector3
from aionode.interfaces.lifecycle_msgs.msg import State
from aionode.interfaces.nav_msgs.msg import Odometry
from aionode.interfaces.sensor_msgs.msg import JointState
from aionode.interfaces.std_msgs.msg import Float64MultiArray
from aionode.interfaces.tf2_msgs.msg import TFMessage
from aionode.programs._ros2_control.description import Description
from aionode.programs._ros2_control.hardware import Hardware
from aionode.programs._ros2_control.manager import ControllerManager
from aionode.programs._ros2_control.mock_system import MockSystem
from aionode.programs._ros2_control.spawner import Spawner, parsed
from aionode.programs._ros2_control.speed_limiter import SpeedLimiter
from aionode.testing import settle
from tests.programs.conftest import Start
from tests.programs.ros2_control.conftest import LATCHED, MOVING, urdf


def hardware_of(description: str) -> Hardware:
    """Return active hardware; a mock needs no node."""
    hardware = Hardware(Description.of(description), None, limits=True)  # type: ignore[arg-type]
    for name in hardware.components:
        hardware.set_state(name, State.PRIMARY_STATE_ACTIVE)
    return hardware


def test_a_description_names_interfaces_with_their_limits_and_first_values() -> None:
    """The limits of the joint count unless the interface has some."""
    component = Description.of(MOVING).components[0]
    commands = {each.name: (each.least, each.greatest) for each in component.commands}
    states = {each.name: each.initial for each in component.states}

    assert commands["lift/position"] == (-1.0, 2.0)
    assert commands["lift/velocity"] == (-3.0, 3.0)
    assert commands["left/velocity"] == (-math.inf, math.inf)
    assert states["lift/position"] == 0.25


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("<robot name='x'><link name='a'/></robot>", "it has no <ros2_control>"),
        (
            "<robot name='x'><link name='a'/><ros2_control name='b'/></robot>",
            "has no <plugin>",
        ),
        (MOVING.replace('<joint name="grip"> <state', '<joint name="gr"> <state'), "joint 'gr'"),
        (MOVING.replace(">0.25<", ">much<"), "lift/position: 'much' is not a number"),
    ],
)
def test_a_description_that_cannot_be_used_says_why(text: str, problem: str) -> None:
    """Somebody wrote it by hand."""
    with pytest.raises(ValueError, match=problem):
        Description.of(text)


def test_commands_are_copied_to_states() -> None:
    """A command that has not been given yet changes nothing, and a mimic follows."""
    hardware = hardware_of(urdf())
    hardware.read(0.1)
    assert hardware.states["lift/position"] == 0.25
    hardware.commands |= {"lift/position": 0.4, "left/velocity": 2.0, "lamp/on": 1.0}
    hardware.read(0.1)

    assert hardware.states["lift/position"] == 0.4
    assert hardware.states["grip/position"] == pytest.approx(0.1 + 0.5 * 0.4)
    assert hardware.states["left/velocity"] == 2.0
    assert hardware.states["left/position"] == 0.0
    assert hardware.states["lamp/on"] == 1.0


def test_with_dynamics_speeds_move_joints_and_positions_have_speeds() -> None:
    """The interface that was claimed last says how a joint is commanded."""
    hardware = hardware_of(MOVING)
    hardware.claim(["left/velocity", "lift/position"], "some")
    hardware.commands |= {"left/velocity": 2.0, "lift/position": 0.75}
    hardware.read(0.5)

    assert hardware.states["left/position"] == pytest.approx(1.0)
    assert hardware.states["lift/position"] == 0.75
    assert hardware.states["lift/velocity"] == pytest.approx(1.0)


def test_mocks_are_deaf_or_shifted_if_their_parameters_say_so() -> None:
    """To try what happens without feedback, or with a poor one."""
    deaf = hardware_of(urdf(disable_commands="true"))
    shifted = hardware_of(urdf(position_state_following_offset="-0.5"))
    for hardware in (deaf, shifted):
        hardware.commands["lift/position"] = 1.0
        hardware.read(0.1)

    assert deaf.states["lift/position"] == 0.25
    assert shifted.states["lift/position"] == 0.5


def test_sensors_and_gpios_of_mocks_are_commanded_if_their_parameters_say_so() -> None:
    """Somebody can then play their part."""
    hardware = hardware_of(urdf(mock_sensor_commands="true"))
    hardware.commands["force/z"] = 9.0
    hardware.read(0.1)

    assert hardware.states["force/z"] == 9.0
    assert "force/z" not in hardware_of(urdf()).commands


def test_a_plugin_in_cpp_is_refused_with_what_to_use_instead() -> None:
    """Wheels that do not turn would be worse."""
    with pytest.raises(CommandError, match="my/Driver is a plugin in C\\+\\+; use mock_components"):
        hardware_of(urdf("my/Driver"))


async def test_the_joints_are_broadcast(robot: Callable[..., Any]) -> None:
    """They are those of the URDF; all other interfaces are in the dynamic message."""
    bot = await robot()
    heard = bot.hear(JointState, "joint_states")
    dynamic = bot.hear(DynamicJointState, "dynamic_joint_states")
    await bot.start("joints")
    await bot.pass_time(0.02)

    msg = heard[-1]
    assert list(msg.name) == ["lift", "grip", "left", "right"]
    assert list(msg.position)[:2] == [0.25, pytest.approx(0.225)]
    assert math.isnan(msg.effort[0])
    assert list(dynamic[-1].joint_names)[2:4] == ["force", "lamp"]
    assert len(heard) == 2, "as often as the manager updates"


async def test_a_broadcaster_takes_chosen_joints_and_other_names_of_interfaces(
    robot: Callable[..., Any], tmp_path: Path
) -> None:
    """By its parameters."""
    file = tmp_path / "own.yaml"
    file.write_text(
        "joints: {ros__parameters: {joints: [lift], interfaces: [position], extra_joints: [tail], "
        "use_local_topics: true, update_rate: 50}}"
    )
    bot = await robot(**{"joints.params_file": str(file)})
    heard = bot.hear(JointState, "joints/joint_states")
    await bot.start("joints")
    await bot.pass_time(0.1)

    assert list(heard[-1].name) == ["lift", "tail"]
    assert list(heard[-1].position) == [0.25, 0.0]
    assert math.isnan(heard[-1].velocity[0])
    assert len(heard) == 4, "every other time that the manager updates"


async def test_a_base_drives_an_arc_and_says_where_it_is(robot: Callable[..., Any]) -> None:
    """A quarter of a circle of radius 1 m, by /odom and by /tf."""
    bot = await robot(base="cmd_vel_timeout: 0.0")
    heard, transforms = bot.hear(Odometry, "base/odom"), bot.hear(TFMessage, "/tf")
    await bot.start("base")
    publisher = bot.user.create_publisher(TwistStamped, "base/cmd_vel", 10)
    twist = Twist(linear=Vector3(x=0.5), angular=Vector3(z=0.5))
    publisher.publish(TwistStamped(twist=twist))
    await settle()
    await bot.pass_time(math.pi + 0.02)

    pose = heard[-1].pose.pose.position
    assert (pose.x, pose.y) == (pytest.approx(1, abs=0.02), pytest.approx(1, abs=0.02))
    assert heard[-1].twist.twist.linear.x == pytest.approx(0.5)
    assert heard[-1].header.frame_id == "odom"
    assert transforms[-1].transforms[0].child_frame_id == "base_link"
    assert bot.commands["left/velocity"] == pytest.approx((0.5 - 0.5 * 0.25) / 0.1)


async def test_a_base_stops_when_no_command_comes(robot: Callable[..., Any]) -> None:
    """Whoever drives it may have died."""
    bot = await robot()
    await bot.start("base")
    publisher = bot.user.create_publisher(TwistStamped, "base/cmd_vel", 10)
    publisher.publish(TwistStamped(twist=Twist(linear=Vector3(x=0.5))))
    await settle()
    await bot.pass_time(0.4)
    assert bot.commands["left/velocity"] == pytest.approx(5.0)

    await bot.pass_time(0.2)
    assert bot.commands["left/velocity"] == 0.0


async def test_a_base_takes_no_command_from_the_past(
    robot: Callable[..., Any], capfd: pytest.CaptureFixture[str]
) -> None:
    """It may have been held up on its way."""
    bot = await robot()
    await bot.start("base")
    msg = TwistStamped(twist=Twist(linear=Vector3(x=0.5)))
    msg.header.stamp.sec = 1
    bot.user.create_publisher(TwistStamped, "base/cmd_vel", 10).publish(msg)
    await settle()
    await bot.pass_time(0.1)

    assert math.isnan(bot.commands["left/velocity"])
    assert "exceeds the allowed timeout (0.5000)" in capfd.readouterr().err


async def test_a_base_keeps_its_limits(robot: Callable[..., Any]) -> None:
    """It speeds up slowly, and says what it does instead."""
    limits = "linear: {x: {max_acceleration: 1.0, max_velocity: 0.3}}"
    bot = await robot(base=f"publish_limited_velocity: true\n    {limits}")
    limited = bot.hear(TwistStamped, "base/cmd_vel_out")
    await bot.start("base")
    publisher = bot.user.create_publisher(TwistStamped, "base/cmd_vel", 10)
    publisher.publish(TwistStamped(twist=Twist(linear=Vector3(x=0.5))))
    await settle()
    await bot.pass_time(0.1)
    assert limited[-1].twist.linear.x == pytest.approx(0.1, abs=0.011)

    await bot.pass_time(0.3)
    assert bot.commands["left/velocity"] == pytest.approx(3.0)


async def test_a_base_of_humble_takes_commands_without_a_header(
    robot: Callable[..., Any], aionode_context: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With use_stamped_vel, as its configurations have it."""
    monkeypatch.setattr(aionode_context, "ros_distro", "humble")
    text = "use_stamped_vel: false\n    linear.x.max_velocity: 0.1"
    bot = await robot(base=text, robot_description=MOVING)
    await bot.start("base")
    publisher = bot.user.create_publisher(Twist, "base/cmd_vel_unstamped", 10)
    publisher.publish(Twist(linear=Vector3(x=0.5)))
    await settle()
    await bot.pass_time(0.1)

    assert bot.commands["left/velocity"] == pytest.approx(5.0), "limits need has_velocity_limits"


async def test_a_base_that_is_deactivated_stops(robot: Callable[..., Any]) -> None:
    """Its wheels would turn on."""
    bot = await robot(base="cmd_vel_timeout: 0.0")
    await bot.start("base")
    publisher = bot.user.create_publisher(TwistStamped, "base/cmd_vel", 10)
    publisher.publish(TwistStamped(twist=Twist(linear=Vector3(x=0.5))))
    await settle()
    await bot.pass_time(0.1)
    assert (await bot.switch([], ["base"])).ok

    assert bot.commands["left/velocity"] == 0.0
    assert bot.manager.hardware.claims == {}


async def test_a_base_is_put_somewhere_else(robot: Callable[..., Any]) -> None:
    """As its service asks, while it is active."""
    bot = await robot()
    heard = bot.hear(Odometry, "base/odom")
    await bot.start("base")
    client = bot.user.create_client(SetOdometry, "base/set_odometry")
    answer = await client.call(SetOdometry.Request(x=3.0, yaw=1.0))
    await bot.pass_time(0.05)

    assert answer.success
    assert heard[-1].pose.pose.position.x == 3.0


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("wheel_radius: 0.0", "parameter 'wheel_radius' is 0.0"),
        ("left_wheel_names: [left, right]", "number of left wheels [2]"),
        ("linear.x.max_velocity: 1.0\n    linear.x.min_velocity: 2.0", "Invalid velocity limits"),
    ],
)
async def test_a_base_with_wrong_parameters_is_not_configured(
    robot: Callable[..., Any], capfd: pytest.CaptureFixture[str], text: str, problem: str
) -> None:
    """The log says which."""
    bot = await robot(base=text)

    assert not await bot.load("base")
    assert problem in capfd.readouterr().err


async def test_an_arm_goes_where_it_is_told_within_its_limits(robot: Callable[..., Any]) -> None:
    """A command that does not fit is dropped."""
    bot = await robot(enforce_command_limits=True)
    await bot.start("arm")
    publisher = bot.user.create_publisher(Float64MultiArray, "arm/commands", 10)
    for data in ([5.0], [1.0, 2.0], [math.nan]):
        publisher.publish(Float64MultiArray(data=data))
        await settle()
        await bot.pass_time(0.02)
    await bot.pass_time(0.02)

    assert bot.manager.hardware.states["lift/position"] == 2.0


async def test_two_controllers_cannot_command_one_joint(robot: Callable[..., Any]) -> None:
    """The second is refused, unless the first is stopped by the same request."""
    bot = await robot()
    await bot.start("arm")
    assert await bot.load("other")

    answer = await bot.switch(["other"], [])
    assert not answer.ok
    assert "'lift/position' is currently claimed by another controller" in answer.message
    assert (await bot.switch(["other"], ["arm"])).ok
    assert await bot.states() == {"arm": "inactive", "other": "active"}


async def test_a_strict_switch_does_all_or_nothing_and_another_what_it_can(
    robot: Callable[..., Any],
) -> None:
    """As in the original."""
    bot = await robot()
    assert await bot.load("arm")

    answer = await bot.switch(["arm", "ghost"], [])
    assert not answer.ok
    assert "'ghost' because no controller with this name exists" in answer.message
    assert await bot.states() == {"arm": "inactive"}
    assert (await bot.switch(["arm", "ghost"], [], strict=False)).ok
    assert await bot.states() == {"arm": "active"}


@pytest.mark.parametrize(
    ("name", "problem"),
    [
        ("far", "(type 'mecanum_drive_controller/MecanumDriveController') not found"),
        ("ghost", "The 'type' param was not defined for 'ghost'."),
    ],
)
async def test_a_controller_that_is_not_there_is_not_loaded(
    robot: Callable[..., Any], capfd: pytest.CaptureFixture[str], name: str, problem: str
) -> None:
    """The log says what there is."""
    bot = await robot()

    assert not await bot.load(name)
    assert problem in capfd.readouterr().err


async def test_a_controller_is_unloaded_only_when_it_is_stopped(robot: Callable[..., Any]) -> None:
    """Then its node leaves."""
    bot = await robot()
    await bot.start("arm")

    answer = await bot.call("unload_controller", srv.UnloadController, name="arm")
    assert not answer.ok
    await bot.switch([], ["arm"])
    assert (await bot.call("unload_controller", srv.UnloadController, name="arm")).ok
    assert await bot.states() == {}
    assert "arm" not in bot.user.get_node_names()


async def test_hardware_that_is_not_active_takes_no_commands(robot: Callable[..., Any]) -> None:
    """As a parameter says at the start, or a service later; who uses it is stopped."""
    parameter = "hardware_components_initial_state.inactive"
    bot = await robot(**{parameter: ["Bot"]})
    assert await bot.load("arm")
    assert not (await bot.switch(["arm"], [])).ok
    kind = srv.SetHardwareComponentState

    answer = await bot.call(
        "set_hardware_component_state", kind, name="Bot", target_state=State(label="active")
    )
    assert (answer.ok, answer.state.label) == (True, "active")
    assert (await bot.switch(["arm"], [])).ok
    await bot.call(
        "set_hardware_component_state", kind, name="Bot", target_state=State(id=2, label="")
    )
    assert await bot.states() == {"arm": "inactive"}


async def test_hardware_and_interfaces_are_listed(robot: Callable[..., Any]) -> None:
    """With who claims them."""
    bot = await robot()
    await bot.start("arm")
    components = await bot.call("list_hardware_components", srv.ListHardwareComponents)
    interfaces = await bot.call("list_hardware_interfaces", srv.ListHardwareInterfaces)
    claimed = {each.name: each.is_claimed for each in interfaces.command_interfaces}

    assert components.component[0].plugin_name == "mock_components/GenericSystem"
    assert components.component[0].state.label == "active"
    assert claimed["lift/position"]
    assert not claimed["left/velocity"]
    assert "force/z" in {each.name for each in interfaces.state_interfaces}


async def test_the_activity_is_latched(robot: Callable[..., Any]) -> None:
    """Whoever comes late sees what is active."""
    bot = await robot()
    await bot.start("arm")
    heard: list[Any] = []
    bot.user.create_subscription(
        ControllerManagerActivity, "/controller_manager/activity", heard.append, LATCHED
    )
    await settle()

    assert [(each.name, each.state.label) for each in heard[-1].controllers] == [("arm", "active")]


async def test_the_description_may_be_a_parameter(robot: Callable[..., Any]) -> None:
    """As in older launch files."""
    bot = await robot(robot_description=MOVING)
    await bot.start("joints")

    assert await bot.states() == {"joints": "active"}


async def test_a_controller_that_fails_does_not_stop_the_others(
    robot: Callable[..., Any],
    capfd: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """It is deactivated."""
    bot = await robot()
    for name in ("joints", "arm"):
        await bot.start(name)
    arm_fails = "aionode.programs._ros2_control.forward_command_controller.ForwardCommandController"
    monkeypatch.setattr(f"{arm_fails}.update", lambda *_: 1 / 0)
    await bot.pass_time(0.02)

    assert await bot.states() == {"joints": "active", "arm": "inactive"}
    assert "Caught exception while updating controller 'arm'" in capfd.readouterr().err


def limiter(**limits: float) -> SpeedLimiter:
    """Return a limiter with some limits."""
    return SpeedLimiter(lambda name: limits.get(name, math.nan))


def test_braking_and_speeding_up_have_limits_of_their_own() -> None:
    """Forward and back; without limits of its own, braking is as slow as speeding up."""
    own = limiter(max_acceleration=1.0, max_deceleration=-4.0, max_deceleration_reverse=2.0)

    assert own.limit(9.0, 0.0, 0.0, 0.1) == pytest.approx(0.1)
    assert own.limit(0.0, 1.0, 1.0, 0.1) == pytest.approx(0.6)
    assert own.limit(0.0, -1.0, -1.0, 0.1) == pytest.approx(-0.8)
    assert limiter(max_acceleration=1.0).limit(0.0, 1.0, 1.0, 0.1) == pytest.approx(0.9)
    assert limiter(max_jerk=1.0).limit(9.0, 0.0, 0.0, 0.1) == pytest.approx(0.01)
    assert limiter(max_velocity=1.0).limit(-9.0, 0.0, 0.0, 0.1) == -1.0


@pytest.fixture
def files(tmp_path: Path) -> str:
    """A file that says all about two controllers."""
    file = tmp_path / "own.yaml"
    file.write_text(
        "wrist: {ros__parameters: {type: forward_command_controller/ForwardCommandController, "
        "joints: [lift], interface_name: position}}\n"
        "eyes: {ros__parameters: {type: joint_state_broadcaster/JointStateBroadcaster}}\n"
    )
    return str(file)


async def test_a_spawner_brings_controllers_up(
    robot: Callable[..., Any], files: str, capfd: pytest.CaptureFixture[str]
) -> None:
    """With their parameters from a file, and again with a warning."""
    bot = await robot()
    for _ in range(2):
        options, jobs = parsed(["wrist", "eyes", "-p", files, "--inactive"])
        await Spawner(bot.user, options, jobs).spawn()

    assert await bot.states() == {"wrist": "inactive", "eyes": "inactive"}
    err = capfd.readouterr().err
    assert 'Setting controller param "type" to "joint_state_broadcaster' in err
    assert "Loaded wrist" in err
    assert "Controller already loaded, skipping load_controller" in err


async def test_a_spawner_activates_controllers_one_by_one_or_together(
    robot: Callable[..., Any], files: str, capfd: pytest.CaptureFixture[str]
) -> None:
    """In the original's words, for which scripts wait."""
    bot = await robot()
    await Spawner(bot.user, *parsed(["wrist", "-p", files])).spawn()
    group = ["eyes", "base", "-p", files, "--activate-as-group"]
    await Spawner(bot.user, *parsed(group)).spawn()

    assert set((await bot.states()).values()) == {"active"}
    err = capfd.readouterr().err
    assert "Configured and activated wrist" in err
    assert "all the parsed controllers list : ['eyes', 'base']!" in err


async def test_a_spawner_gives_each_controller_options_of_its_own(
    robot: Callable[..., Any], files: str
) -> None:
    """After ``--controller``, and the arguments of its node."""
    bot = await robot()
    words = f"--controller wrist -p {files} --load-only --controller eyes -p {files}".split()
    words += ["--controller-ros-args", "-r joint_states:=seen"]
    heard = bot.hear(JointState, "seen")
    await Spawner(bot.user, *parsed(words)).spawn()
    await bot.pass_time(0.02)

    assert await bot.states() == {"wrist": "unconfigured", "eyes": "active"}
    assert heard


async def test_a_spawner_that_fails_says_at_which_step(robot: Callable[..., Any]) -> None:
    """It also says where to find the reason."""
    bot = await robot()

    with pytest.raises(CommandError, match="Failed loading controller far; the log of /contr"):
        await Spawner(bot.user, *parsed(["far"])).spawn()


async def test_a_spawner_waits_no_longer_than_it_may(node_factory: Callable[..., Any]) -> None:
    """There may be no manager."""
    words = ["far", "--controller-manager-timeout", "0.05"]

    with pytest.raises(CommandError, match="Could not contact service /controller_manager/list"):
        await Spawner(node_factory("spawner"), *parsed(words)).spawn()


async def test_a_spawner_unloads_what_it_spawned_when_it_is_interrupted(
    robot: Callable[..., Any], files: str
) -> None:
    """With ``--unload-on-kill``."""
    bot = await robot()
    spawner = Spawner(bot.user, *parsed(["wrist", "-p", files, "-u"]))
    task = asyncio.get_running_loop().create_task(spawner.run())
    await settle()
    assert await bot.states() == {"wrist": "active"}
    task.cancel()
    await asyncio.wait([task])

    assert await bot.states() == {}


def test_a_file_of_parameters_has_to_exist() -> None:
    """A typing error would leave the defaults in force."""
    with pytest.raises(CommandError, match=r"there is no file nowhere\.yaml"):
        parsed(["wrist", "-p", "nowhere.yaml"])


def test_mocks_start_where_they_stand() -> None:
    """Configuring a second time shifts nothing."""
    hardware = hardware_of(urdf())
    component = hardware.components["Bot"]

    assert isinstance(hardware.drivers[component.name], MockSystem)
    assert hardware.states["left/position"] == 0.0


def test_empty_arguments_are_ignored() -> None:
    """Launch files have them for what is not wanted."""
    assert [job.name for job in parsed(["wrist", "", "--inactive"])[1]] == ["wrist"]


async def test_names_of_requests_are_logged_escaped(
    robot: Callable[..., Any], capfd: pytest.CaptureFixture[str]
) -> None:
    """Any node may send some."""
    bot = await robot(MOVING)
    assert not (await bot.call("load_controller", srv.LoadController, name="\x1b[31m\nfake")).ok

    err = capfd.readouterr().err
    assert r"'\x1b[31m\nfake'" in err
    assert "\x1b[31m" not in err


async def test_a_value_of_the_hardware_that_is_no_number_is_named(start: Start) -> None:
    """In place of a traceback."""
    text = urdf(position_state_following_offset="far")
    with pytest.raises(CommandError, match=r"robot_description cannot be used: .*'far'"):
        start(ControllerManager, robot_description=text)
