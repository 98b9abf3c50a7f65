"""``aionode new``: write a package that runs, as a starting point."""

from __future__ import annotations

import re
from pathlib import Path

import click

__all__ = ["new_command"]

TEMPLATES = Path(__file__).parents[1] / "_support" / "new_package"

NAME = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)*")

FILES = {
    "README.md": "README.md",
    "NAME.service": "robot.service",
    "src/NAME/package.xml": "package.xml",
    "src/NAME/NAME/__init__.py": "__init__.py",
    "src/NAME/NAME/word_counter.py": "node.py",
    "src/NAME/launch/robot.launch.py": "robot.launch.py",
    "src/NAME/config/parameters.yaml": "parameters.yaml",
    "src/NAME/test/test_word_counter.py": "test_word_counter.py",
    "src/NAME_interfaces/package.xml": "interfaces_package.xml",
    "src/NAME_interfaces/msg/WordCount.msg": "WordCount.msg",
}
"""The template of each file of a package; ``NAME`` stands for the package's name."""

NATIVE = {"src/NAME/pyproject.toml": "pyproject.toml"}

ROS = {
    "src/NAME/setup.py": "setup.py",
    "src/NAME/setup.cfg": "setup.cfg",
    "src/NAME/pytest.ini": "pytest.ini",
    "src/NAME/resource/NAME": "resource",
    "src/NAME_interfaces/CMakeLists.txt": "CMakeLists.txt",
}


@click.command()
@click.argument("name", metavar="PACKAGE")
@click.option("--ros", is_flag=True, help="Add setup.py and CMakeLists.txt, for colcon build.")
def new_command(name: str, *, ros: bool) -> None:
    """Write a package with a node, a message, a launch file, parameters and a test.

    It is written to a new folder of that name, a workspace in which `aionode launch` and pytest run
    it as it is. No file is overwritten.
    """
    if not NAME.fullmatch(name):
        fits = "lower-case letters, digits and single underscores, such as my_robot"
        raise click.UsageError(f"{name!r} is not a valid package name; use {fits}")
    folder = Path(name)
    if folder.exists():
        raise click.UsageError(f"{name}: already exists; choose another name, or move it away")
    for file, template in {**FILES, **(ROS if ros else NATIVE)}.items():
        path = folder / file.replace("NAME", name)
        path.parent.mkdir(parents=True, exist_ok=True)
        text = (TEMPLATES / f"{template}.txt").read_text(encoding="utf-8")
        path.write_text(text.replace("NAME", name), encoding="utf-8")
        click.echo(path)
    click.echo(f"\ncd {name}\naionode launch src/{name}/launch/robot.launch.py\npytest src/{name}")
