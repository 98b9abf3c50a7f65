"""What mypy --strict and pyright say of code that uses messages."""

from __future__ import annotations

import importlib.util
import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
# The types of numpy that is installed are read as its own Python does: 2.5 needs 3.12.
PYTHON = f"{sys.version_info.major}.{sys.version_info.minor}"
ACCEPTED, REJECTED = HERE / "accepted.py", HERE / "rejected.py"


def marked(file: Path) -> set[int]:
    """Return the numbers of the lines that are marked as mistakes."""
    lines = file.read_text().splitlines()
    return {number for number, line in enumerate(lines, 1) if line.endswith("# error")}


def mypy(file: Path) -> set[int]:
    """Return the lines of a file in which mypy finds mistakes."""
    options = ["--strict", "--follow-imports=silent", "--no-error-summary"]
    options += ["--python-version", PYTHON]
    done = subprocess.run(
        [sys.executable, "-m", "mypy", *options, str(file)],
        check=False,
        capture_output=True,
        text=True,
        cwd=ROOT,
    )
    assert done.stderr == ""
    return {int(found[1]) for found in re.finditer(r":(\d+): error:", done.stdout)}


def pyright(file: Path, folder: Path) -> set[int]:
    """Return the lines of a file in which pyright finds mistakes."""
    settings = {"typeCheckingMode": "strict", "extraPaths": [str(ROOT)], "pythonVersion": PYTHON}
    (folder / "pyrightconfig.json").write_text(json.dumps(settings))
    command = [sys.executable, "-m", "basedpyright", "--outputjson", "--project", str(folder)]
    done = subprocess.run(
        [*command, "--pythonpath", sys.executable, str(file)],
        check=False,
        capture_output=True,
        text=True,
    )
    found = json.loads(done.stdout)["generalDiagnostics"]
    return {one["range"]["start"]["line"] + 1 for one in found if one["severity"] == "error"}


@pytest.mark.timeout(300)  # the first run reads all of numpy's types
@pytest.mark.parametrize("file", [ACCEPTED, REJECTED], ids=lambda file: file.stem)
def test_mypy_finds_the_mistakes_and_nothing_else(file: Path) -> None:
    """A wrong field name or type is seen before the robot runs."""
    assert mypy(file) == marked(file)


@pytest.mark.timeout(300)  # the first run reads all of numpy's types
@pytest.mark.skipif(
    importlib.util.find_spec("basedpyright") is None, reason="basedpyright is not installed"
)
@pytest.mark.parametrize("file", [ACCEPTED, REJECTED], ids=lambda file: file.stem)
def test_pyright_finds_the_mistakes_and_nothing_else(file: Path, tmp_path: Path) -> None:
    """Editors show what it says."""
    assert pyright(file, tmp_path) == marked(file)
