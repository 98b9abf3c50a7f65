"""Fixtures for tests with several processes."""

from __future__ import annotations

from tests.support.peers import isolated

__all__ = ["isolated"]
