"""What mypy --strict and pyright say of code that uses messages, the page about them, and examples.

`make check` has mypy read the examples; pyright reads them here.
"""

from __future__ import annotations

import importlib.util
import json
import re
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path

import pytest

pytestmark = pytest.mark.checks

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
# The types of numpy that is installed are read as its own Python does: 2.5 needs 3.12.
PYTHON = f"{sys.version_info.major}.{sys.version_info.minor}"
PAGE = ROOT / "docs" / "howto" / "messages.md"
ACCEPTED, REJECTED = HERE / "accepted.py", HERE / "rejected.py"
EXAMPLES = ROOT / "examples"


def marked(file: Path) -> set[int]:
    """Return the numbers of the lines that are marked as mistakes."""
    lines = file.read_text().splitlines()
    return {number for number, line in enumerate(lines, 1) if line.endswith("# error")}


def code_of_page(folder: Path) -> Path:
    """Return a file with the code of the page about messages."""
    blocks = re.findall(r"^```python\n(.*?)^```", PAGE.read_text(), re.DOTALL | re.MULTILINE)
    code = folder / "messages.py"
    code.write_text("# pyright: standard\n" + "\n".join(blocks))
    return code


def mypy(page: Path) -> dict[Path, set[int]]:
    """Return the lines in which mypy finds mistakes, by file.

    With the options and the cache of `make check`.
    """
    command = [sys.executable, "-m", "mypy", "--no-error-summary", "--python-version", PYTHON]
    done = subprocess.run(
        [*command, str(ACCEPTED), str(REJECTED), str(page)],
        check=False,
        capture_output=True,
        text=True,
        cwd=ROOT,
    )
    assert done.stderr == ""
    found = re.findall(r"^(.+):(\d+): error:", done.stdout, re.MULTILINE)
    return by_file((ROOT / file, int(line)) for file, line in found)


def pyright(folder: Path, page: Path) -> dict[Path, set[int]]:
    """Return the lines in which pyright finds mistakes, by file."""
    settings = {"typeCheckingMode": "strict", "extraPaths": [str(ROOT)], "pythonVersion": PYTHON}
    (folder / "pyrightconfig.json").write_text(json.dumps(settings))
    command = [sys.executable, "-m", "basedpyright", "--outputjson", "--project", str(folder)]
    done = subprocess.run(
        [*command, "--pythonpath", sys.executable, *map(str, (ACCEPTED, REJECTED, page, EXAMPLES))],
        check=False,
        capture_output=True,
        text=True,
    )
    return by_file(
        (Path(one["file"]), one["range"]["start"]["line"] + 1)
        for one in json.loads(done.stdout)["generalDiagnostics"]
        # Launch files import modules that only `aionode launch` provides.
        if one["severity"] == "error" and not one["file"].endswith(".launch.py")
    )


def by_file(found: Iterable[tuple[Path, int]]) -> dict[Path, set[int]]:
    """Return the numbers of lines, by file."""
    lines: dict[Path, set[int]] = {ACCEPTED: set(), REJECTED: set()}
    for file, line in found:
        lines.setdefault(file, set()).add(line)
    return lines


@pytest.mark.timeout(300)  # the first run reads all of numpy's types
def test_mypy_finds_the_mistakes_and_nothing_else(tmp_path: Path) -> None:
    """A wrong field name or type is seen before the robot runs."""
    assert mypy(code_of_page(tmp_path)) == {ACCEPTED: marked(ACCEPTED), REJECTED: marked(REJECTED)}


@pytest.mark.timeout(300)  # the first run reads all of numpy's types
@pytest.mark.skipif(
    importlib.util.find_spec("basedpyright") is None, reason="basedpyright is not installed"
)
def test_pyright_finds_the_mistakes_and_nothing_else(tmp_path: Path) -> None:
    """Editors show what it says."""
    assert pyright(tmp_path, code_of_page(tmp_path)) == {
        ACCEPTED: marked(ACCEPTED),
        REJECTED: marked(REJECTED),
    }
