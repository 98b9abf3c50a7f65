"""Fixtures of tests of transports."""

from __future__ import annotations

import pytest

from tests.support.peers import isolated_environment


@pytest.fixture(autouse=True)
def isolated(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Contexts made in a test hear each other, and nothing else that runs on the machine."""
    if request.path.parent.name == "zenoh":
        monkeypatch.setenv("AIONODE_LINK", "off")  # they are about Zenoh alone
    for name, value in isolated_environment().items():
        monkeypatch.setenv(name, value)
