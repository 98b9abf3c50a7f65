"""Tests that every built-in service bounds its answer, even for the largest request."""

from __future__ import annotations

import asyncio
import logging
from typing import Any

import pytest

from aionode.engine.context import Context
from aionode.engine.wire import cdr
from aionode.errors import ServiceError
from aionode.interfaces.lifecycle_msgs import srv as lifecycle
from aionode.interfaces.rcl_interfaces import srv
from aionode.interfaces.rcl_interfaces.msg import (
    LoggerLevel,
    Parameter,
    ParameterDescriptor,
    ParameterValue,
)
from aionode.interfaces.type_description_interfaces.srv import GetTypeDescription
from aionode.lifecycle import LifecycleNode
from aionode.logging import _loggers as loggers
from aionode.logging import get_logger_level, set_logger_level_for_others
from aionode.node import Node
from aionode.parameter import _store as parameter_store
from aionode.parameter._services import MAX_ANSWER, MAX_HELD

LONG = "x" * 10_000
MANY = 10_000
"""How many names fit into a request."""


def parameters(count: int, size: int = 0, name: str = "own{}") -> list[Parameter]:
    """Return parameters to be set."""
    value = ParameterValue(type=4, string_value="x" * size)
    return [Parameter(name=name.format(number), value=value) for number in range(count)]


REFUSED = -1

REQUESTS: list[tuple[Any, str, Any, int]] = [
    (srv.GetParameters, "get_parameters", {"names": ["a"] * 1_000}, MAX_ANSWER),
    (srv.GetParameters, "get_parameters", {"names": ["a"] * MANY}, REFUSED),
    (srv.GetParameterTypes, "get_parameter_types", {"names": ["a"] * MANY}, 20_000),
    (srv.DescribeParameters, "describe_parameters", {"names": ["a"] * 1_000}, MAX_ANSWER),
    (srv.DescribeParameters, "describe_parameters", {"names": ["a"] * MANY}, REFUSED),
    (srv.ListParameters, "list_parameters", {"prefixes": ["a." * 100] * MANY}, 1_000),
    (srv.SetParameters, "set_parameters", {"parameters": parameters(2_000)}, 2**20),
    (srv.SetParameters, "set_parameters", {"parameters": parameters(2_001)}, REFUSED),
    (
        srv.SetParametersAtomically,
        "set_parameters_atomically",
        {"parameters": parameters(2_000)},
        1_000,
    ),
    (
        srv.SetParametersAtomically,
        "set_parameters_atomically",
        {"parameters": parameters(70, 10**6)},
        REFUSED,
    ),
    (srv.GetLoggerLevels, "get_logger_levels", {"names": ["x" * 1000] * 1_000}, 2**21),
    (srv.GetLoggerLevels, "get_logger_levels", {"names": ["x"] * MANY}, REFUSED),
    (srv.SetLoggerLevels, "set_logger_levels", {"levels": [LoggerLevel()] * MANY}, REFUSED),
    (
        GetTypeDescription,
        "get_type_description",
        {"type_name": "rcl_interfaces/msg/ParameterEvent", "include_type_sources": True},
        20_000,
    ),
    (lifecycle.ChangeState, "change_state", {}, 100),
    (lifecycle.GetState, "get_state", {}, 100),
    (lifecycle.GetAvailableStates, "get_available_states", {}, 1_000),
    (lifecycle.GetAvailableTransitions, "get_available_transitions", {}, 2_000),
    (lifecycle.GetAvailableTransitions, "get_transition_graph", {}, 4_000),
]


async def test_every_built_in_service_bounds_its_answer(context: Context) -> None:
    """A small request must neither get a large answer nor fill the node's memory."""
    async with (
        LifecycleNode(
            "robot",
            context=context,
            enable_logger_service=True,
            allow_undeclared_parameters=True,
        ) as robot,
        Node("peer", context=context) as peer,
    ):
        robot.declare_parameter("a", LONG, ParameterDescriptor(description=LONG))
        names = {service.service_name.removeprefix("/robot/") for service in robot.services}
        assert names == {name for _, name, _, _ in REQUESTS}
        for srv_type, name, fields, most_bytes in REQUESTS:
            client = peer.create_client(srv_type, f"/robot/{name}")
            call: Any = client.call(srv_type.Request(**fields))
            answers: Any = await asyncio.gather(call, return_exceptions=True)
            answer = answers[0]
            if most_bytes == REFUSED:
                assert isinstance(answer, ServiceError), name
                assert answer.error_type == "RequestRefusedError"
            else:
                assert len(cdr.encode(answer)) <= most_bytes * 1.1, name


async def test_others_cannot_fill_the_parameters_of_a_node(context: Context) -> None:
    """Where undeclared parameters are allowed, each request could add some megabytes."""
    async with (
        Node("robot", context=context, allow_undeclared_parameters=True) as robot,
        Node("peer", context=context) as peer,
    ):
        client = peer.create_client(srv.SetParameters, "/robot/set_parameters")
        refused = 0
        for number in range(70):
            some = parameters(2, 10**6 // 2, f"p{number}x{{}}")
            try:
                await client.call(srv.SetParameters.Request(parameters=some))
            except ServiceError:
                refused += 1

        held = robot.get_parameters_by_prefix("").values()
        assert sum(len(str(each.value)) for each in held) <= MAX_HELD
        assert refused >= 70 - MAX_HELD // 10**6


async def test_a_name_that_is_repeated_is_described_once(
    node: Node, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Copying a description a thousand times would block the loop."""
    node.declare_parameter("a", 1)
    asked: list[str] = []
    describe = parameter_store.ParameterStore.describe_parameter

    def counted(self: Any, name: str) -> Any:
        asked.append(name)
        return describe(self, name)

    monkeypatch.setattr(parameter_store.ParameterStore, "describe_parameter", counted)
    client = node.create_client(srv.DescribeParameters, "/node/describe_parameters")
    answer = await client.call(srv.DescribeParameters.Request(names=["a"] * 1_000))

    assert [one.name for one in answer.descriptors] == ["a"] * 1_000
    assert asked == ["a"]


def test_others_have_few_loggers_made(monkeypatch: pytest.MonkeyPatch) -> None:
    """A logger is never removed, and each part of its name is a logger."""
    known = logging.Logger.manager.loggerDict
    before = len(known)
    monkeypatch.setattr(loggers, "MAX_LOGGERS", before + 5)

    assert get_logger_level("nobody.asked.before") == 0
    assert len(known) == before
    with pytest.raises(ValueError, match="at most, and while there are fewer than"):
        set_logger_level_for_others("a." * 200, 10)
    for number in range(5):
        set_logger_level_for_others(f"made_by_others{number}", 10)
    with pytest.raises(ValueError, match="there is no logger 'made_by_others5'"):
        set_logger_level_for_others("made_by_others5", 10)
    set_logger_level_for_others("made_by_others0", 20)
    assert get_logger_level("made_by_others0") == 20
