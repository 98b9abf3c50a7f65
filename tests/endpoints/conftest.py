"""Nodes that have only the endpoints of a test."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from aionode.node import Node


@pytest.fixture
def node_factory(node_factory: Callable[..., Node]) -> Callable[..., Node]:
    """Create nodes without the log's topic and the parameter services.

    These take half of the time in which a node is made; tests/node is about them.
    """

    def make(kind: str | Callable[..., Node] = "node", /, *args: Any, **options: Any) -> Node:
        if isinstance(kind, str):
            options = {"enable_rosout": False, "start_parameter_services": False, **options}
        return node_factory(kind, *args, **options)

    return make
