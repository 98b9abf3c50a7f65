"""Tests of imports without garbage collection."""

import gc
import os
import subprocess
import sys
from types import ModuleType
from unittest.mock import Mock

import pytest

from aionode._process.imports import uncollected

START = """
import sys
import aionode
from aionode.interfaces.std_msgs.msg import String
aionode.Node, aionode.run
import aionode.engine.transport.link, aionode.engine.transport.zenoh.bridge
few = {"dataclasses", "difflib", "importlib.resources", "json", "random", "secrets", "tempfile"}
print(few & {*sys.modules})
print([
    cls.__qualname__
    for module in list(sys.modules.values())
    if module.__name__.startswith("aionode.engine.")
    for cls in vars(module).values()
    if isinstance(cls, type) and (hasattr(cls, "__dataclass_fields__") or hasattr(cls, "_fields"))
])
"""


def test_no_garbage_is_collected_within_the_block_but_after_it() -> None:
    """If the collector stayed off, the program's memory would grow."""
    with uncollected():
        assert not gc.isenabled()
    assert gc.isenabled()


def test_what_an_import_creates_is_old_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Otherwise the next collection would search all of it, for next to no garbage."""
    monkeypatch.setattr("aionode._process.imports.FROZEN_BY_PYTHON", 1)
    monkeypatch.setattr("aionode._process.imports.Seen.frozen", False)
    gc.unfreeze()  # what tests/conftest.py has frozen
    try:
        with uncollected():
            created: list[object] = []
            monkeypatch.setitem(sys.modules, "aionode_imported", ModuleType("aionode_imported"))
        assert any(old is created for old in gc.get_objects(generation=2))
    finally:
        gc.freeze()


def test_what_the_program_has_frozen_stays_frozen(monkeypatch: pytest.MonkeyPatch) -> None:
    """As with `freeze_objects`."""
    monkeypatch.setattr("aionode._process.imports.Seen.frozen", False)
    gc.freeze()
    count = gc.get_freeze_count()
    with uncollected():
        monkeypatch.setitem(sys.modules, "aionode_imported", ModuleType("aionode_imported"))
    assert gc.get_freeze_count() == count


def test_without_an_import_frozen_objects_are_not_counted(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """In a program that has frozen a million, counting them takes 50 ms."""
    monkeypatch.setattr(gc, "get_freeze_count", lambda: pytest.fail("counted"))
    with uncollected():
        pass


def test_frozen_objects_are_counted_only_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Otherwise each first use of a type would hold up the loop of a running node."""
    monkeypatch.setattr("aionode._process.imports.Seen.frozen", False)
    counting = Mock(side_effect=gc.get_freeze_count)
    monkeypatch.setattr(gc, "get_freeze_count", counting)
    for name in ("aionode_imported", "aionode_imported_too"):
        with uncollected():
            monkeypatch.setitem(sys.modules, name, ModuleType(name))

    assert counting.call_count == 1


def test_the_collector_is_on_again_after_an_import_that_fails() -> None:
    """A missing library must not leave the program without its collector."""
    with pytest.raises(ImportError), uncollected():
        raise ImportError
    assert gc.isenabled()


def test_a_collector_that_the_program_switched_off_stays_off() -> None:
    """The program owns this setting, as with `freeze_objects`."""
    gc.disable()
    try:
        with uncollected():
            pass
        assert not gc.isenabled()
    finally:
        gc.enable()


def test_a_node_starts_without_what_few_nodes_need() -> None:
    """Each of these modules takes 1 to 9 ms, a dataclass half of one, a named tuple a fifth.

    Counting covered lines loads some of them, so the program runs without it.
    """
    run = subprocess.run(
        [sys.executable, "-c", START],
        env={name: value for name, value in os.environ.items() if not name.startswith("COV")},
        capture_output=True,
        text=True,
        check=True,
        timeout=60,
    )
    assert run.stdout == "set()\n[]\n"
