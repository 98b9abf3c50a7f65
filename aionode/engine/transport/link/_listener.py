"""The listening socket of a context, in a folder that only its user can enter."""

from __future__ import annotations

import os
import re
import socket
import stat
import struct
import sys
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Final

import xxhash
from msgspec import Struct
from msgspec.structs import replace

from aionode.clock import S_TO_NS, MachineTime
from aionode.engine.transport.link._protocol import VERSION
from aionode.errors import TransportError

if TYPE_CHECKING:
    from collections.abc import Mapping

__all__ = ["Advertisement", "Listener", "available", "host_id", "is_own_user", "socket_folder"]

BACKLOG: Final = 1024
"""Number of contexts that may dial while this one is busy, as when many start at once."""

UNIX_SOCKETS: Final = Path("/proc/net/unix")
"""Lists the Unix sockets of this system or container, with the paths they are bound to."""

SOCKET_ID: Final = rb"(?m)/([0-9a-f]{1,32})\.(?:sock|new)$"
"""The id of a context in the path of its socket, at the end of a line of that list."""

CREDENTIALS: Final = struct.Struct("3i")

MAX_PATH_BYTES: Final = 107
"""Maximum length of a Unix socket's path on Linux in bytes, without the trailing NUL."""

NAME_BYTES: Final = len("/" + 32 * "f" + ".sock")
"""Maximum length of a socket's name: that of a context's id, which has up to 32 digits."""

NEW_S: Final = 10
"""Age from which a socket with a temporary name belongs to no process any more, in seconds."""

BOOT_ID: Final = Path("/proc/sys/kernel/random/boot_id")


def available() -> bool:
    """Return whether this system has what links need: Unix sockets, credentials, sealed memory."""
    return (
        sys.platform == "linux"
        and hasattr(socket, "SO_PEERCRED")
        and hasattr(os, "memfd_create")
        and BOOT_ID.exists()
    )


def host_id() -> str:
    """Return an id of this host that lasts until the next reboot."""
    return xxhash.xxh3_64_hexdigest(BOOT_ID.read_bytes())


class Advertisement(Struct, frozen=True):
    """The announcement of a context by which others can link to it.

    Attributes:
        participant: Id of the context.
        version: The version of the protocol.
        host: Id of the host.
        uid: The user.
    """

    participant: str
    version: int
    host: str
    uid: int

    @classmethod
    def own(cls, participant: str) -> Advertisement:
        """Return the advertisement of a context in this process."""
        return cls(participant, VERSION, host_id(), os.getuid())

    def text(self) -> str:
        """Return the advertisement as the last chunks of a key, without wildcards."""
        return f"{self.participant}/link/{self.version}/{self.host}/{self.uid}"

    @classmethod
    def parse(cls, text: str) -> Advertisement | None:
        """Parse an advertisement; return None for anything else."""
        chunks = text.split("/")
        if len(chunks) != 5 or chunks[1] != "link":
            return None
        participant, _, version, host, uid = chunks
        numbers = all(n.isascii() and n.isdigit() and len(n) <= 10 for n in (version, uid))
        # It becomes part of a path, so nothing else may get through.
        hexadecimal = set(participant) <= set("0123456789abcdef") and 0 < len(participant) <= 32
        return cls(participant, int(version), host, int(uid)) if numbers and hexadecimal else None

    def is_near(self, other: Advertisement) -> bool:
        """Return whether the two can be linked."""
        alike = replace(self, participant=other.participant) == other
        return alike and self.participant != other.participant


def socket_folder(environ: Mapping[str, str]) -> Path:
    """Return the folder of this user's sockets, creating it if necessary.

    Raises:
        TransportError: it cannot be created, its path is too long for a socket, or other users can
            enter it.
    """
    runtime = environ.get("XDG_RUNTIME_DIR")
    if runtime:
        folder = Path(runtime) / "aionode"
    else:
        folder = system_temporary_folder(environ) / f"aionode-{os.getuid()}"
    size = len(os.fsencode(folder)) + NAME_BYTES
    if size > MAX_PATH_BYTES:  # some contexts with shorter ids would fit
        raise TransportError(
            f"link: {folder} is too long for the path of a Unix socket: {size} bytes with the "
            f"name of the socket, and at most {MAX_PATH_BYTES} are possible; set XDG_RUNTIME_DIR "
            "to a shorter path"
        )
    try:
        with suppress(FileExistsError):
            folder.mkdir(mode=0o700)
        status = folder.lstat()
    except OSError as error:
        raise TransportError(f"link: {folder} cannot be used: {error}") from error
    if (
        not stat.S_ISDIR(status.st_mode)
        or status.st_uid != os.getuid()
        or stat.S_IMODE(status.st_mode) & 0o077
    ):
        raise TransportError(
            f"link: {folder} is not a folder that only this user can enter; remove it, or set "
            "XDG_RUNTIME_DIR to a folder that is"
        )
    return folder


def system_temporary_folder(environ: Mapping[str, str]) -> Path:
    """Return the folder of `tempfile.gettempdir`, importing `tempfile` only if it has to search.

    It loads random numbers and archives, which take as long as to open Zenoh.
    """
    named = (environ.get(name) for name in ("TMPDIR", "TEMP", "TMP"))
    folder = next(filter(None, named), "/tmp")  # noqa: S108  # checked by `socket_folder`
    if os.access(folder, os.W_OK | os.X_OK):
        return Path(folder).absolute()
    import tempfile

    return Path(tempfile.gettempdir())


def is_own_user(sock: socket.socket) -> bool:
    """Return whether a process of this user is at the other end."""
    data = sock.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, CREDENTIALS.size)
    _, uid, _ = CREDENTIALS.unpack(data)
    return bool(uid == os.getuid())


class Listener:
    """The listening socket of one context, which others find by the context's id.

    Args:
        folder: The result of `socket_folder`.
        participant: Id of the context.

    Raises:
        TransportError: the socket cannot be created.
    """

    def __init__(self, folder: Path, participant: str) -> None:
        self._folder = folder
        self._path = folder / f"{participant}.sock"
        self._remove_dead()
        self.sock = new_socket()
        temporary = folder / f"{participant}.new"
        try:
            self.sock.bind(os.fspath(temporary))
            self.sock.listen(BACKLOG)
            # It is renamed only once it listens; otherwise another process would remove it as dead.
            temporary.rename(self._path)
        except OSError as error:
            self.sock.close()
            with suppress(OSError):
                temporary.unlink()
            raise TransportError(f"link: no socket in {folder}: {error}") from error

    def accept(self) -> socket.socket | None:
        """Return the connection of another process of this user, if one is waiting.

        Raises:
            OSError: no descriptors are left.
        """
        try:
            sock, _ = self.sock.accept()
        except (BlockingIOError, ConnectionAbortedError):
            return None
        sock.setblocking(False)
        return checked(sock)

    def dial(self, participant: str) -> socket.socket | None:
        """Connect to another context; return None if it is absent or another user's."""
        sock = new_socket()
        try:
            sock.connect(os.fspath(self._folder / f"{participant}.sock"))
        except OSError:
            sock.close()
            return None
        return checked(sock)

    def close(self) -> None:
        """Stop listening."""
        self.sock.close()
        with suppress(OSError):
            self._path.unlink()

    def _remove_dead(self) -> None:
        """Remove the sockets of processes that were killed."""
        files = list(self._folder.iterdir())
        for path in files:
            if path.suffix != ".new":
                continue
            with suppress(OSError):  # another process was faster
                # A socket only has this name until it listens.
                age_ns = MachineTime().system_ns() - path.lstat().st_mtime_ns
                if age_ns > NEW_S * S_TO_NS:
                    path.unlink()
        paths = [path for path in files if path.suffix == ".sock"]
        listed: set[bytes] = set()
        with suppress(OSError):  # thousands of lines if there are many links
            if paths:
                listed.update(re.findall(SOCKET_ID, UNIX_SOCKETS.read_bytes()))
        for path in paths:
            if path.stem.encode() in listed:
                continue  # dialling all live ones would keep them busy when many start
            probe = new_socket()
            try:
                probe.connect(os.fspath(path))
            except ConnectionRefusedError:
                with suppress(OSError):
                    path.unlink()
            except OSError:
                pass  # its process is alive, but busy
            finally:
                probe.close()


def new_socket() -> socket.socket:
    """Return a non-blocking Unix socket.

    Raises:
        TransportError: no descriptors are left.
    """
    try:
        sock = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    except OSError as error:
        raise TransportError(f"link: no socket: {error}") from error
    sock.setblocking(False)
    return sock


def checked(sock: socket.socket) -> socket.socket | None:
    """Return `sock`, or close it and return None if another user is at the other end."""
    if is_own_user(sock):
        return sock
    sock.close()
    return None
