"""``aionode deploy``: installs a workspace on a robot, where systemd runs it."""

from __future__ import annotations

import tempfile
from pathlib import Path

import click

from aionode.cli._support.deployment.release import Release, release_of
from aionode.cli._support.deployment.robot import Robot

__all__ = ["deploy_command"]

FILE = click.Path(exists=True, dir_okay=False, path_type=Path)
FOLDER = click.Path(exists=True, file_okay=False, path_type=Path)


@click.command()
@click.argument("target", metavar="USER@ROBOT")
@click.argument("workspace", metavar="[FOLDER]", type=FOLDER, default=Path())
@click.option("--unit", type=FILE, help="The systemd unit; by default the only one in FOLDER.")
@click.option("--wheel", "wheels", type=FILE, multiple=True, help="An additional wheel to install.")
@click.option("--python", default="python3", metavar="PYTHON", help="The robot's Python.")
@click.option(
    "--unit-folder",
    default="/etc/systemd/system",
    metavar="FOLDER",
    help="The folder of the robot's units.",
)
@click.option("--ssh-config", type=FILE, help="The ssh configuration, instead of ~/.ssh/config.")
@click.option("--no-follow", is_flag=True, help="Do not print the robot's log.")
@click.option("--dry-run", is_flag=True, help="Print what would be done, without connecting.")
def deploy_command(
    target: str,
    workspace: Path,
    unit: Path | None,
    wheels: tuple[Path, ...],
    python: str,
    unit_folder: str,
    ssh_config: Path | None,
    *,
    no_follow: bool,
    dry_run: bool,
) -> None:
    """Copy a workspace to a robot over ssh, where systemd runs it.

    FOLDER is a workspace such as `aionode new` writes, by default the current folder. Its files and
    the wheels of its packages form a release, which is installed into its own virtual environment,
    beside earlier releases. Only when it is complete does the unit switch to it, atomically.
    Earlier releases stay, and a second run without changes restarts nothing.
    """
    if target.startswith("-"):
        raise click.UsageError(
            f"{target!r} is not a robot; use --ssh-config FILE for ssh's options"
        )
    release = release_of(workspace, unit, tuple(wheel.resolve() for wheel in wheels))
    robot = Robot(target, ssh_config, dry_run)
    click.echo(described(release))
    folder, identity = str(release.folder), release.id
    is_there = robot.run("prepare", folder, identity, release.user, python) == "here"
    if not is_there:
        with tempfile.TemporaryDirectory(prefix="aionode-deploy-") as temporary:
            archive = Path(temporary, "release.tar")
            if not dry_run:
                wheel_folder = Path(temporary, "wheels")
                wheel_folder.mkdir()
                release.write(archive, wheel_folder)
            robot.copy(archive, release.folder / "incoming.tar")
        robot.run("install", folder, identity, python)
    said = robot.run("activate", folder, identity, release.unit.name, unit_folder)
    if not dry_run:
        change = "unchanged" if said == "unchanged" else f"now runs release {identity}"
        click.echo(f"{target}: {release.unit.name} {change}")
    if not no_follow:
        robot.follow(release.unit.name)


def described(release: Release) -> str:
    """Return a description of the release for a person."""
    size = sum((release.workspace / file).stat().st_size for file in release.files)
    wheels = [*(package.name for package in release.packages), *(w.name for w in release.wheels)]
    return (
        f"release {release.id} of {release.workspace}: {len(release.files)} files, "
        f"{size / 1000:.0f} kB; wheels: {', '.join(wheels)}; "
        f"for {release.user} in {release.folder}, as {release.unit.name}"
    )
