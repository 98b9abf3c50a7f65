"""The shares of the test files that workers of pytest-xdist collect."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest

from tests.shares import Share

pytest_plugins = ["pytester"]

FILES = [f"tests/{folder}/test_{number}.py" for folder in ("system", "tf") for number in range(10)]


def shares(count: int) -> list[list[str]]:
    """Return the files of each share; those in `tests/system/` are of another kind."""
    workers = [Share(number, count, lambda nodeid: "system" in nodeid) for number in range(count)]
    return [[file for file in FILES if worker.has(file)] for worker in workers]


def test_each_file_is_in_one_share_or_in_all() -> None:
    """Its tests would not run, or too many workers would collect it."""
    times = Counter(file for share in shares(3) for file in share)
    assert set(times) == set(FILES)
    assert Counter(times.values()) == {1: 16, 3: 4}


def test_every_share_has_as_many_files_of_each_kind() -> None:
    """Those that start processes take longer."""
    assert {sum("system" in file for file in share) for share in shares(2)} == {6}


@pytest.mark.slow
@pytest.mark.processes
def test_each_test_runs_once(pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch) -> None:
    """A file that several workers have collected is run by one of them."""
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")
    monkeypatch.setenv("PYTHONPATH", str(Path(__file__).parents[1]))
    pytester.makeconftest(
        """
        import pytest
        from tests.shares import Share, Shares

        @pytest.hookimpl(tryfirst=True)
        def pytest_cmdline_main(config):
            if config.option.numprocesses:
                config.pluginmanager.register(Shares())

        def pytest_configure(config):
            if hasattr(config, "workerinput"):
                share = Share(*config.workerinput["share"], lambda nodeid: None)
                config.pluginmanager.register(share)
        """
    )
    text = "import pytest\n@pytest.mark.parametrize('n', range(3))\ndef test(n): pass\n"
    pytester.makepyfile(**{f"test_{number}": text for number in range(11)})

    result = pytester.runpytest_subprocess("-p", "xdist", "-n", "5", "--dist", "loadfile", "-v")

    result.assert_outcomes(passed=33)
    assert len({line.split()[-1] for line in result.outlines if "PASSED" in line}) == 33
    workers = Counter(line.split()[0] for line in result.outlines if "PASSED" in line)
    assert len(workers) == 5
