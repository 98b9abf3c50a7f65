"""``aionode pkg``: packages of ROS 2, and what they can start."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from aionode._packages import Packages, around, standard_packages
from aionode._process.bounded_files import read_file
from aionode.cli._support.command import command
from aionode.errors import CommandError

if TYPE_CHECKING:
    from aionode.cli._support.output import Output

__all__ = ["executables", "list_packages", "manifest", "pkg_command", "prefix"]


@click.group("pkg")
def pkg_command() -> None:
    """Show packages of ROS 2: in the workspace, installed, and those that aionode stands in for."""


def known() -> tuple[Packages, list[str]]:
    """Return the packages around the current folder, and the names of all packages."""
    packages = around(Path.cwd())
    return packages, sorted({*packages.names(), *standard_packages()})


@command(pkg_command, "list", node=False)
def list_packages(*, output: Output) -> None:
    """List all packages."""
    output.items([(name, {"name": name}) for name in known()[1]])


@command(
    pkg_command,
    "executables",
    click.argument("package_name", required=False),
    click.option("--full-path", is_flag=True, help="Show the path of what is started."),
    node=False,
)
def executables(package_name: str | None, *, output: Output, full_path: bool = False) -> None:
    """List what packages can start: all of them, or one.

    Raises:
        PackageNotFoundError: there is no such package.
    """
    packages, names = known()
    for package in names if package_name is None else [package_name]:
        for name, executable in sorted(packages.executables(package).items()):
            text = executable.target if full_path else f"{package} {name}"
            record = {"package": package, "name": name, "target": executable.target}
            output.item(text, record)


@command(
    pkg_command,
    "prefix",
    click.argument("package_name"),
    click.option("--share", is_flag=True, help="Show the folder with its data."),
    node=False,
)
def prefix(package_name: str, *, output: Output, share: bool = False) -> None:
    """Print the folder of a package.

    Raises:
        PackageNotFoundError: there is no such package, or it has no folder.
    """
    packages, _ = known()
    source = packages.sources().get(package_name)
    folder = packages.share(package_name) if share else source or packages.prefix(package_name)
    output.item(str(folder), {"name": package_name, "folder": str(folder)})


@command(
    pkg_command,
    "xml",
    click.argument("package_name"),
    click.option("-t", "--tag", help="Show only the text of the elements of this name."),
    node=False,
)
def manifest(package_name: str, *, output: Output, tag: str | None = None) -> None:
    """Print the package.xml of a package.

    Raises:
        CommandError: it cannot be read, or has no such element.
        PackageNotFoundError: there is no such package.
    """
    from xml.etree import ElementTree as ET  # few commands need it

    packages, names = known()
    if package_name not in packages.names() and package_name in names:
        raise CommandError(f"{package_name}: aionode stands in for it, without a package.xml")
    file = (packages.sources().get(package_name) or packages.share(package_name)) / "package.xml"
    try:
        root = ET.fromstring(read_file(file))  # noqa: S314  # of the user, and bounded
    except (OSError, ET.ParseError) as error:
        raise CommandError(f"{file} cannot be read: {error}") from error
    if tag is None:
        text = ET.tostring(root, encoding="unicode")
        output.item(text, {"name": package_name, "xml": text})
        return
    found = [element.text or "" for element in root.findall(tag)]
    if not found:
        have = ", ".join(sorted({element.tag for element in root}))
        raise CommandError(f"{file}: no element {tag!r}; it has {have}")
    output.items([(text, {"name": package_name, tag: text}) for text in found])
