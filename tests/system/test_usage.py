"""The processor time and memory of each process."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from aionode.system._usage import UsageMeter


def test_processor_and_memory_of_a_process_are_measured_until_it_has_ended() -> None:
    """The processor share is that since the previous measurement."""
    meter = UsageMeter()
    meter.of(os.getpid())
    sum(range(1_000_000))
    cpu, memory = meter.of(os.getpid())
    assert cpu is not None
    assert cpu > 0.0
    assert memory is not None
    assert memory > 1_000_000

    with subprocess.Popen(["true"]) as process:
        process.wait()
    assert meter.of(process.pid) == (None, None)
    assert meter.of(None) == (None, None)


def test_without_psutil_nothing_is_known(monkeypatch: pytest.MonkeyPatch) -> None:
    """The package psutil is an optional extra."""
    monkeypatch.setitem(sys.modules, "psutil", None)

    assert UsageMeter().of(os.getpid()) == (None, None)
