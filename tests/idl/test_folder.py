"""Loading a folder of ROS packages at run time."""

from __future__ import annotations

import importlib
import pickle
from pathlib import Path

import pytest

from aionode.errors import IdlError, InterfaceNotFoundError
from aionode.idl import define, definition_text, load_interfaces
from aionode.interfaces import get_interface, interface_names
from aionode.interfaces.geometry_msgs.msg import Point
from aionode.interfaces.std_msgs.msg import Header, String
from aionode.message import Message, ServiceType, fields, type_name


def write(root: Path, **files: str) -> Path:
    """Write files; ``a__b__C_msg`` is ``a/b/C.msg``."""
    for name, text in files.items():
        *folders, last = name.split("__")
        file = root.joinpath(*folders, last.replace("_", "."))
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")
    return root


@pytest.fixture
def workspace(tmp_path: Path) -> Path:
    """A folder with two packages, one of which uses the other and a shipped one."""
    return write(
        tmp_path,
        src__loaded_one__msg__Spot_msg="# Where it is.\nstd_msgs/Header header\nPlace place\n",
        src__loaded_one__msg__Place_msg="geometry_msgs/Point[] corners\n",
        src__loaded_two__srv__Find_srv="string name\n---\nloaded_one/Spot spot\n",
        src__loaded_two__action__Walk_action="loaded_one/msg/Place to\n---\n---\nfloat32 done 0.5",
    )


def test_a_workspace_becomes_classes(workspace: Path) -> None:
    """By name and by attribute, in any order of use."""
    loaded = load_interfaces(workspace)

    assert list(loaded) == [
        "loaded_one/msg/Place",
        "loaded_one/msg/Spot",
        "loaded_two/action/Walk",
        "loaded_two/srv/Find",
    ]
    assert loaded.loaded_one.msg.Spot is loaded["loaded_one/msg/Spot"]
    assert loaded.loaded_two.action.Walk.Feedback().done == 0.5
    spot = loaded.loaded_two.srv.Find.Response().spot
    assert isinstance(spot, loaded.loaded_one.msg.Spot)
    assert isinstance(spot.header, Header)
    assert spot.place.corners == []
    assert loaded.loaded_one.msg.Spot.__doc__ == "Where it is."
    assert repr(loaded) == "Interfaces(4 types of loaded_one, loaded_two)"
    assert len(loaded) == 4


def test_loaded_packages_can_be_imported(workspace: Path) -> None:
    """Under aionode.interfaces, like those that are shipped; so pickle works, too."""
    loaded = load_interfaces(workspace)
    module = importlib.import_module("aionode.interfaces.loaded_one.msg")

    assert module.Spot is loaded.loaded_one.msg.Spot
    assert get_interface("loaded_two/srv/Find") is loaded["loaded_two/srv/Find"]
    assert "loaded_one/msg/Place" in interface_names()
    spot = module.Spot(header=Header(frame_id="map"))
    assert pickle.loads(pickle.dumps(spot)) == spot  # noqa: S301 (made one line above)


def test_loading_again_gives_the_same_classes(workspace: Path) -> None:
    """Two parts of a program may both load what they need."""
    assert load_interfaces(workspace)["loaded_one/msg/Spot"] is get_interface("loaded_one/msg/Spot")
    assert dict(load_interfaces(workspace)) == dict(load_interfaces(workspace))


def test_a_copy_of_a_shipped_type_is_the_shipped_type(tmp_path: Path) -> None:
    """So a workspace that brings std_msgs along works with everything else."""
    write(
        tmp_path,
        std_msgs__msg__String_msg="string data\n",
        my_msgs__msg__A_msg="std_msgs/String s\n",
    )

    assert load_interfaces(tmp_path)["std_msgs/msg/String"] is String
    assert load_interfaces(tmp_path, reuse=False)["std_msgs/msg/String"] is not String


def test_a_type_of_another_distribution_replaces_the_shipped_one_in_what_uses_it(
    tmp_path: Path,
) -> None:
    """Humble's Range has no variance; its users load Humble's definitions."""
    write(
        tmp_path,
        sensor_msgs__msg__Range_msg="std_msgs/Header header\nfloat32 range\n",
        my_msgs__msg__Two_msg="sensor_msgs/Range left\nsensor_msgs/Range right\n",
    )
    loaded = load_interfaces(tmp_path)

    assert [field.name for field in fields(loaded["sensor_msgs/msg/Range"])] == ["header", "range"]
    assert type(loaded.my_msgs.msg.Two().left) is loaded["sensor_msgs/msg/Range"]
    assert len(fields(get_interface("sensor_msgs/msg/Range"))) == 7


def test_one_package_can_be_loaded(workspace: Path) -> None:
    """The path of the package itself is as good as that of its workspace."""
    assert len(load_interfaces(workspace / "src" / "loaded_one")) == 2


def test_package_xml_names_the_package(tmp_path: Path) -> None:
    """A repository may be called otherwise than its package."""
    write(
        tmp_path, repo__msg__A_msg="", repo__package_xml="<package><name>my_msgs</name></package>"
    )

    assert list(load_interfaces(tmp_path)) == ["my_msgs/msg/A"]


def test_the_same_definition_twice_is_no_conflict(tmp_path: Path) -> None:
    """A workspace has its packages in src and in install."""
    write(tmp_path, src__my_msgs__msg__A_msg="int8 x", install__share__my_msgs__msg__A_msg="int8 x")

    assert list(load_interfaces(tmp_path)) == ["my_msgs/msg/A"]


def test_two_different_definitions_of_a_type_are_an_error(tmp_path: Path) -> None:
    """It is impossible to know which one is meant."""
    write(tmp_path, a__my_msgs__msg__A_msg="int8 x", b__my_msgs__msg__A_msg="int16 x")

    with pytest.raises(IdlError, match="my_msgs/msg/A is defined differently in"):
        load_interfaces(tmp_path)


@pytest.mark.parametrize(
    ("text", "place", "problem"),
    [
        ("int8 x\nNope y\n", ":2:1: ", "no message type 'Nope' here or in aionode.interfaces"),
        ("std_msgs/Strin x", ":1:1: ", "did you mean std_msgs/msg/String?"),
        ("Header header", ":1:1: ", "did you mean std_msgs/Header?"),
        ("A a", ":1:1: ", "my_msgs/msg/A uses my_msgs/msg/A: a message cannot contain itself"),
        (
            "B b",
            ":1:1: ",
            "my_msgs/msg/A uses my_msgs/msg/B uses my_msgs/msg/A: a message cannot contain itself",
        ),
        ("int9 x", ":1:1: ", "'int9' is not a type"),
    ],
)
def test_an_error_names_the_file(tmp_path: Path, text: str, place: str, problem: str) -> None:
    """With line and column."""
    write(tmp_path, my_msgs__msg__A_msg=text, my_msgs__msg__B_msg="A a" if text == "B b" else "")

    with pytest.raises(IdlError) as caught:
        load_interfaces(tmp_path)
    assert place in str(caught.value)
    assert problem in str(caught.value)
    assert caught.value.file.endswith(".msg")


def test_bad_names_of_files_are_errors(tmp_path: Path) -> None:
    """They become names of classes and packages."""
    with pytest.raises(IdlError, match="'lower' is not a valid type name"):
        load_interfaces(write(tmp_path / "a", my_msgs__msg__lower_msg=""))
    with pytest.raises(IdlError, match="'My-msgs' is not a valid package name"):
        load_interfaces(write(tmp_path / "b", **{"My-msgs__msg__A_msg": ""}))


def test_a_file_that_is_not_utf_8_is_an_error(tmp_path: Path) -> None:
    """With the line of the first such byte."""
    write(tmp_path, my_msgs__msg__A_msg="")
    (tmp_path / "my_msgs" / "msg" / "A.msg").write_bytes(b"int8 x\nstring y \xff\n")

    with pytest.raises(IdlError, match=r"A\.msg:2: not UTF-8"):
        load_interfaces(tmp_path)


def test_a_folder_that_is_not_there_is_an_error(tmp_path: Path) -> None:
    """An empty result would hide a mistyped path."""
    with pytest.raises(FileNotFoundError, match="no such folder"):
        load_interfaces(tmp_path / "nope")


def test_a_package_that_was_not_loaded_is_an_attribute_error(workspace: Path) -> None:
    """With the packages there are."""
    with pytest.raises(AttributeError, match="loaded packages: loaded_one, loaded_two"):
        load_interfaces(workspace).nope  # noqa: B018 (the access is the test)


def test_a_definition_can_be_given_as_text() -> None:
    """From a recording or a web page."""
    words = define("as_text/msg/Words", "string text\ngeometry_msgs/Point[2] ends\n")
    service = define(
        "as_text/srv/Say", "as_text/Words w\n---\n", types={"as_text/msg/Words": words}
    )

    assert words().ends == [Point(), Point()]
    assert issubclass(words, Message)
    assert issubclass(service, ServiceType)
    assert type_name(service.Event) == "as_text/srv/Say_Event"
    assert definition_text(service) == "Words w\n---\n"
    with pytest.raises(InterfaceNotFoundError):
        get_interface("as_text/msg/Words")
    with pytest.raises(TypeError, match="not a valid ROS type name"):
        define("Words", "string text")
