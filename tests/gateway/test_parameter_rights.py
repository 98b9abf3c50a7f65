"""Parameters and audit logs that the policy hides are not revealed in any other way."""

from __future__ import annotations

import json
from collections.abc import AsyncIterator
from typing import Any

import pytest

from aionode.errors import RefusedError
from aionode.interfaces.rcl_interfaces.msg import Parameter as ParameterMsg
from aionode.interfaces.rcl_interfaces.msg import ParameterEvent
from aionode.node import Node
from aionode.parameter import Parameter
from aionode.testing import settle
from tests.support.gateway_bench import Bench

POLICY = """
[[who]]
name = "guest"
loopback = true
[[refuse]]
see = "/camera:secret.*"
[[allow]]
see = "/**"
call = "/**"
subscribe = "/**"
"""


@pytest.fixture
async def camera(bench: Bench) -> AsyncIterator[Node]:
    """Yield a node with one parameter that may be seen, and one that may not."""
    bench.allow(POLICY)
    async with Node("camera", context=bench.context) as camera:
        camera.declare_parameter("exposure", 0.5)
        camera.declare_parameter("secret.key", "hidden")
        await settle()
        yield camera


@pytest.mark.parametrize("part", ["get_parameters", "get_parameter_types", "describe_parameters"])
async def test_a_service_reveals_nothing_of_a_hidden_parameter(
    bench: Bench, camera: Node, part: str
) -> None:
    """Reading by a call counts as reading."""
    async with bench.session() as session:
        service = f"/camera/{part}"
        response = await session.call(service, {"names": ["exposure"]})
        assert any(len(getattr(response, name)) == 1 for name in response.__slots__)
        with pytest.raises(RefusedError, match="see /camera:secret"):
            await session.call(service, {"names": ["exposure", "secret.key"]})


async def test_a_list_leaves_out_parameters_that_are_hidden(bench: Bench, camera: Node) -> None:
    """As are prefixes that only these have."""
    async with bench.session() as session:
        result = (await session.call("/camera/list_parameters", {})).result

        assert "exposure" in result.names
        assert not [text for text in (*result.names, *result.prefixes) if "secret" in text]


async def test_who_may_only_call_reads_no_parameters(bench: Bench, camera: Node) -> None:
    """Such a client may not set them by a call either: the rules for parameters decide."""
    bench.allow('[[who]]\nname = "guest"\nloopback = true\n[[allow]]\ncall = "/**"')
    async with bench.session() as session:
        with pytest.raises(RefusedError, match="see /camera:exposure"):
            await session.call("/camera/get_parameters", {"names": ["exposure"]})
        with pytest.raises(RefusedError, match="parameter /camera:exposure"):
            await session.call("/camera/set_parameters", {"parameters": [{"name": "exposure"}]})
        assert (await session.call("/camera/list_parameters", {})).result.names == []


async def test_events_leave_out_parameters_that_are_hidden(bench: Bench, camera: Node) -> None:
    """They contain the values, so subscribing to them would reveal them."""
    got: list[dict[str, Any]] = []
    async with bench.session() as session:
        await session.subscribe(
            "/parameter_events",
            ParameterEvent.__ros_type__,
            frame=lambda received: got.append(
                {each.name: each.value.double_value for each in received.message.changed_parameters}
            ),
            key="events",
        )
        await settle()
        camera.set_parameters([Parameter("secret.key", value="new")])
        camera.set_parameters_atomically(
            [Parameter("exposure", value=0.25), Parameter("secret.key", value="newer")]
        )
        await settle()
        camera.set_parameters([Parameter("exposure", value=0.75)])
        await settle()

    assert got == [{"exposure": 0.25}, {"exposure": 0.75}]


async def test_an_invalid_event_is_left_out(bench: Bench, camera: Node) -> None:
    """Any node may publish arbitrary bytes there, and clients only get events that were checked."""
    got: list[object] = []
    async with bench.session() as session:
        subscribed = await session.subscribe(
            "/parameter_events", ParameterEvent.__ros_type__, frame=got.append, key="events"
        )
        publisher = camera.create_publisher(ParameterEvent, "/parameter_events", 10)
        publisher.publish(ParameterEvent(node="/camera"))
        hidden = ParameterMsg(name="secret.key")
        publisher.publish(ParameterEvent(node="/camera", deleted_parameters=[hidden]))
        await settle()

        assert len(got) == 1
        assert subscribed.failed == 0


async def test_a_pattern_does_not_show_the_audit_log(bench: Bench) -> None:
    """It contains all clients' arguments, even those that the policy hides from others."""
    async with bench.session() as session:
        await settle()
        for rule in ('subscribe = "/**"', 'subscribe = ["/gateway/*", "/gateway/audi?"]'):
            bench.allow(f'[[who]]\nname = "guest"\nloopback = true\n[[allow]]\n{rule}')
            assert "/gateway/audit" not in session.graph.topics()
            with pytest.raises(RefusedError, match="the policy does not allow guest"):
                await session.subscribe("/gateway/audit", frame=lambda _: None, key="audit")


async def test_a_rule_that_names_the_audit_log_shows_it(bench: Bench) -> None:
    """For a page that shows who does what."""
    bench.allow('[[who]]\nname = "guest"\nloopback = true\n[[allow]]\nsubscribe = "/gateway/audit"')
    got: list[str] = []
    async with bench.session() as session:
        await settle()
        assert "/gateway/audit" in session.graph.topics()
        await session.subscribe(
            "/gateway/audit", frame=lambda received: got.append(received.message.data), key="audit"
        )
        await settle()

    assert json.loads(got[0])["action"] == "subscribe"
