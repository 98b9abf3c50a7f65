"""Starts programs as a command line does, in a context without a network."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

import pytest

from aionode import Context
from aionode.arguments import parse_arguments

Start = Callable[..., Any]


@pytest.fixture
def start(aionode_context: Context, node_factory: Callable[..., Any]) -> Start:
    """Start a program's node with parameters, as ``--ros-args -p NAME:=VALUE`` gives them."""

    def make(kind: Callable[..., Any], *arguments: Any, **parameters: Any) -> Any:
        before = aionode_context.arguments
        given = [f"{name}:={json.dumps(value)}" for name, value in parameters.items()]
        words = [word for each in given for word in ("-p", each)]
        aionode_context.arguments = parse_arguments(["program", "--ros-args", *words])
        node = node_factory(kind, *arguments)
        aionode_context.arguments = before
        return node

    return make
