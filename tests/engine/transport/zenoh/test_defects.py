"""Each worked-around defect of Zenoh has a description, a program that shows it, and a switch."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

from aionode.engine.context import Context
from aionode.engine.transport.network import DiscoveryRange, Network, network_from
from aionode.engine.transport.zenoh import _defects
from aionode.engine.transport.zenoh._defects._switch import defects, is_mended
from aionode.engine.transport.zenoh.session.settings import router_settings, session_settings
from aionode.errors import ConfigurationError

ROOT = Path(__file__).parents[4]

VARIABLE = "AIONODE_ZENOH_UNMENDED"


def test_each_defect_has_a_program_that_shows_it() -> None:
    """Otherwise its workaround would stay forever."""
    programs = {path.stem for path in (ROOT / "tests/zenoh_defects").glob("[a-z]*.py")}

    assert programs == defects()


@pytest.mark.parametrize("name", sorted(defects()))
def test_a_defect_is_described(name: str) -> None:
    """Whoever tries a new version of Zenoh finds there what can be removed."""
    source = (Path(_defects.__path__[0]) / f"{name}.py").read_text(encoding="utf-8")
    text = ast.get_docstring(ast.parse(source)) or ""
    titles = [line for line in text.splitlines() if line.endswith(":") and line[0] != " "]

    assert titles == ["Zenoh:", "Reported:", "Seen in:", "Workaround:"]


@pytest.mark.parametrize("name", sorted(defects()))
def test_a_defect_has_a_switch(name: str) -> None:
    """It has the name of the defect's module, wherever the workaround is."""
    asked = (f'is_mended("{name}")', f'defect = "{name}"')
    modules = sorted((ROOT / "aionode/engine/transport/zenoh").rglob("*.py"))

    assert any(text in module.read_text(encoding="utf-8") for module in modules for text in asked)


def test_workarounds_are_disabled_by_the_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    """Zenoh's own values then stay."""
    network = network_from({})
    key, admin = "transport/shared_memory/enabled", "adminspace/enabled"
    assert session_settings(network, ())[key] is False
    monkeypatch.setenv(VARIABLE, "shared_memory, admin_space")

    assert not is_mended("shared_memory")
    assert is_mended("closing")
    assert key not in session_settings(network, ())
    assert {key, admin}.isdisjoint(router_settings())


@pytest.mark.parametrize(
    "endpoint", ["tcp/127.0.0.1:7447", "tls/robot:7448", "tcp/10.0.0.1:7447#iface=eth0"]
)
def test_no_endpoint_equals_the_address_of_a_link(endpoint: str) -> None:
    """Zenoh would redial such an endpoint before it has closed the lost transport."""
    (session,) = session_settings(Network(discovery_range=DiscoveryRange.SYSTEM_DEFAULT), ())[
        "connect/endpoints"
    ]
    (dialled,) = router_settings(connect=[endpoint])["connect/endpoints"]

    assert "#" in session
    assert "#" in dialled
    assert dialled.partition("#")[0] == endpoint.partition("#")[0]
    assert dialled.count("#") == 1


async def test_a_name_of_no_defect_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    """It would disable nothing, and the program would show nothing."""
    monkeypatch.setenv(VARIABLE, "lingerin")
    with pytest.raises(ConfigurationError, match=r"AIONODE_ZENOH_UNMENDED.*lingerin.*lingering"):
        async with Context():
            pass
