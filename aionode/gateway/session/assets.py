"""Files of packages for clients, such as the meshes of a robot's model.

A rule with ``asset`` allows them, by ``/package/path``. A path leads to nothing outside the share
folder of its package: a link in it counts only if the file belongs to the same package, as
``colcon build --symlink-install`` leaves them.
"""

from __future__ import annotations

import errno
import re
from functools import partial
from typing import TYPE_CHECKING, Final
from urllib.parse import unquote

from aionode._packages import here, package_of
from aionode._process.bounded_files import LFS_POINTER, read_file
from aionode._process.concurrency import run_in_thread
from aionode.errors import MessageError, PackageNotFoundError

if TYPE_CHECKING:
    from aionode.gateway.session.session import Session

__all__ = ["asset_of_uri", "read_asset"]

MAX_BYTES: Final = 16 << 20
"""Maximum size of a file whose rule has no ``max_bytes``, in bytes."""

PACKAGE: Final = re.compile(r"[A-Za-z0-9_-]{1,200}")

UNUSUAL: Final = re.compile(r"[\x00-\x1f\x7f\\:]")
"""Characters that no served path contains: a colon would end the name of a node in a rule."""


def asset_of_uri(uri: str) -> str:
    """Return the name of an asset, ``/package/path``, of ``package://package/path``.

    Raises:
        MessageError: it is not such an address.
    """
    scheme, found, rest = uri.partition("://")
    if not found or scheme != "package":
        raise MessageError("uri", f"{uri[:200]!r}: only package://PACKAGE/PATH is served")
    return f"/{unquote(rest)}"


async def read_asset(session: Session, name: str) -> bytes:
    """Return the content of a file of a package.

    Args:
        session: The session of the client that asks for it.
        name: The package and the path in its share folder, as ``/package/meshes/base.stl``.

    Raises:
        MessageError: the name is not a path in a package.
        RefusedError: the policy does not allow it, or the file is too large.
        FileNotFoundError: there is no such file in the package.
    """
    package, _, path = name.removeprefix("/").partition("/")
    parts = path.split("/")
    is_plain = PACKAGE.fullmatch(package) and not UNUSUAL.search(path)
    if not is_plain or not {"", ".", ".."}.isdisjoint(parts):
        raise MessageError("asset", f"{name[:200]!r} is not the path of a file in a package")
    rights = session.rights
    with rights.one_call("asset", name):
        rule = (await rights.allow("asset", name, "", None)).rule
        max_bytes = MAX_BYTES if rule is None or rule.max_bytes is None else rule.max_bytes
        try:
            return await run_in_thread(partial(content_of, package, parts, max_bytes))
        except (PackageNotFoundError, OSError) as error:
            if isinstance(error, OSError) and error.errno == errno.EFBIG:
                reason = f"it has more than {max_bytes} bytes, the max_bytes of its rule"
                raise rights.refusal("asset", name, reason, "too_large") from None
            is_pointer = isinstance(error, OSError) and error.strerror == LFS_POINTER
            problem = f"it is {LFS_POINTER}" if is_pointer else "the package has no such file"
            raise FileNotFoundError(f"{name[:200]}: {problem}") from None


def content_of(package: str, parts: list[str], max_bytes: int) -> bytes:
    """Return the content of a file in the share folder of a package.

    Raises:
        PackageNotFoundError: there is no such package.
        OSError: the file cannot be read, is too large, or belongs to something else.
    """
    share = here().share(package).resolve()
    file = share.joinpath(*parts).resolve(strict=True)
    if not file.is_relative_to(share) and package_of(file) != package:
        raise FileNotFoundError(errno.ENOENT, "a link to a file outside the package", str(file))
    return read_file(file, max_bytes)
