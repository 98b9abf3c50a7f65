"""Fixtures for tests with several processes."""

from __future__ import annotations

import pytest

from tests.support.peers import isolated_environment


@pytest.fixture(autouse=True)
def isolated(monkeypatch: pytest.MonkeyPatch) -> None:
    """Processes started in a test communicate with each other, and with nothing else here."""
    for name, value in isolated_environment().items():
        monkeypatch.setenv(name, value)
