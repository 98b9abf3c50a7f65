"""The imports of programs are listed without running them."""

from __future__ import annotations

import sys
from importlib.machinery import EXTENSION_SUFFIXES
from pathlib import Path

import pytest

from aionode.rclpy._check import check


@pytest.fixture
def program(tmp_path: Path) -> Path:
    """A program that is not written yet, alone in its folder."""
    return tmp_path / "program.py"


def findings(file: Path, source: str) -> tuple[dict[str, str], bool]:
    """Return the report of each import of a program, up to a colon, and whether all exist."""
    file.write_text(source)
    text, complete = check([str(file)])
    first, *lines = text.splitlines()
    assert first == str(file)
    found = (line.split(maxsplit=1) for line in lines)
    return {name: where.partition(":")[0] for name, where in found}, complete


def test_each_import_has_its_source(program: Path) -> None:
    """Python's own modules always exist, and would hide the rest."""
    (program.parent / "helper.py").write_text("raise SystemExit\n")

    found, complete = findings(
        program,
        "import os, numpy.linalg\nimport rclpy.node, helper\n"
        "from std_msgs.msg import String, String_\n"
        "from . import beside\nfrom __future__ import annotations\n",
    )

    assert found == {
        "numpy.linalg": "installed",
        "rclpy.node": "aionode",
        "helper": "beside the program",
        "std_msgs.msg": "aionode",
    }
    assert complete


def test_packages_of_the_workspace_are_there(tmp_path: Path) -> None:
    """They need no build, neither for their modules nor for their messages."""
    for name in ("own_robot", "own_msgs"):
        (tmp_path / "src" / name).mkdir(parents=True)
        (tmp_path / "src" / name / "package.xml").write_text(f"<name>{name}</name>")
    (tmp_path / "src" / "own_msgs" / "msg").mkdir()
    (tmp_path / "src" / "own_msgs" / "msg" / "Words.msg").write_text("int8 value\n")
    (tmp_path / "src" / "own_robot" / "own_robot").mkdir()
    (tmp_path / "src" / "own_robot" / "own_robot" / "__init__.py").write_text("")
    (tmp_path / "src" / "own_msgs" / "scripts").mkdir()

    found, complete = findings(
        tmp_path / "src" / "own_msgs" / "scripts" / "tool.py",
        "import own_robot, own_robot.nothing\n"
        "from own_msgs.msg import Words\nfrom own_msgs.srv import Ask\n",
    )

    assert found == {
        "own_robot": f"in {tmp_path / 'src' / 'own_robot'}",
        "own_robot.nothing": "missing",
        "own_msgs.msg": f"in {tmp_path / 'src' / 'own_msgs'}",
        "own_msgs.srv": "missing",
    }
    assert not complete


@pytest.mark.parametrize(
    ("line", "shown"),
    [
        ("import plansys2_msgs.msg", "plansys2_msgs.msg"),
        ("import rclpy.nothing", "rclpy.nothing"),
        ("from rclpy import nothing", "rclpy.nothing"),
        ("from rclpy.node import Nodes", "rclpy.node.Nodes"),
        ("from std_msgs.msg import Strin", "std_msgs.msg.Strin"),
        ("from std_msgs import srv", "std_msgs.srv"),
        ("import numpy.nothing", "numpy.nothing"),
        ("def late():\n    import nothing_at_all", "nothing_at_all"),
    ],
)
def test_what_is_missing_is_found(program: Path, line: str, shown: str) -> None:
    """Modules, names that aionode's modules lack, and imports within functions."""
    assert findings(program, line) == ({shown: "missing"}, False)


def test_an_import_that_may_fail_is_optional(program: Path) -> None:
    """The program has an alternative."""
    source = "try:\n    import nothing_at_all\nexcept ImportError:\n    pass\n"

    assert findings(program, source) == ({"nothing_at_all": "missing, optional"}, True)


@pytest.mark.parametrize("condition", ["TYPE_CHECKING", "typing.TYPE_CHECKING"])
def test_imports_for_type_checkers_are_left_out(program: Path, condition: str) -> None:
    """They do not happen."""
    source = f"import typing\nif {condition}:\n    import nothing_at_all\n"

    assert findings(program, source) == ({}, True)


def test_messages_beside_modules_of_the_same_package_are_there(tmp_path: Path) -> None:
    """A package that generates messages may also have Python modules under its name."""
    package = tmp_path / "src" / "own_robot"
    for folder in ("own_robot", "msg", "scripts"):
        (package / folder).mkdir(parents=True)
    (package / "package.xml").write_text("<name>own_robot</name>")
    (package / "own_robot" / "__init__.py").write_text("")
    (package / "msg" / "Words.msg").write_text("int8 value\n")

    found, complete = findings(
        package / "scripts" / "program.py",
        "import own_robot\nfrom own_robot.msg import Words\n",
    )

    assert list(found) == ["own_robot", "own_robot.msg"]
    assert complete


def test_a_folder_stands_for_its_programs(tmp_path: Path) -> None:
    """The programs of a package find one another; copies made by a build are left out."""
    package = tmp_path / "src" / "my_robot" / "my_robot"
    package.mkdir(parents=True)
    (package / "__init__.py").write_text("")
    (package / "driver.py").write_text("from my_robot.wheels import turn\n")
    (package / "wheels.py").write_text("")
    for copied in ("build", ".venv"):
        (tmp_path / copied).mkdir()
        (tmp_path / copied / "old.py").write_text("import nothing_at_all\n")

    text, complete = check([str(tmp_path)])

    assert [line for line in text.splitlines() if not line.endswith(".py")] == [
        "  my_robot.wheels  beside the program"
    ]
    assert complete


def test_a_file_that_python_cannot_read_is_named(program: Path) -> None:
    """The other files are listed nevertheless."""
    program.write_text("def work(:\n")

    text, complete = check([str(program)])

    assert text.startswith(f"{program}\n  cannot be read: ")
    assert not complete


def test_nothing_of_a_program_is_imported(program: Path) -> None:
    """Its modules may move a robot when they are imported."""
    (program.parent / "mover").mkdir()
    (program.parent / "mover" / "__init__.py").write_text("raise SystemExit\n")
    (program.parent / "mover" / "arm.py").write_text("raise SystemExit\n")

    assert findings(program, "import mover.arm\n") == ({"mover.arm": "beside the program"}, True)
    assert "mover" not in sys.modules


@pytest.mark.parametrize(
    "line",
    [
        "from launch.actions.execute_process import ExecuteProcess",
        "import launch.substitutions.path_join_substitution",
        "from std_msgs.msg._string import String",
        "from own_namespace import module",
        "import own_namespace.module",
        "from .own_namespace.module import x",
    ],
)
def test_what_the_program_finds_is_there(program: Path, line: str) -> None:
    """Modules of one class, of a message, and in folders without an ``__init__.py``."""
    (program.parent / "own_namespace").mkdir()
    (program.parent / "own_namespace" / "module.py").write_text("")

    found, complete = findings(program, line)

    assert complete
    assert "missing" not in found.values()


@pytest.mark.parametrize(
    "line",
    [
        "from launch.actions.execute_process import ExecuteProces",
        "import std_msgs.msg._nothing",
        "from .nothing import x",
    ],
)
def test_what_only_looks_like_a_module_is_missing(program: Path, line: str) -> None:
    """The same ways, with a name that does not exist."""
    found, complete = findings(program, line)

    assert list(found.values()) == ["missing"]
    assert not complete


def test_a_module_that_lacks_an_extra_is_missing(
    program: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It is aionode's, and cannot be imported; the extra is named."""

    def fail(name: str) -> None:
        raise ModuleNotFoundError("aionode.bag: lz4 is not installed; pip install 'aionode[bag]'")

    monkeypatch.setattr("aionode.rclpy._check.import_module", fail)
    program.write_text("import rosbag2_py\n")

    text, complete = check([str(program)])

    assert "missing: aionode.bag: lz4 is not installed; pip install 'aionode[bag]'" in text
    assert not complete


@pytest.mark.parametrize(
    "line",
    [
        "import own.part",
        "from own import part",
        "from .own.part import x",
        "from own.part import x",
    ],
)
@pytest.mark.parametrize("is_optional", [False, True])
def test_the_own_modules_of_a_program_are_followed(
    program: Path, line: str, is_optional: bool
) -> None:
    """The program needs what they import, unless it can do without them."""
    (program.parent / "own").mkdir()
    (program.parent / "own" / "__init__.py").write_text("import numpy\n")
    (program.parent / "own" / "part.py").write_text("from . import part\nimport nothing_at_all\n")
    guarded = f"import contextlib\nwith contextlib.suppress(ImportError):\n    {line}\n"
    program.write_text(guarded if is_optional else line)

    text, complete = check([str(program)])

    assert f"{program.parent / 'own' / 'part.py'}\n  nothing_at_all  missing: " in text
    assert f"{program.parent / 'own' / '__init__.py'}\n  numpy  installed\n" in text
    assert complete is is_optional


@pytest.mark.parametrize(
    ("source", "found"),
    [
        (
            "try:\n    import nothing_a\nexcept ImportError:\n    import nothing_b\n",
            {"nothing_a": "missing, optional", "nothing_b": "missing"},
        ),
        (
            (
                "import sys\ntry:\n    import nothing_a\nexcept ImportError as error:\n"
                "    print(error)\n    sys.exit(1)\n"
            ),
            {"nothing_a": "missing"},
        ),
        (
            (
                "try:\n    import nothing_a\nexcept ImportError as error:\n"
                "    raise RuntimeError from error\n"
            ),
            {"nothing_a": "missing"},
        ),
        ("import importlib\nimportlib.import_module('nothing_a')\n", {"nothing_a": "missing"}),
        ("import msvcrt\n", {"msvcrt": "missing"}),
    ],
    ids=["no way is there", "exits", "raises", "by a function", "of another system"],
)
def test_what_ends_the_program_is_not_called_optional(
    program: Path, source: str, found: dict[str, str]
) -> None:
    """The check's status would say that it runs."""
    assert findings(program, source) == (found, False)


@pytest.mark.parametrize(
    "source",
    [
        "try:\n    import sys\nexcept ImportError:\n    import nothing_a\n",
        (
            "try:\n    import numpy\nexcept ImportError:\n    try:\n        import nothing_a\n"
            "    except ImportError:\n        import nothing_b\n"
        ),
        "import sys\nif sys.version_info < (3, 8):\n    import nothing_a\n",
        "import os\nif os.name == 'nt':\n    import msvcrt\nelse:\n    import termios\n",
        "import sys\nif not sys.platform.startswith('linux'):\n    import nothing_a\n",
        "if False:\n    import nothing_a\n",
    ],
)
def test_what_does_not_happen_here_is_not_missed(program: Path, source: str) -> None:
    """Programs have imports for older Python versions, for other systems, and as fallbacks."""
    _, complete = findings(program, source)

    assert complete


@pytest.mark.parametrize(
    "source",
    ["total = 0" + " + 1" * 1500 + "\n", "built = make()" + ".part()" * 900 + "\n"],
    ids=["a long sum", "a long chain of calls"],
)
def test_an_expression_may_be_deeply_nested(program: Path, source: str) -> None:
    """As in generated tables; a traceback is not an answer."""
    assert findings(program, source + "import nothing_a\n") == ({"nothing_a": "missing"}, False)


def test_a_program_nested_deeper_than_python_recurses_is_said_to_be_unreadable(
    program: Path,
) -> None:
    """It is the file's fault, so the others of a folder are still examined."""
    program.write_text("if a == 0:\n    pass\n" + "elif a == 1:\n    pass\n" * 1500)

    text, complete = check([str(program)])

    assert "cannot be read: " in text
    assert not complete


def test_a_compiled_module_beside_the_program_is_there(program: Path) -> None:
    """It has no source that could be examined."""
    (program.parent / f"fast{EXTENSION_SUFFIXES[0]}").write_bytes(b"\0")

    assert findings(program, "import fast\n") == ({"fast": "beside the program"}, True)


@pytest.fixture
def server(tmp_path: Path) -> Path:
    """A program whose package imports its own modules by their full names, and one beside it."""
    (tmp_path / "backend" / "ws").mkdir(parents=True)
    (tmp_path / "backend" / "__init__.py").write_text("")
    (tmp_path / "backend" / "settings.py").write_text("")
    (tmp_path / "backend" / "ws" / "arm.py").write_text("import backend.settings, stream\n")
    (tmp_path / "stream.py").write_text("")
    program = tmp_path / "server.py"
    program.write_text("import backend.ws.arm\n")
    return program


@pytest.mark.parametrize("of_folder", [False, True])
def test_modules_find_what_lies_beside_the_program_that_imports_them(
    server: Path, of_folder: bool
) -> None:
    """As in Python, whose path begins with the folder of the program, not with that of a module."""
    text, complete = check([str(server.parent if of_folder else server)])

    shown = "  backend.settings  beside the program\n  stream            beside the program\n"
    assert f"{server.parent / 'backend' / 'ws' / 'arm.py'}\n{shown}" in text
    assert complete


def test_a_module_alone_does_not_find_what_lies_beside_its_program(server: Path) -> None:
    """Whoever runs it himself would see it fail."""
    text, complete = check([str(server.parent / "backend" / "ws" / "arm.py")])

    assert "  stream            missing: " in text
    assert not complete


def test_a_module_is_incomplete_if_one_of_its_programs_lacks_a_part(server: Path) -> None:
    """That program would fail."""
    other = server.parent / "other" / "tool.py"
    other.parent.mkdir()
    (other.parent / "backend").symlink_to(server.parent / "backend")
    other.write_text("import backend.ws.arm\n")

    text, complete = check([str(server), str(other)])

    assert "  stream            missing: " in text
    assert not complete
