"""The robot to deploy to, reached by the ``ssh`` and ``scp`` of this host."""

from __future__ import annotations

import shlex
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import Final

import click

from aionode.cli._support.exit import become

__all__ = ["Robot"]

SCRIPTS: Final = Path(__file__).parent

OPTIONS: Final = (
    *("-o", "ConnectTimeout=10"),
    *("-o", "ServerAliveInterval=5", "-o", "ServerAliveCountMax=3"),  # end when the link is lost
)
LOST: Final = 255
"""The exit status of ssh if its connection failed or broke."""

CONSEQUENCES: Final = {
    "prepare": "nothing was changed there",
    "install": "what ran there still runs; run the same command again",
    "activate": "the new release is current, but systemd did not accept or start its unit",
}
"""What a failed script has left behind."""


@dataclass(frozen=True)
class Robot:
    """A host that ssh reaches.

    Attributes:
        target: Its name for ssh.
        config: A configuration file for ssh, instead of the user's.
        is_dry: Whether to print commands instead of running them.
    """

    target: str
    config: Path | None = None
    is_dry: bool = False

    def run(self, script: str, *arguments: str) -> str:
        """Run a script of this folder on the robot, and return what it prints.

        Raises:
            click.ClickException: The script failed, or the connection.
        """
        remote = shlex.join(["sh", "-eus", "--", *arguments])
        command = ["ssh", *self.options(), self.target, remote]
        text = (SCRIPTS / f"{script}.sh").read_text(encoding="utf-8")
        if self.is_dry:
            click.echo(f"\n$ {shlex.join(command)} < {script}.sh\n{text.rstrip()}")
            return ""
        return self.checked(command, script, text)

    def copy(self, file: Path, to: PurePosixPath) -> None:
        """Copy a file onto the robot.

        Raises:
            click.ClickException: It was not copied completely.
        """
        command = ["scp", "-q", *self.options(), str(file), f"{self.target}:{shlex.quote(str(to))}"]
        if self.is_dry:
            click.echo(f"\n$ {shlex.join(command)}")
            return
        self.checked(command, "copy", "")

    def follow(self, unit: str) -> None:
        """Print the log of a unit until Ctrl-C, replacing this process."""
        remote = f"journalctl --unit {shlex.quote(unit)} --lines 20 --follow"
        command = ["ssh", *self.options(), self.target, remote]
        if self.is_dry:
            click.echo(f"\n$ {shlex.join(command)}")
            return
        click.echo(f"the log of {unit}; Ctrl-C ends this command, and the unit keeps running")
        become([shutil.which("ssh") or "ssh", *command[1:]])

    def options(self) -> list[str]:
        """Return the options of ssh and scp."""
        return [*OPTIONS, *(["-F", str(self.config)] if self.config else [])]

    def checked(self, command: list[str], step: str, given: str) -> str:
        """Run a command of this host, and return what it prints; its errors go to the terminal."""
        try:
            done = subprocess.run(  # noqa: S603  # ssh and scp, with what the user names
                command, input=given, stdout=subprocess.PIPE, text=True, check=False
            )
        except FileNotFoundError as error:
            raise click.ClickException(
                f"{command[0]}: not found; install the OpenSSH client"
            ) from error
        if done.returncode == 0:
            return done.stdout.strip()
        if done.returncode == LOST or step == "copy":
            raise click.ClickException(
                f"{self.target}: the connection failed or broke ({step}); what ran on the robot "
                "still runs, and the release is not complete: run the same command again"
            )
        raise click.ClickException(
            f"{self.target}: {step} failed with status {done.returncode}, for the reason above; "
            f"{CONSEQUENCES[step]}"
        )
