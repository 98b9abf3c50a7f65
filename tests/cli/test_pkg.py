"""``aionode pkg``."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from aionode.cli._main import main
from aionode.cli._nouns.pkg import executables, list_packages, manifest, prefix
from aionode.errors import CommandError, PackageNotFoundError


@pytest.fixture(autouse=True)
def workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A workspace with a package, and nothing else installed."""
    folder = tmp_path / "src" / "my_robot"
    folder.mkdir(parents=True)
    (folder / "package.xml").write_text(
        "<package><name>my_robot</name><depend>rclpy</depend><depend>std_msgs</depend></package>"
    )
    (folder / "setup.py").write_text(
        "from setuptools import setup\n"
        "setup(entry_points={'console_scripts': ['drive = my_robot.drive:main']})\n"
    )
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)
    return tmp_path


def test_executables_of_turtlesim_are_those_of_the_tutorial(screen: Any) -> None:
    """In its order."""
    executables("turtlesim", output=screen.output)

    assert screen.text == (
        "turtlesim draw_square\nturtlesim mimic\nturtlesim turtle_teleop_key\n"
        "turtlesim turtlesim_node\n"
    )


def test_executables_of_all_packages_include_those_of_the_workspace(screen: Any) -> None:
    """On request they also show what is started."""
    executables(None, output=screen.output)
    assert "my_robot drive\n" in screen.text
    assert "joy joy_node\n" in screen.text

    executables("my_robot", output=screen.json_output, full_path=True)
    assert '"target":"my_robot.drive:main"' in screen.text.replace(" ", "")


def test_packages_of_the_workspace_and_of_aionode_are_listed(screen: Any) -> None:
    """One per line."""
    list_packages(output=screen.output)

    assert {"my_robot", "turtlesim", "tf2_ros"} <= set(screen.text.split())


def test_prefix_is_the_folder_of_a_package(screen: Any, workspace: Path) -> None:
    """For a package of the workspace, its source folder; of one of aionode's there is only data."""
    prefix("my_robot", output=screen.output)
    prefix("turtlesim", output=screen.output, share=True)

    first, second = screen.text.splitlines()
    assert first == str(workspace / "src" / "my_robot")
    assert (Path(second) / "launch" / "multisim.launch.py").is_file()
    with pytest.raises(PackageNotFoundError):
        prefix("turtlesim", output=screen.output)


def test_a_package_that_is_not_there_is_said(capsys: pytest.CaptureFixture[str]) -> None:
    """With similar names."""
    assert main(["pkg", "executables", "turtlsim"]) == 1

    assert "turtlesim" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("tag", "text"),
    [
        (
            None,
            "<package><name>my_robot</name><depend>rclpy</depend><depend>std_msgs</depend></package>\n",
        ),
        ("depend", "rclpy\nstd_msgs\n"),
    ],
)
def test_a_package_xml_is_printed(screen: Any, tag: str | None, text: str) -> None:
    """Whole, or the text of each element with a name."""
    manifest("my_robot", output=screen.output, tag=tag)

    assert screen.text == text


@pytest.mark.parametrize(
    ("package", "content", "text"),
    [
        ("my_robot", None, "no element 'version'; it has depend, name"),
        ("my_robot", "<package><name>my_robot</name>", "cannot be read: no element found"),
        ("turtlesim", None, "turtlesim: aionode stands in for it, without a package.xml"),
    ],
)
def test_a_package_xml_that_cannot_be_printed_is_said(
    screen: Any, workspace: Path, package: str, content: str | None, text: str
) -> None:
    """With what there is instead."""
    if content is not None:
        (workspace / "src" / "my_robot" / "package.xml").write_text(content)

    with pytest.raises(CommandError, match=text):
        manifest(package, output=screen.output, tag="version")
