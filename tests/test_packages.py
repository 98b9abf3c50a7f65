"""Packages of a workspace and installed ones: where they lie, what they start, by which command."""

from __future__ import annotations

import os
import sys
from importlib import import_module
from pathlib import Path
from pkgutil import walk_packages

import pytest

from aionode import Node, programs
from aionode._packages import Packages, program_module, workspace_of
from aionode._packages._share import share_of
from aionode._packages._standard import MODULES, PLUGINS, standard_plugin
from aionode.errors import ExecutableNotFoundError, PackageNotFoundError

SETUP = """\
import os
from setuptools import setup

raise SystemExit("not to be executed")
package_name = 'my_robot'
SCRIPTS = [f'{package_name}_mover = {package_name}.mover:main', 'stopper=my_robot.stopper:stop [x]']
setup(
    name=package_name,
    data_files=[
        (os.path.join('lib', package_name), ['scripts/dance.py']),
        (os.path.join('share', package_name), glob('launch/*')),
    ],
    entry_points={'console_scripts': SCRIPTS + ['late = my_robot.late:main']},
)
"""

CMAKE = """\
project(cpp_robot)
# install(PROGRAMS scripts/old.py DESTINATION lib/cpp_robot)
install(PROGRAMS
  scripts/plan.py
  "scripts/drive.sh"
  DESTINATION lib/${PROJECT_NAME}
)
install(FILES scripts/plan.py DESTINATION lib/${PROJECT_NAME}/ RENAME planner)
"""


def write(folder: Path, files: dict[str, str]) -> None:
    """Write files below a folder."""
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)


@pytest.fixture
def workspace(tmp_path: Path) -> Path:
    """A workspace as colcon knows it: sources, and a stale copy in its build folder."""
    write(
        tmp_path / "src",
        {
            "team/robot/package.xml": "<package><name>my_robot</name></package>",
            "team/robot/setup.py": SETUP,
            "team/robot/scripts/dance.py": "",
            "team/robot/my_robot/__init__.py": "",
            "team/robot/my_robot/mover.py": "",
            "cpp_robot/package.xml": "<package><name> cpp_robot </name></package>",
            "cpp_robot/CMakeLists.txt": CMAKE,
            "cpp_robot/scripts/plan.py": "",
            "cpp_robot/scripts/drive.sh": "#!/bin/sh\n",
            "cfg_robot/package.xml": "<package><name>cfg_robot</name></package>",
            "cfg_robot/setup.cfg": "[options.entry_points]\nconsole_scripts=\n go=cfg_robot:go\n",
            "cfg_robot/src/cfg_robot/__init__.py": "",
            "toml_robot/package.xml": "<package><name>toml_robot</name></package>",
            "toml_robot/pyproject.toml": "[project.scripts]\ngo = 'toml_robot:go'\n",
            "left_out/COLCON_IGNORE": "",
            "left_out/robot/package.xml": "<package><name>left_out</name></package>",
            "cpp_robot/inner/package.xml": "<package><name>inner</name></package>",
            "build/my_robot/package.xml": "<package><name>built</name></package>",
        },
    )
    return tmp_path


def test_the_packages_of_a_workspace_are_those_that_colcon_finds(workspace: Path) -> None:
    """Folders that are ignored, built, or inside another package are left out."""
    known = Packages(workspace).sources()

    assert sorted(known) == ["cfg_robot", "cpp_robot", "my_robot", "toml_robot"]
    assert known["my_robot"] == workspace / "src" / "team" / "robot"
    assert Packages(workspace).share("cpp_robot") == workspace / "src" / "cpp_robot"


def test_executables_are_read_from_setup_files_and_nothing_is_executed(workspace: Path) -> None:
    """A setup.py is read as text: it may do anything when it runs."""
    packages = Packages(workspace)

    targets = {one.name: one.target for one in packages.executables("my_robot").values()}
    assert targets == {
        "dance.py": str(workspace / "src/team/robot/scripts/dance.py"),
        "late": "my_robot.late:main",
        "my_robot_mover": "my_robot.mover:main",
        "stopper": "my_robot.stopper:stop",
    }
    assert sorted(packages.executables("cpp_robot")) == ["drive.sh", "plan.py", "planner"]
    assert list(packages.executables("cfg_robot")) == ["go"]
    assert list(packages.executables("toml_robot")) == ["go"]


def test_the_command_of_an_executable_has_all_that_its_process_needs(workspace: Path) -> None:
    """It runs in any folder: of launch files, too, which start many of them."""
    packages = Packages(workspace)
    own = [sys.executable, "-m", "aionode.rclpy", "--workspace", str(workspace / "src")]

    assert packages.command("my_robot", "stopper") == [
        *own,
        "--path",
        str(workspace / "src/team/robot"),
        "-m",
        "my_robot.stopper:stop",
    ]
    root = str(workspace / "src/cfg_robot/src")
    assert packages.command("cfg_robot", "go") == [*own, "--path", root, "-m", "cfg_robot:go"]
    plan = str(workspace / "src/cpp_robot/scripts/plan.py")
    assert packages.command("cpp_robot", "planner", ["--interfaces", "x"]) == [
        *own,
        "--interfaces",
        "x",
        plan,
    ]
    drive = str(workspace / "src/cpp_robot/scripts/drive.sh")
    assert packages.command("cpp_robot", "drive.sh") == [drive]


def test_installed_executables_come_after_those_of_the_source(
    workspace: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """An install space has the compiled ones, and perhaps stale copies of the others."""
    prefix = tmp_path / "install"
    marker = "share/ament_index/resource_index/packages"
    write(prefix, {f"{marker}/cpp_robot": "", f"{marker}/far_robot": ""})
    write(
        prefix, {"lib/cpp_robot/compiled": "", "lib/cpp_robot/planner": "", "lib/cpp_robot/x": ""}
    )
    write(prefix, {"lib/far_robot/far": "#!/usr/bin/python3\n"})
    for name in ("cpp_robot/compiled", "cpp_robot/planner", "far_robot/far"):
        (prefix / "lib" / name).chmod(0o755)
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(prefix))
    packages = Packages(workspace)

    assert sorted(packages.executables("cpp_robot")) == [
        "compiled",
        "drive.sh",
        "plan.py",
        "planner",
    ]
    assert packages.command("cpp_robot", "compiled") == [str(prefix / "lib/cpp_robot/compiled")]
    assert packages.command("cpp_robot", "planner")[-1].endswith("src/cpp_robot/scripts/plan.py")
    far = str(prefix / "lib/far_robot/far")
    assert Packages().command("far_robot", "far") == [sys.executable, "-m", "aionode.rclpy", far]
    assert packages.share("far_robot") == prefix / "share" / "far_robot"


def test_what_is_missing_is_named_with_its_places_and_what_is_close(workspace: Path) -> None:
    """A typing error is the usual reason."""
    packages = Packages(workspace)

    with pytest.raises(PackageNotFoundError) as no_package:
        packages.command("my_robto", "mover")
    with pytest.raises(ExecutableNotFoundError) as no_executable:
        packages.command("my_robot", "dance")
    with pytest.raises(ExecutableNotFoundError, match=r"its executables: drive\.sh, plan\.py, pl"):
        packages.command("cpp_robot", "zzz")
    with pytest.raises(FileNotFoundError, match=r"nowhere: no such folder"):
        Packages(workspace / "nowhere")

    assert str(no_package.value).startswith(
        f"package 'my_robto': not found in {workspace / 'src'}, {sys.prefix}; "
        "did you mean my_robot?"
    )
    assert str(no_executable.value).startswith(
        f"package 'my_robot': no executable 'dance' in {workspace / 'src/team/robot'}; "
        "did you mean dance.py?"
    )


def test_the_workspace_is_around_the_place(workspace: Path, tmp_path: Path) -> None:
    """In a workspace, a package, a repository of packages, and in none of them."""
    write(tmp_path, {"repo/.git/HEAD": "", "repo/one/package.xml": "", "alone/package.xml": ""})
    write(tmp_path, {"plain/tool.py": ""})

    places = {
        ".": "src",
        "src/team/robot/my_robot/mover.py": "src",
        "src/team": "src",
        "repo/one": "repo",
        "repo": "repo",
        "alone": "alone",
    }
    for place, expected in places.items():
        assert workspace_of(workspace / place) == workspace / expected
    assert workspace_of(workspace / "plain" / "tool.py") is None


def test_a_folder_that_leads_back_to_itself_ends(tmp_path: Path) -> None:
    """Links in a workspace may point anywhere."""
    write(tmp_path, {"src/robot/package.xml": "<name>robot</name>"})
    (tmp_path / "src" / "again").symlink_to(tmp_path)

    assert list(Packages(tmp_path).sources()) == ["robot"]


def test_a_link_to_itself_hides_no_package(tmp_path: Path) -> None:
    """Nor does a link into a folder of another user: the system cannot say what either is."""
    write(tmp_path / "robot", {"package.xml": "<name>robot</name>"})
    (tmp_path / "loop").symlink_to("loop")

    assert list(Packages(tmp_path).sources()) == ["robot"]


@pytest.mark.skipif(os.name != "posix", reason="needs a pipe with a name")
def test_a_setup_file_that_is_no_file_is_not_read(tmp_path: Path) -> None:
    """Reading a pipe or a device would never end."""
    os.mkfifo(tmp_path / "setup.py")

    assert Packages(tmp_path).module_root("pieces") is None


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("setup.py", "setup(package_dir={'': 'code'})"),
        ("setup.py", "setup(package_dir={'pieces': 'code/pieces'})"),
        ("setup.cfg", "[options]\npackage_dir =\n  = code"),
        ("setup.cfg", "[metadata]\nname = x\n[options.packages.find]\nwhere = code"),
        ("pyproject.toml", "[build-system]\n[tool.setuptools]\npackage-dir = {'' = 'code'}"),
        ("pyproject.toml", "[project]\n[tool.setuptools.packages.find]\nwhere = ['code']"),
        ("pyproject.toml", "[tool.poetry]\npackages = [{include = 'pieces', from = 'code'}]"),
    ],
)
def test_modules_of_a_python_project_are_found_in_the_folder_that_it_names(
    name: str, text: str, tmp_path: Path
) -> None:
    """A workspace's libraries need not be ROS packages."""
    write(tmp_path / "team/one", {name: text, "code/pieces/__init__.py": "", "other.py": ""})

    packages = Packages(tmp_path)

    assert packages.module_root("pieces") == tmp_path / "team/one/code"
    assert packages.module_root("other") is None
    assert packages.sources() == {}


def test_modules_of_other_python_projects_are_in_their_folder_or_in_src(tmp_path: Path) -> None:
    """Those are the places of most build backends."""
    for name, file in {"one": "flat/__init__.py", "two": "src/inner.py"}.items():
        write(tmp_path / name, {"pyproject.toml": "[project]\nname = 'x'", file: ""})

    packages = Packages(tmp_path)

    assert packages.module_root("flat") == tmp_path / "one"
    assert packages.module_root("inner") == tmp_path / "two/src"


@pytest.mark.parametrize(
    "files",
    [
        {"pyproject.toml": "[tool.ruff]"},
        {"pyproject.toml": "[project]\n[tool.uv]\npackage = false"},
        {"pyproject.toml": "[tool.poetry]\npackage-mode = false"},
        {"pyproject.toml": "not TOML"},
        {"pyproject.toml": "x=" + "[" * 5_000},
        {"setup.py": "x=" + "[" * 5_000},
        {"setup.py": "x=a" + ".b" * 500 + "()\nsetup()"},
        {"setup.py": "#" * 200_000 + "\nsetup()"},
        {"pyproject.toml": "#" * 200_000 + "\n[project]"},
        {"setup.cfg": "#" * 200_000 + "\n[metadata]\nname = x"},
        {"setup.cfg": "[flake8]\nmax-line-length = 99"},
        {"setup.py": "setup(package_dir={'': 'elsewhere'})"},
        {"setup.py": "setup()", "COLCON_IGNORE": ""},
        {"setup.py": "setup()", "pyvenv.cfg": ""},
    ],
)
def test_a_folder_that_is_no_project_is_not_importable(
    files: dict[str, str], tmp_path: Path
) -> None:
    """Settings of tools are in the same files, and a project may say that it is not installed."""
    write(tmp_path / "one", {**files, "pieces/__init__.py": ""})

    assert Packages(tmp_path).module_root("pieces") is None


@pytest.mark.parametrize("files", [{"package.xml": "<name>x</name>"}, {}])
def test_a_setup_file_is_not_importable(files: dict[str, str], tmp_path: Path) -> None:
    """It would be executed; ``pip install`` leaves it out."""
    write(tmp_path / "one", {**files, "setup.py": "setup()", "pieces.py": ""})

    packages = Packages(tmp_path)

    assert packages.module_root("pieces") == tmp_path / "one"
    assert packages.module_root("setup") is None


def test_ros_packages_precede_projects_and_a_project_may_contain_others(tmp_path: Path) -> None:
    """Repositories with one environment for all have a project around the others."""
    project = {"pyproject.toml": "[project]"}
    write(tmp_path, {**project, "pieces/__init__.py": "", "src/alone/__init__.py": ""})
    write(tmp_path / "src/robot", {"package.xml": "<name>robot</name>", "pieces/__init__.py": ""})
    write(tmp_path / "src/robot/inner", {**project, "hidden/__init__.py": ""})
    write(tmp_path / "src/tools", {**project, "tools/__init__.py": ""})

    roots = {
        name: Packages(tmp_path).module_root(name)
        for name in ("pieces", "alone", "hidden", "tools")
    }

    assert roots == {
        "pieces": tmp_path / "src/robot",
        "alone": tmp_path / "src",
        "hidden": None,
        "tools": tmp_path / "src/tools",
    }


@pytest.fixture
def bot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A package whose launch files, models and settings are installed elsewhere than they lie."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    folder = tmp_path / "src" / "bot"
    for name in ("launch/up.launch.py", "launch/more/deep.launch.py", "config/a.yaml", "b.yaml"):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(name)
    (folder / "package.xml").write_text("<package><name>bot</name></package>")
    return folder


def shown(workspace: Path) -> dict[str, str]:
    """Return the text of each file in the share folder of the package, by its path there."""
    share_of.cache_clear()
    share = Packages(workspace).share("bot")
    return {
        str(Path(place, name).relative_to(share)): Path(place, name).read_text()
        for place, _, names in os.walk(share, followlinks=True)
        for name in names
        if name not in {"setup.py", "setup.cfg", "package.xml", "CMakeLists.txt"}
    }


DATA_FILES = """
import os
from glob import glob
from setuptools import setup
package_name = 'bot'
setup(data_files={})
"""


APPENDED = """
files = [('lib/x', unknown())]
files += more()
files.append(('share/bot', ['launch/up.launch.py']))
setup(data_files=files)
"""

OF_FOLDER = """
project(bot)
set(D ${CMAKE_CURRENT_SOURCE_DIR}/launch)
install(DIRECTORY ${D}/ DESTINATION ${CMAKE_INSTALL_DATADIR}/bot FILES_MATCHING PATTERN x)
"""

OF_PATTERN = """
file(GLOB UP launch/*.py)
install(FILES
  ${UP} DESTINATION "share/${PROJECT_NAME}/")
"""

PATH = "(f'share/{package_name}', glob(os.path.join('launch', '*')))"


@pytest.mark.parametrize(
    ("file", "text"),
    [
        ("setup.py", DATA_FILES.format("[('share/bot', glob('launch/*.py'))]")),
        ("setup.py", DATA_FILES.format("[('share/' + package_name, ['launch/up.launch.py'])]")),
        ("setup.py", DATA_FILES.format(f"[{PATH}]")),
        ("setup.py", DATA_FILES.format("[('share/{}'.format(package_name), glob('*/*.py'))]")),
        ("setup.py", DATA_FILES.format("[('share/bot', glob(d + '/*.py')) for d in ['launch']]")),
        ("setup.py", APPENDED),
        ("setup.cfg", "[options.data_files]\nshare/bot =\n  launch/*.py\n"),
        ("CMakeLists.txt", "install(FILES launch/up.launch.py DESTINATION share/${PROJECT_NAME})"),
        ("CMakeLists.txt", OF_PATTERN),
        ("CMakeLists.txt", OF_FOLDER),
    ],
)
def test_the_share_folder_shows_files_where_they_are_installed(
    file: str, text: str, bot: Path
) -> None:
    """As in an installation, beside what lies there already; what is unknown stays where it is."""
    (bot / file).write_text(text)

    files = shown(bot.parents[1])

    assert files["up.launch.py"] == "launch/up.launch.py"
    assert files["launch/up.launch.py"] == "launch/up.launch.py"
    assert files["config/a.yaml"] == "config/a.yaml"


def test_folders_that_a_package_adds_install_into_the_same_share_folder(bot: Path) -> None:
    """Packages of many examples do, with a launch and a config folder in each."""
    (bot / "CMakeLists.txt").write_text(
        "project(bot)\nadd_subdirectory(doc/one)\nadd_subdirectory(${CMAKE_SOURCE_DIR}/doc/two)\n"
        "add_subdirectory(doc/one)\nadd_subdirectory(.)\nadd_subdirectory(doc/../../other)\n"
    )
    for name in ("one", "two"):
        inner = bot / "doc" / name
        (inner / "config").mkdir(parents=True)
        (inner / "config" / f"{name}.yaml").write_text(name)
        (inner / "CMakeLists.txt").write_text(
            "install(DIRECTORY config DESTINATION share/${PROJECT_NAME})\n"
            f"install(PROGRAMS ${{CMAKE_CURRENT_SOURCE_DIR}}/{name}.py DESTINATION lib/bot)\n"
        )
        (inner / f"{name}.py").touch()

    files = shown(bot.parents[1])

    assert files["config/one.yaml"] == "one"
    assert files["config/two.yaml"] == "two"
    assert files["config/a.yaml"] == "config/a.yaml"
    assert set(Packages(bot.parents[1]).executables("bot")) == {"one.py", "two.py"}


@pytest.mark.parametrize(
    ("rule", "place"),
    [
        ("install(FILES b.yaml DESTINATION share/bot/config)", "config/b.yaml"),
        ("install(FILES b.yaml DESTINATION share/bot/config RENAME c.yaml)", "config/c.yaml"),
        ("install(DIRECTORY launch DESTINATION share/bot/config)", "config/launch/up.launch.py"),
        ("install(DIRECTORY launch/more DESTINATION share/bot)", "more/deep.launch.py"),
        ("install(DIRECTORY launch/ DESTINATION share/bot/config)", "config/more/deep.launch.py"),
    ],
)
def test_what_is_installed_into_a_folder_stands_beside_what_is_there(
    rule: str, place: str, bot: Path
) -> None:
    """A folder of links holds the files of the source folder, and those of the rules."""
    (bot / "CMakeLists.txt").write_text(rule)

    files = shown(bot.parents[1])

    assert {place, "config/a.yaml"} <= set(files)
    assert not (bot / place).exists()


@pytest.mark.parametrize(
    "rule",
    [
        "install(DIRECTORY launch config DESTINATION share/${PROJECT_NAME})",
        "install(FILES b.yaml DESTINATION share/bot/../../../..)",
        "install(FILES b.yaml DESTINATION share/other)",
        "install(FILES missing.yaml DESTINATION share/bot/config)",
        "set(A ${A}${A})" * 100 + "install(FILES ${A} DESTINATION share/bot)",
    ],
)
def test_a_package_whose_files_lie_where_they_are_installed_is_its_own_share_folder(
    rule: str, bot: Path
) -> None:
    """Nothing is written for it, least of all outside of the share folder."""
    (bot / "CMakeLists.txt").write_text(rule)
    share_of.cache_clear()

    assert Packages(bot.parents[1]).share("bot") == bot


def test_the_share_folder_follows_the_rules_of_the_package(bot: Path) -> None:
    """A rule or file that is gone leaves nothing behind."""
    (bot / "CMakeLists.txt").write_text(
        "install(DIRECTORY launch config DESTINATION share/bot/all)\n"
        "install(FILES b.yaml DESTINATION share/bot/config)"
    )
    before = shown(bot.parents[1])
    (bot / "CMakeLists.txt").write_text("install(FILES b.yaml DESTINATION share/bot/all)")

    files = shown(bot.parents[1])

    assert {"all/config/a.yaml", "config/b.yaml"} <= set(before)
    assert set(files) == {
        *("launch/up.launch.py", "launch/more/deep.launch.py", "config/a.yaml", "b.yaml"),
        "all/b.yaml",
    }


def test_a_home_that_is_read_only_needs_no_cache(
    bot: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As in a container: the links are in a temporary folder then."""
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    (bot / "CMakeLists.txt").write_text("install(FILES b.yaml DESTINATION share/bot/config)")

    assert shown(bot.parents[1])["config/b.yaml"] == "b.yaml"


def test_a_program_of_a_package_that_is_not_there_is_one_of_aionode(
    workspace: Path, tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Launch files name it; the package itself comes first, wherever it is."""
    monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)
    name = "static_transform_publisher"
    own = [sys.executable, "-m", "aionode.programs", "tf2_ros", name]

    assert Packages().command("tf2_ros", name, ["--interfaces", "x"]) == own
    assert Packages(workspace).command("tf2_ros", name) == own
    built = tmp_path_factory.mktemp("built")
    write(
        built / "tf2_ros",
        {
            "package.xml": "<package><name>tf2_ros</name></package>",
            "setup.cfg": f"[options.entry_points]\nconsole_scripts=\n {name}=tf2_ros:main\n",
            "tf2_ros/__init__.py": "",
        },
    )
    assert Packages(built).command("tf2_ros", name)[2] == "aionode.rclpy"


def test_a_program_in_cpp_that_nobody_has_built_is_one_of_aionode(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A workspace with the sources of ROS's tutorials has turtlesim, whose programs need Qt."""
    monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)
    for package in ("turtlesim", "joy"):
        write(
            tmp_path / package,
            {
                "package.xml": f"<package><name>{package}</name></package>",
                "CMakeLists.txt": "add_executable(turtlesim_node turtlesim.cpp)\n",
            },
        )
    own = [sys.executable, "-m", "aionode.programs", "turtlesim", "turtlesim_node"]

    assert Packages(tmp_path).command("turtlesim", "turtlesim_node") == own
    assert Packages(tmp_path).plugin("joy", "joy::Joy") == standard_plugin("joy", "joy::Joy")


def test_an_unknown_program_of_a_package_that_is_not_there_is_named_with_those_of_aionode() -> None:
    """Nobody looks for a folder that does not exist."""
    with pytest.raises(
        ExecutableNotFoundError, match=r"'tf2_ros': not found, and aionode has no program 'monitor'"
    ):
        Packages().command("tf2_ros", "monitor")


def test_an_unknown_program_of_a_package_in_cpp_is_said_to_need_ros() -> None:
    """The other program of Cartographer, whose name is similar, would not help."""
    with pytest.raises(ExecutableNotFoundError) as raised:
        Packages().command("cartographer_ros", "cartographer_node")

    assert "the package is a mapping program in C++; a ROS 2 with rmw_zenoh" in str(raised.value)
    assert "did you mean" not in str(raised.value)


@pytest.mark.parametrize(
    ("package", "name"), [(package, name) for package in MODULES for name in MODULES[package]]
)
def test_each_program_of_the_table_is_a_module_with_a_main(package: str, name: str) -> None:
    """A name in the table that is none would be found only when it is started."""
    module = program_module(package, name)

    assert module is not None
    assert callable(import_module(module).main)


def test_each_module_with_a_main_is_in_the_table() -> None:
    """Otherwise nobody can start it."""
    known = {program_module(package, name) for package in MODULES for name in MODULES[package]}
    for found in walk_packages(programs.__path__, f"{programs.__name__}."):
        module = import_module(found.name)
        if hasattr(module, "main") and not found.name.endswith("__main__"):
            assert found.name in known


@pytest.mark.parametrize(
    ("package", "name"), [(package, name) for package in PLUGINS for name in PLUGINS[package]]
)
def test_each_plugin_of_the_table_is_a_class_of_a_node(package: str, name: str) -> None:
    """A launch file loads it into a container of the original."""
    found = standard_plugin(package, name)

    assert found is not None
    module, _, kind = found[0].partition(":")
    assert issubclass(getattr(import_module(module), kind), Node)
