"""Calls within the link transport go down the layers, as do the types that its modules name."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import grimp

ROOT = Path(__file__).parents[4]
PACKAGE = "aionode.engine.transport.link"


def layers() -> list[str]:
    """Return the layers of the link contract in pyproject.toml, from the top."""
    config: dict[str, Any] = tomllib.loads((ROOT / "pyproject.toml").read_text())
    for contract in config["tool"]["importlinter"]["contracts"]:
        if contract.get("containers") == [PACKAGE]:
            found: list[str] = contract["layers"]
            return found
    raise AssertionError(f"no contract has the container {PACKAGE}")


def test_the_layers_hold_for_imports_under_type_checking_as_well() -> None:
    """A cycle of types is a cycle for readers; import-linter skips these imports here."""
    level = {
        f"{PACKAGE}.{module}": number
        for number, layer in enumerate(layers())
        for module in layer.split(" | ")
    }
    graph = grimp.build_graph("aionode", exclude_type_checking_imports=False, cache_dir=None)
    upward = [
        (importer, imported)
        for importer in level
        for imported in graph.find_modules_directly_imported_by(importer)
        if imported in level and level[imported] <= level[importer]
    ]
    assert upward == []
    assert level.keys() == graph.find_children(PACKAGE)
