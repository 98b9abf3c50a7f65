"""Fixtures for tests of what several contexts tell each other."""

from __future__ import annotations

from tests.support.peers import isolated

__all__ = ["isolated"]
