"""The gateway in the place of foxglove_bridge and rosbridge_websocket."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from aionode import Node
from aionode.errors import CommandError, ConfigurationError
from aionode.launch import Plan
from aionode.programs._bridges import foxglove_bridge, rosbridge_websocket
from aionode.programs._bridges.bridge import Original, bridge

if TYPE_CHECKING:
    from aionode.gateway import Gateway
    from tests.programs.conftest import Start

BOTH = [foxglove_bridge.ORIGINAL, rosbridge_websocket.ORIGINAL]

EVERYWHERE = "0.0.0.0"  # noqa: S104  # as launch files write it

TOKENS = '[[who]]\nname = "ann"\ntoken = "0123456789abcdef0123456789abcdef"\n'


def gateway_of(start: Start, original: Original, **parameters: Any) -> Gateway:
    """Return the gateway of a program that is given parameters."""
    return bridge(start(Node, original.node, **parameters), original)


@pytest.mark.parametrize(("original", "port"), [(BOTH[0], 8765), (BOTH[1], 9090)])
async def test_it_listens_where_clients_look_for_it(
    start: Start, original: Original, port: int
) -> None:
    """On this host only: nobody has said who the others are."""
    gateway = gateway_of(start, original)

    assert (gateway.host, gateway.port) == ("127.0.0.1", port)


async def test_clients_of_this_host_are_served(start: Start) -> None:
    """On the port that the launch file names; 0 is a free one."""
    node: Node = start(Node, BOTH[0].node, port=0)
    async with node, bridge(node, BOTH[0]) as gateway:
        assert gateway.port > 0


async def test_without_a_policy_other_hosts_are_not_served(
    start: Start, capfd: pytest.CaptureFixture[str]
) -> None:
    """Launch files name all addresses, as the originals do; the robot starts all the same."""
    gateway = gateway_of(start, BOTH[0], address=EVERYWHERE)

    assert gateway.host == "127.0.0.1"
    assert "name the file of one by the parameter 'policy'" in capfd.readouterr().err


async def test_a_policy_that_knows_its_clients_opens_it(start: Start, tmp_path: Path) -> None:
    """One that knows none does not."""
    file = tmp_path / "policy.toml"
    file.write_text(TOKENS)

    gateway = gateway_of(start, BOTH[0], address=EVERYWHERE, policy=str(file))

    assert gateway.host == EVERYWHERE
    file.write_text("")
    with pytest.raises(ConfigurationError, match="other machines can connect there"):
        gateway_of(start, BOTH[1], address=EVERYWHERE, policy=str(file))


@pytest.mark.parametrize(
    ("original", "name", "value"),
    [
        (BOTH[0], "topic_whitelist", ["/odom"]),
        (BOTH[0], "tls", True),
        (BOTH[1], "topics_glob", "['/odom']"),
        (BOTH[1], "services_glob", "[]"),
    ],
)
async def test_a_restriction_is_not_ignored(
    start: Start, original: Original, name: str, value: object
) -> None:
    """Whoever wrote it would believe that nothing else can be read."""
    with pytest.raises(CommandError, match=f"{name} is .* a policy says what clients may do"):
        gateway_of(start, original, **{name: value})


async def test_a_restriction_to_everything_does_not_restrict(start: Start) -> None:
    """Launch files write out the defaults."""
    gateway_of(start, BOTH[0], topic_whitelist=[".*"], tls=False)
    gateway_of(start, BOTH[1], topics_glob="['*']")


FILE = """
import os
from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import AnyLaunchDescriptionSource

def generate_launch_description():
    return LaunchDescription([
        IncludeLaunchDescription(
            AnyLaunchDescriptionSource(
                os.path.join(get_package_share_directory(package), "launch", file)),
            launch_arguments={"port": "1234"}.items())
        for package, file in [
            ("foxglove_bridge", "foxglove_bridge_launch.xml"),
            ("rosbridge_server", "rosbridge_websocket_launch.xml"),
        ]
    ])
"""


def test_their_launch_files_are_found(tmp_path: Path) -> None:
    """By the function that launch files call, as by the substitution."""
    file = tmp_path / "web.launch.py"
    file.write_text(FILE)

    started = [each["argv"] for each in Plan(str(file)).records()]

    assert [argv[3:5] for argv in started] == [
        ["foxglove_bridge", "foxglove_bridge"],
        ["rosbridge_server", "rosbridge_websocket"],
    ]
    assert all("1234" in str(argv) for argv in started)


@pytest.mark.processes
def test_a_description_is_displayed_as_by_urdf_launch(tmp_path: Path) -> None:
    """Without its window, as on a computer without a screen."""
    package = tmp_path / "src" / "arm"
    package.mkdir(parents=True)
    (package / "package.xml").write_text("<name>arm</name>")
    (package / "arm.urdf").write_text("<robot name='arm'><link name='base'/></robot>")
    file = package / "show.launch.xml"
    file.write_text(
        "<launch><include file='$(find-pkg-share urdf_launch)/launch/display.launch.py'>"
        "<arg name='urdf_package' value='arm'/><arg name='urdf_package_path' value='arm.urdf'/>"
        "</include></launch>"
    )

    records = list(Plan(str(file)).records())

    programs = [each["argv"][4] for each in records if "argv" in each]
    assert programs == ["robot_state_publisher", "joint_state_publisher_gui"]
