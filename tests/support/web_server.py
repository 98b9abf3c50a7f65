"""A web server for the pages of a test, with another origin than a gateway."""

from __future__ import annotations

import asyncio
import mimetypes
from collections.abc import AsyncIterator, Mapping
from contextlib import asynccontextmanager
from pathlib import Path

__all__ = ["web_server"]


@asynccontextmanager
async def web_server(files: Mapping[str, str | Path]) -> AsyncIterator[int]:
    """Serve files to a browser on loopback, and yield the port.

    Args:
        files: What is served, by the start of its path: the text of a page, a file, or a folder.
    """

    async def answer(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        try:
            request = await reader.readuntil(b"\r\n\r\n")
        except asyncio.IncompleteReadError:  # browsers open connections that they do not use
            writer.close()
            return
        path = request.split()[1].decode().partition("?")[0]
        kind = mimetypes.guess_type(path)[0] or "text/html"
        kind = "text/javascript" if path.endswith(".mjs") else kind
        body = found(files, path)
        status = "404 Not Found" if body is None else "200 OK"
        head = f"HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nConnection: close\r\n\r\n"
        writer.write(head.encode() + (body or b""))
        await writer.drain()
        writer.close()

    server = await asyncio.start_server(answer, "127.0.0.1", 0)
    async with server:
        yield server.sockets[0].getsockname()[1]


def found(files: Mapping[str, str | Path], path: str) -> bytes | None:
    """Return what is served for a path, or None."""
    for start, given in files.items():
        if isinstance(given, str):
            if path == start:
                return given.encode()
        elif path.startswith(start):
            file = given / path.removeprefix(start) if given.is_dir() else given
            return file.read_bytes() if file.is_file() else None
    return None
