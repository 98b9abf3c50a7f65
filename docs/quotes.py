"""Keeps the code quoted in the documentation, and the lists in the reference, up to date.

A block of code below ``<!-- quote: examples/talker.py -->`` is that file, and below
``<!-- quote: examples/talker.py#Talker.say -->`` that class, method or function of it.

``python docs/quotes.py`` brings the blocks up to date; with ``--check`` it only says which are not.
"""

from __future__ import annotations

import ast
import re
import sys
import textwrap
from pathlib import Path
from typing import Final

ROOT: Final = Path(__file__).parent.parent
sys.path.insert(0, str(ROOT))  # run as a program, it has the path of its folder only

from docs.contents import with_contents

QUOTE: Final = re.compile(
    r"^<!-- quote: (?P<source>\S+) -->\n+```(?P<language>\w*)\n(?P<code>.*?)^```$",
    re.MULTILINE | re.DOTALL,
)

Definition = ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef


def pages() -> list[Path]:
    """Return every page of documentation, README.md first."""
    return [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md"))]


def quoted(source: str) -> str:
    """Return the code that `source` names: a path, and after ``#`` a dotted name in it.

    Raises:
        LookupError: The file has no such name.
        OSError: There is no such file.
    """
    path, _, name = source.partition("#")
    text = (ROOT / path).read_text(encoding="utf-8")
    return fragment(text, name) if name else text


def fragment(text: str, name: str) -> str:
    """Return the source of the class or function `name` of a module, without its indentation."""
    scope: list[ast.stmt] = ast.parse(text).body
    for part in name.split("."):
        found = named(scope, part)
        scope = found.body
    first = min([found.lineno, *(decorator.lineno for decorator in found.decorator_list)])
    lines = text.splitlines(keepends=True)[first - 1 : found.end_lineno]
    return textwrap.dedent("".join(lines))


def named(scope: list[ast.stmt], name: str) -> Definition:
    """Return the class or function `name` among some statements."""
    for statement in scope:
        if isinstance(statement, Definition) and statement.name == name:
            return statement
    raise LookupError(f"no class or function named {name}")


def refreshed(page: str) -> str:
    """Return the text of a page with every quote as its source has it now."""

    def replace(match: re.Match[str]) -> str:
        source, language = match["source"], match["language"]
        return f"<!-- quote: {source} -->\n```{language}\n{quoted(source)}```"

    return QUOTE.sub(replace, page)


def current(path: Path, text: str) -> str:
    """Return the text of a page with its quotes, and its list in the reference, as they are now."""
    new = refreshed(text)
    return with_contents(new) if path.parent.name == "reference" else new


def main(*, check: bool) -> int:
    """Refresh or check every page; the result is the exit status."""
    stale = 0
    for path in pages():
        text = path.read_text(encoding="utf-8")
        new = current(path, text)
        if new == text:
            continue
        stale += 1
        name = path.relative_to(ROOT)
        if check:
            print(f"{name}: shows code that has changed; make quotes", file=sys.stderr)
        else:
            path.write_text(new, encoding="utf-8")
            print(f"{name}: brought up to date")
    return 1 if check and stale else 0


if __name__ == "__main__":
    sys.exit(main(check="--check" in sys.argv[1:]))
