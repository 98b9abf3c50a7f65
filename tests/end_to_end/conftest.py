"""Fixtures of tests with several processes."""

from __future__ import annotations

import pytest

from tests.support.peers import isolated_environment


@pytest.fixture(autouse=True)
def isolated(monkeypatch: pytest.MonkeyPatch) -> None:
    """Processes started in a test hear each other, and nothing else that runs on the machine."""
    for name, value in isolated_environment().items():
        monkeypatch.setenv(name, value)
