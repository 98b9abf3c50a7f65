"""``aionode interface``."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from aionode.cli._main import main
from aionode.cli._nouns.interface import list_interfaces, package, packages, proto, show
from aionode.errors import CommandError
from aionode.interfaces import get_interface
from tests.support.strategies import shipped_types


def test_show_prints_a_service(screen: Any) -> None:
    """Recorded with ros2."""
    show(get_interface("example_interfaces/srv/AddTwoInts"), output=screen.output, comments="none")

    assert screen.text == "int64 a\nint64 b\n---\nint64 sum\n"


def test_show_says_what_a_type_is_for(screen: Any) -> None:
    """A service as a whole, and each of its halves; `ros2 interface show` has other comments."""
    own = "# Comments: aionode's own; a sourced ROS 2 has those of its files.\n\n"
    show(get_interface("std_srvs/srv/Trigger"), output=screen.output)
    show(get_interface("geometry_msgs/msg/Point"), output=screen.output)

    assert screen.text == (
        f"{own}"
        "# Have something done that needs no arguments.\n\n"
        "# Nothing: the call is the request.\n"
        "---\n"
        "# Whether it was done, and a text about it.\n\n"
        "bool success\nstring message\n"
        f"{own}"
        "# A point in space: coordinates in m.\n\n"
        "float64 x\nfloat64 y\nfloat64 z\n"
    )


@pytest.mark.slow
def test_every_shipped_type_has_comments(screen: Any) -> None:
    """A placeholder such as "The request of GetMap." does not count."""
    for name in shipped_types():
        if name.startswith("test_msgs/"):
            continue
        seen = len(screen.text)
        show(get_interface(name), output=screen.output)
        shown = screen.text[seen:]

        assert shown.startswith("# ") or "\n# " in shown, name
        assert "# The request of" not in shown, name


def test_show_indents_what_is_inside(screen: Any) -> None:
    """With tabs, as ros2."""
    show(get_interface("geometry_msgs/msg/Twist"), output=screen.output, comments="none")

    vector = "\tfloat64 x\n\tfloat64 y\n\tfloat64 z\n"
    assert screen.text == f"Vector3 linear\n{vector}Vector3 angular\n{vector}"


def test_show_says_what_fields_mean(screen: Any) -> None:
    """Units above all; nested types only on request."""
    show(get_interface("geometry_msgs/msg/Twist"), output=screen.output)

    assert screen.text.partition("\n\n")[2].startswith(
        "# A velocity: what `/cmd_vel` carries.\n\n"
        "# In m/s; x is forward, y to the left, z up.\nVector3 linear\n\t"
    )
    assert screen.text.count("#") == 4  # the first says to what the comments belong


def test_show_prints_the_comments_of_the_installed_file(
    screen: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """ROS's other tools show that file."""
    folder = tmp_path / "share" / "geometry_msgs" / "msg"
    folder.mkdir(parents=True)
    (folder / "Vector3.msg").write_text("float64 x  # first\nfloat64 y\nfloat64 z\n")
    text = "# A twist.\n\nVector3  linear\nVector3  angular # at last\n"
    (folder / "Twist.msg").write_text(text)
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))

    show(get_interface("geometry_msgs/msg/Twist"), output=screen.output, comments="all")

    vector = "\tfloat64 x  # first\n\tfloat64 y\n\tfloat64 z\n"
    expected = f"# A twist.\n\nVector3  linear\n{vector}Vector3  angular # at last\n{vector}"
    assert screen.text == expected


def test_proto_prints_what_can_be_filled_in(screen: Any) -> None:
    """Recorded with ros2, quotes included."""
    proto(get_interface("geometry_msgs/msg/Twist"), output=screen.output)

    vector = "  x: 0.0\n  y: 0.0\n  z: 0.0\n"
    assert screen.text == f'"linear:\n{vector}angular:\n{vector}"\n'


def test_proto_of_a_service_is_its_request(screen: Any) -> None:
    """Users type it for ``service call``."""
    proto(get_interface("example_interfaces/srv/AddTwoInts"), quotes=False, output=screen.output)

    assert screen.text == "a: 0\nb: 0\n\n"


def test_package_lists_the_types_of_one(screen: Any) -> None:
    """By name; kinds can be chosen."""
    package("std_srvs", output=screen.output)
    package("std_srvs", kinds=("msg",), output=screen.output)

    assert screen.text == "std_srvs/srv/Empty\nstd_srvs/srv/SetBool\nstd_srvs/srv/Trigger\n"


def test_an_unknown_package_is_named_with_one_like_it(screen: Any) -> None:
    """The error names what was given and what is expected."""
    with pytest.raises(
        CommandError, match=r"Unknown package 'std_msg'\. Did you mean 'std_msgs'\?"
    ):
        package("std_msg", output=screen.output)


def test_packages_can_be_chosen_by_kind(screen: Any) -> None:
    """Few packages have actions."""
    packages(kinds=("action",), output=screen.output)

    assert "example_interfaces\n" in screen.text
    assert "std_msgs\n" not in screen.text


def test_list_has_a_heading_for_each_kind(screen: Any) -> None:
    """As ros2's; programs get one record for each type."""
    list_interfaces(output=screen.output)

    lines = screen.text.splitlines()
    assert [line for line in lines if not line.startswith(" ")] == [
        "Messages:",
        "Services:",
        "Actions:",
    ]
    assert "    std_msgs/msg/String" in lines


@pytest.fixture
def workspace(tmp_path: Path) -> Path:
    """A folder with a package of the user's own."""
    folder = tmp_path / "tutorial_cli_msgs" / "msg"
    folder.mkdir(parents=True)
    (folder / "Words.msg").write_text("string text\nfloat32[] scores\n")
    return tmp_path


def test_own_definitions_are_loaded_on_request(
    workspace: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Without a build step."""
    status = main(
        ["interface", "show", "tutorial_cli_msgs/msg/Words", "--interfaces", str(workspace)]
    )

    assert (status, capsys.readouterr().out) == (0, "string text\nfloat32[] scores\n")


def test_generate_writes_modules(
    workspace: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """It prints which ones."""
    status = main(["interface", "generate", str(workspace), "-o", str(tmp_path / "out")])

    files = [Path(line) for line in capsys.readouterr().out.splitlines()]
    assert status == 0
    assert (tmp_path / "out/tutorial_cli_msgs/msg.py").resolve() in files
    assert all(file.is_file() for file in files)
