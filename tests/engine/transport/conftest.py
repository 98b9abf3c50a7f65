"""Fixtures for the tests of transports."""

from __future__ import annotations

import pytest

from tests.support.peers import isolated_environment


@pytest.fixture(autouse=True)
def isolated(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Isolate contexts made in a test: they reach each other, but nothing else on the machine."""
    if request.path.parent.name == "zenoh":
        monkeypatch.setenv("AIONODE_LINK", "off")  # # they test Zenoh only
    for name, value in isolated_environment().items():
        monkeypatch.setenv(name, value)
