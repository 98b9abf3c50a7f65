"""Tests of imports without garbage collection."""

import gc
import os
import subprocess
import sys

import pytest

from aionode._process.imports import uncollected

START = """
import dataclasses, sys
import aionode
from aionode.interfaces.std_msgs.msg import String
aionode.Node, aionode.run
import aionode.engine.transport.link, aionode.engine.transport.zenoh.bridge
print({"difflib", "importlib.resources", "random", "secrets", "tempfile"} & {*sys.modules})
print([
    cls.__qualname__
    for module in list(sys.modules.values())
    if module.__name__.startswith("aionode.engine.")
    for cls in vars(module).values()
    if isinstance(cls, type) and dataclasses.is_dataclass(cls)
])
"""


def test_no_garbage_is_collected_within_the_block_but_after_it() -> None:
    """If the collector stayed off, the program's memory would grow."""
    with uncollected():
        assert not gc.isenabled()
    assert gc.isenabled()


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
    """Each of these modules takes 1 to 9 ms, and each dataclass half of one.

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
