"""A client of a web server started by a test."""

from __future__ import annotations

import ssl

import httpx

__all__ = ["http_client"]


def http_client(port: int) -> httpx.AsyncClient:
    """Return a client that loads no certificates, and waits as long as a busy machine takes."""
    return httpx.AsyncClient(
        base_url=f"http://127.0.0.1:{port}",
        trust_env=False,
        verify=ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT),
        timeout=50,
    )
