"""The built-in web page: a few files without external dependencies."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Final

from starlette.responses import PlainTextResponse, Response
from starlette.routing import Route

if TYPE_CHECKING:
    from starlette.requests import Request
    from starlette.routing import BaseRoute

__all__ = ["routes"]

FOLDER: Final = Path(__file__).with_name("static")

KINDS: Final = {".css": "text/css", ".html": "text/html", ".js": "text/javascript"}

HEADERS: Final = {
    # Only its own files may run and connect, so that texts of the robot cannot do anything on the
    # page.
    "content-security-policy": (
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; "
        "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    ),
    "cache-control": "no-cache",
}


def routes() -> list[BaseRoute]:
    """Return the routes of the page, whose files are read once."""
    files = {
        path.name: (path.read_bytes(), KINDS[path.suffix])
        for path in FOLDER.iterdir()
        if path.suffix in KINDS
    }

    async def page(request: Request) -> Response:
        name = request.path_params.get("name", "index.html")
        if name not in files:
            return PlainTextResponse("the page has no such file\n", 404)
        content, kind = files[name]
        return Response(content, media_type=kind, headers=HEADERS)

    return [Route("/", page), Route("/page/{name}", page)]
