"""`aionode deploy` with this host's ssh and scp, to an SSH server that replaces a robot.

The server runs commands on this host: systemctl and journalctl are scripts that record their calls,
and pip installs nothing from elsewhere.
"""

from __future__ import annotations

import asyncio
import getpass
import os
import shutil
import sys
from collections.abc import AsyncIterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import asyncssh
import pytest

from aionode.cli import main

pytestmark = [
    pytest.mark.skipif(
        not (shutil.which("ssh") and shutil.which("scp") and shutil.which("flock")),
        reason="the OpenSSH client is not installed",
    ),
    pytest.mark.filterwarnings("ignore::ResourceWarning"),  # connections for tests to break
]

WRITES_DOWN = '#!/bin/sh\necho "$(basename "$0") $*" >>{calls}\n'
SUDO = '#!/bin/sh\nshift\nexec "$@"\n'
VENV_WITHOUT_PIP = """#!/bin/sh
case "$*" in
    "-m venv "*)
        if [ -p {barrier} ]; then echo reached >{barrier}; read -r line <{barrier}; exit 1; fi
        mkdir -p "$3/bin" && printf '#!/bin/sh\n' >"$3/bin/python" && chmod +x "$3/bin/python" ;;
esac
"""


@dataclass
class Host:
    """A host with an SSH server that runs its commands here."""

    folder: Path
    connections: list[asyncssh.SSHServerConnection] = field(default_factory=list)
    commands: list[str] = field(default_factory=list)
    breaks_copy: bool = False

    @property
    def current(self) -> Path:
        """The link to the running release."""
        return self.folder / "opt" / "my_robot" / "current"

    def calls(self) -> list[str]:
        """Return the calls of systemctl since the last time."""
        file = self.folder / "calls"
        calls = file.read_text().splitlines() if file.exists() else []
        file.unlink(missing_ok=True)
        return calls

    async def process(self, process: asyncssh.SSHServerProcess[bytes]) -> None:
        """Run a command like a login shell."""
        assert process.command is not None
        self.commands.append(process.command)
        fakes = f"{self.folder / 'bin'}{os.pathsep}{os.environ['PATH']}"
        child = await asyncio.create_subprocess_shell(
            process.command,
            stdin=asyncio.subprocess.PIPE,
            stdout=asyncio.subprocess.PIPE,
            stderr=asyncio.subprocess.PIPE,
            env={"PATH": fakes, "PIP_NO_INDEX": "1", "PIP_NO_DEPS": "1"},
        )
        given = await process.stdin.read()
        output, errors = await child.communicate(given)
        process.stdout.write(output)
        process.stderr.write(errors)
        process.exit(child.returncode or 0)


class Server(asyncssh.SSHServer):
    """Lets everybody in, and remembers the connection."""

    def __init__(self, host: Host) -> None:
        self.host = host

    def connection_made(self, conn: asyncssh.SSHServerConnection) -> None:
        """Remember a connection, for a test to break it."""
        self.host.connections.append(conn)

    def begin_auth(self, username: str) -> bool:
        """Request no authentication."""
        return False


@pytest.fixture
async def host(tmp_path: Path) -> AsyncIterator[Host]:
    """A host that answers on a port of this one; `ssh_config` leads there."""
    host = Host(tmp_path / "robot")
    tools = host.folder / "bin"
    tools.mkdir(parents=True)
    (host.folder / "units").mkdir()
    scripts = {
        "systemctl": WRITES_DOWN.format(calls=host.folder / "calls"),
        "journalctl": WRITES_DOWN.format(calls=host.folder / "calls"),
        "sudo": SUDO,
        "python-without-pip": VENV_WITHOUT_PIP.format(barrier=host.folder / "barrier"),
    }
    for name, text in scripts.items():
        (tools / name).write_text(text)
        (tools / name).chmod(0o755)

    class Files(asyncssh.SFTPServer):
        def write(self, file_obj: Any, offset: int, data: bytes) -> Any:
            if host.breaks_copy:
                host.connections[-1].abort()
            return super().write(file_obj, offset, data)

        def exit(self) -> None:
            self.channel.exit(0)  # as OpenSSH's server does; scp fails without it

    server = await asyncssh.create_server(
        lambda: Server(host),
        "127.0.0.1",
        0,
        server_host_keys=[asyncssh.generate_private_key("ssh-ed25519")],
        process_factory=host.process,
        encoding=None,
        sftp_factory=Files,
        allow_scp=True,
    )
    (tmp_path / "ssh_config").write_text(
        f"Host robot\n  HostName 127.0.0.1\n  Port {server.get_port()}\n  User anybody\n"
        "  StrictHostKeyChecking no\n  UserKnownHostsFile /dev/null\n  LogLevel ERROR\n"
        "  IdentityAgent none\n  IdentityFile none\n"
    )
    yield host
    server.close()
    for connection in host.connections:
        connection.abort()
    await server.wait_closed()


@pytest.fixture
def workspace(host: Host, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A new workspace, whose unit runs it below the folder of the host."""
    monkeypatch.chdir(tmp_path)
    assert main(["new", "my_robot"]) == 0
    unit = tmp_path / "my_robot" / "my_robot.service"
    text = unit.read_text().replace("/opt/", f"{host.folder}/opt/")
    unit.write_text(text.replace("User=robot", f"User={getpass.getuser()}"))
    return tmp_path / "my_robot"


async def deploy(workspace: Path, *options: str, python: str) -> tuple[int, str]:
    """Run the command; return its exit status and all its output."""
    around = workspace.parent
    process = await asyncio.create_subprocess_exec(
        *(sys.executable, "-m", "aionode", "deploy", "robot", str(workspace)),
        *("--ssh-config", str(around / "ssh_config"), "--python", python),
        *("--unit-folder", str(around / "robot" / "units"), *options),
        stdin=asyncio.subprocess.DEVNULL,
        stdout=asyncio.subprocess.PIPE,
        stderr=asyncio.subprocess.STDOUT,
        env={**os.environ, "PIP_NO_BUILD_ISOLATION": "false"},  # hatchling is already here
    )
    output, _ = await process.communicate()
    assert process.returncode is not None
    return process.returncode, output.decode()


@pytest.mark.slow
@pytest.mark.processes
@pytest.mark.one_loop
@pytest.mark.timeout(180)  # a virtual environment and a wheel are made
async def test_a_workspace_is_installed_and_its_unit_started(host: Host, workspace: Path) -> None:
    """A second run changes nothing, and a change creates a release beside the first."""
    status, text = await deploy(workspace, python=sys.executable)
    assert status == 0, text
    first = host.current.resolve()
    assert list((first / ".venv").glob("lib/*/site-packages/my_robot/word_counter.py"))
    assert (first / "src/my_robot_interfaces/msg/WordCount.msg").is_file()
    installed = host.folder / "units" / "my_robot.service"
    assert installed.read_text() == (workspace / "my_robot.service").read_text()
    assert host.calls() == [
        "systemctl daemon-reload",
        "systemctl enable --quiet my_robot.service",
        "systemctl restart my_robot.service",
        "journalctl --unit my_robot.service --lines 20 --follow",
    ]

    status, text = await deploy(workspace, "--no-follow", python=sys.executable)
    assert (status, host.current.resolve()) == (0, first), text
    assert "my_robot.service unchanged" in text
    assert host.calls() == [
        "systemctl enable --quiet my_robot.service",
        "systemctl start my_robot.service",  # nothing, if it is running
    ]

    (workspace / "src/my_robot/config/parameters.yaml").write_text("/**: {}\n")
    status, text = await deploy(workspace, "--no-follow", python="python-without-pip")
    assert status == 0, text
    assert host.current.resolve() != first
    assert first.is_dir(), "the release before stays"
    assert host.calls()[-1] == "systemctl restart my_robot.service"


@pytest.mark.stress
@pytest.mark.timeout(180)  # four wheels are made
async def test_a_connection_that_breaks_leaves_what_runs(host: Host, workspace: Path) -> None:
    """While files are copied or installed; the same command then completes the release."""
    status, text = await deploy(workspace, "--no-follow", python="python-without-pip")
    assert status == 0, text
    before = host.current.resolve()
    host.calls()
    (workspace / "new.txt").write_text("new\n")

    host.breaks_copy = True
    status, text = await deploy(workspace, "--no-follow", python="python-without-pip")
    assert status == 1
    assert text.splitlines()[-1].startswith("robot: the connection failed or broke (copy)")
    host.breaks_copy = False

    barrier = host.folder / "barrier"
    os.mkfifo(barrier)
    async with asyncio.TaskGroup() as tasks:
        running = tasks.create_task(deploy(workspace, "--no-follow", python="python-without-pip"))
        assert await asyncio.to_thread(barrier.read_text) == "reached\n"
        host.connections[-1].abort()
    status, text = running.result()
    assert status == 1
    assert text.splitlines()[-1].startswith("robot: the connection failed or broke (install)")
    assert (host.current.resolve(), host.calls()) == (before, [])

    # processes that the broken one left running
    await asyncio.to_thread(barrier.write_text, "fail\n")
    barrier.unlink()
    status, text = await deploy(workspace, "--no-follow", python="python-without-pip")
    assert status == 0, text
    assert (host.current / "new.txt").read_text() == "new\n"
    assert before.is_dir()
    assert not (host.current.parent / "incoming.tar").exists()


async def test_a_robot_that_cannot_take_a_release_is_left_alone(
    host: Host, workspace: Path
) -> None:
    """Its Python, its user and its folder are checked before anything is copied."""
    status, text = await deploy(workspace, python="python-of-another-robot")

    assert status == 1
    assert "python-of-another-robot is not there" in text
    assert "nothing was changed there" in text
    assert not host.current.parent.exists()


async def test_a_dry_run_connects_to_nothing(host: Host, workspace: Path) -> None:
    """It prints each command and script instead, and the files to ship."""
    status, text = await deploy(workspace, "--dry-run", python="python3")

    assert status == 0
    assert host.connections == []
    commands = [line.split()[1] for line in text.splitlines() if line.startswith("$ ")]
    assert commands == ["ssh", "scp", "ssh", "ssh", "ssh"]
    assert "11 files" in text


@pytest.mark.parametrize(
    ("unit", "said"),
    [
        ("[Service]\nWorkingDirectory=/opt/my_robot\n", "is not where a deployment puts a release"),
        ("[Service]\nWorkingDirectory=/opt/current\n", "is not where a deployment puts a release"),
        ("WorkingDirectory\n", "not a systemd unit"),
    ],
)
def test_a_unit_that_runs_elsewhere_is_refused(
    workspace: Path, unit: str, said: str, capfd: pytest.CaptureFixture[str]
) -> None:
    """It would start what was installed by hand, or nothing."""
    (workspace / "my_robot.service").write_text(unit)

    assert main(["deploy", "robot", str(workspace), "--dry-run"]) == 2
    assert said in capfd.readouterr().err


def test_nothing_is_shipped_that_begins_with_a_dot(
    workspace: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    """Secrets, caches and the repository's history stay behind, as do build results."""
    for name in (".env", ".venv/bin/python", "build/my_robot/copy.py"):
        (workspace / name).parent.mkdir(parents=True, exist_ok=True)
        (workspace / name).write_text("secret\n")

    assert main(["deploy", "robot", str(workspace), "--dry-run"]) == 0
    assert " 11 files" in capfd.readouterr().out
