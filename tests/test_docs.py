"""The documentation is true: its code runs, its commands and links exist."""

from __future__ import annotations

import ast
import asyncio
import importlib.util
import inspect
import re
import shlex
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
import pytest

from aionode.cli._main import root
from aionode.engine.context import Context
from docs.contents import with_contents, without_contents
from docs.quotes import QUOTE, ROOT, fragment, pages, refreshed
from tests.lab import experiments

if TYPE_CHECKING:
    from types import CodeType

BLOCK = re.compile(
    r"(?P<note><!-- [^>]*-->\n+)?^```(?P<language>\w+)[^\n]*\n(?P<code>.*?)^```$",
    re.MULTILINE | re.DOTALL,
)
FENCED = re.compile(r"^ *```.*?^ *```$", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"\]\((?!https?:|mailto:)(?P<page>[^)#\s]*)#?(?P<anchor>[^)\s]*)\)")
HEADING = re.compile(r"^#+ (?P<text>.+)$", re.MULTILINE)
TYPED = re.compile(r"^ *\$ (?P<command>.+)$", re.MULTILINE)
NAMED = re.compile(r"`(?P<command>(?:aionode|make|python -m (?:aionode|tests)[\w.]*) [^`]+)`")
HOP = re.compile(r"\| `(?P<file>aionode/[\w/]+\.py)` \| `(?P<name>[\w.]+)` \|")
PLACE = re.compile(r"^\| [^|]+ \| `(?P<file>[\w/]+\.py)` \| `(?P<name>[\w.]+)` \|$", re.MULTILINE)
TERM = re.compile(r"^\| (?P<words>[^|`]+[^|]*) \| [^|]+ \| `(?P<place>[^`]+)` \|$", re.MULTILINE)
NAME = re.compile(r"`([A-Z]\w+)`")
PAGES = [str(page.relative_to(ROOT)) for page in pages()]
TEXTS = [
    *PAGES,
    "CHANGELOG.md",
    "SECURITY.md",
    *(str(page.relative_to(ROOT)) for page in ROOT.glob("packages/*/README.md")),
    *(str(page.relative_to(ROOT)) for page in ROOT.glob(".github/**/*.md")),
]
"""Every text for users and contributors."""


@dataclass(frozen=True)
class Block:
    """A block of code in a page."""

    page: str
    line: int
    language: str
    note: str
    code: str

    @property
    def is_quoted(self) -> bool:
        """Whether it is checked against a file instead."""
        return self.note.startswith("<!-- quote:")

    @property
    def is_shown_only(self) -> bool:
        """Whether it is marked as not run, as code for other frameworks is."""
        return self.note.startswith("<!-- not run")


def blocks(page: str, *languages: str) -> list[Block]:
    """Return the blocks of a page that are in one of the languages."""
    text = (ROOT / page).read_text(encoding="utf-8")
    found = []
    for match in BLOCK.finditer(text):
        line = text.count("\n", 0, match.start("code")) + 1
        if match["language"] in languages:
            found.append(Block(page, line, match["language"], match["note"] or "", match["code"]))
    return found


def test_quoted_code_is_the_code_that_is_run() -> None:
    """`make quotes` brings a page up to date."""
    for page in PAGES:
        text = (ROOT / page).read_text(encoding="utf-8")

        assert refreshed(text) == text, page
        marks = re.findall(r"^<!-- quote:", text, re.MULTILINE)
        assert len(marks) == len(QUOTE.findall(text)), f"{page}: a quote without a block"


@pytest.mark.timeout(180)  # it parses the whole package
def test_the_reference_lists_what_sphinx_shows() -> None:
    """In a checkout and on a code host its pages would be empty; `make quotes` makes the lists."""
    for page in sorted((ROOT / "docs" / "reference").glob("*.md")):
        text = page.read_text(encoding="utf-8")

        assert with_contents(text) == text, page
    node = (ROOT / "docs" / "reference" / "node.md").read_text(encoding="utf-8")
    assert "  - `create_publisher(msg_type: type[MsgT], topic: str, " in node
    assert "create_publisher" not in without_contents(node)


def test_the_reference_has_signatures_for_those_who_read_the_files() -> None:
    """Methods have their arguments, properties their types, and what nodes return has neither."""
    page = (ROOT / "docs" / "reference" / "node.md").read_text(encoding="utf-8")

    assert "`create_rate(frequency: float, clock: Clock | None = None) -> Rate`" in page
    assert "`async until_destroyed() -> None`" in page
    assert "`is_running: bool`" in page
    assert "`aionode.NodeEnd`" in page


@pytest.mark.parametrize("page", [page for page in PAGES if blocks(page, "python")])
def test_the_code_of_a_page_runs(
    page: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Code that is not quoted is run, the blocks of a page one after the other."""
    definitions = tmp_path / "ros_ws" / "src" / "tutorial" / "msg"
    definitions.mkdir(parents=True)
    (definitions / "Words.msg").write_text("string text\n", encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    local = Context(transport="local")
    monkeypatch.setattr(Context, "default", lambda: local)
    names: dict[str, Any] = {"__name__": "documentation"}
    with asyncio.Runner() as runner:
        for block in blocks(page, "python"):
            if not block.is_quoted and not block.is_shown_only:
                runner.run(run_block(block, names))


async def run_block(block: Block, names: dict[str, Any]) -> None:
    """Run one block, which may use await."""
    where = f"{block.page}, the block at line {block.line}"
    code: CodeType = compile(block.code, where, "exec", ast.PyCF_ALLOW_TOP_LEVEL_AWAIT)
    if code.co_flags & inspect.CO_COROUTINE:
        await eval(code, names)  # noqa: S307 - the documentation's own code
    else:
        exec(code, names)  # noqa: S102 - the documentation's own code


def commands(page: str) -> set[str]:
    """Return every command line of a page, and those that its sentences name."""
    text = (ROOT / page).read_text(encoding="utf-8")
    typed = {line["command"] for line in TYPED.finditer(text)}
    return typed | {line["command"] for line in NAMED.finditer(FENCED.sub("", text))}


def test_a_command_of_the_documentation_exists() -> None:
    """Newcomers type what the page shows."""
    unknown = [
        f"{page}: {command}"
        for page in TEXTS
        for command in sorted(commands(page))
        if not command_line_exists(command)
    ]

    assert unknown == []


def test_experiments_run_programs_that_exist() -> None:
    """They run seldom: a module that has moved would be noticed at the next release only."""
    unknown = [
        line
        for experiment in experiments().values()
        for line in experiment.run.splitlines()
        if line.startswith("python ") and not command_line_exists(line)
    ]

    assert unknown == []


def command_line_exists(command: str) -> bool:
    """Return whether what a command line names exists: a command, a module, a file or a target."""
    words = shlex.split(command, comments=True)
    match words:
        case ["aionode", *arguments]:
            return command_exists(arguments)
        case ["python", "-m", "build" | "twine", *_]:
            return True  # a release needs them, and nothing else
        case ["python" | "python3", "-m", module, *_]:
            return importlib.util.find_spec(module) is not None
        case ["python", path, *_] if path.endswith(".py"):
            return (ROOT / path).exists()
        case ["make", target, *_]:
            makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
            return f"\n{target}:" in makefile or target in experiments()
        case _:
            others = {
                ".",
                "pip",
                "pytest",
                "cd",
                "curl",
                "git",
                "ros2",
                "sleep",
                "zenoh-bridge-ros2dds",
                "export",
                "python",
            }
            return words[0] in others


def command_exists(arguments: list[str]) -> bool:
    """Whether the words name a command of aionode, with options that it knows."""
    command: click.Command = root
    context = click.Context(command)
    words = list(arguments)
    while isinstance(command, click.Group) and words:
        word = words.pop(0)
        if not word.startswith("-"):
            found = command.get_command(context, word)
            if found is None:
                return False
            command = found
        elif word != "--help":
            option = options_of(command).get(word)
            if option is None:
                return False
            if not option.is_flag:
                del words[:1]
    if (
        command.context_settings.get("ignore_unknown_options")
        and words
        and not words[0].startswith("-")
    ):
        return True  # the arguments of what it runs
    given = {word.partition("=")[0] for word in words if re.fullmatch(r"--?[a-z][a-z-]*.*", word)}
    return given - {"--ros-args", "--help", "-p", "-r"} <= options_of(command).keys()


def options_of(command: click.Command) -> dict[str, click.Option]:
    """Return the options of a command by each of their names."""
    return {
        name: option
        for option in command.params
        if isinstance(option, click.Option)
        for name in [*option.opts, *option.secondary_opts]
    }


def test_a_link_leads_somewhere() -> None:
    """Links inside the repository name files that exist, and headings that they have."""
    dead = [
        f"{page}: {link['page']}#{link['anchor']}"
        for page in TEXTS
        for link in LINK.finditer(FENCED.sub("", (ROOT / page).read_text(encoding="utf-8")))
        if not exists(ROOT / page, link["page"], link["anchor"])
    ]

    assert dead == []


def exists(page: Path, target: str, anchor: str) -> bool:
    """Whether a link of a page leads to a file here, and to one of its headings if it names one."""
    file = page.parent / target if target else page
    return file.exists() and (not anchor or anchor in anchors(file))


def test_each_decision_has_a_line_in_the_index() -> None:
    """Whoever asks for a reason searches one page, and not a dozen."""
    folder = ROOT / "docs" / "decisions"
    index = (folder / "index.md").read_text(encoding="utf-8")
    missing = [
        f"{page.name}: {match['text']}"
        for page in sorted(folder.glob("*.md"))
        for match in HEADING.finditer(FENCED.sub("", page.read_text(encoding="utf-8")))
        if page.name != "index.md" and match[0].startswith("## ")
        if f"[{match['text']}]({page.name}#" not in index
    ]

    assert missing == []


def anchors(page: Path) -> set[str]:
    """Return the anchors of a page's headings, as GitHub and MyST make them."""
    text = FENCED.sub("", page.read_text(encoding="utf-8"))
    return {
        re.sub(r"[^\w -]", "", heading["text"].lower()).replace(" ", "-")
        for heading in HEADING.finditer(text)
    }


def test_a_page_has_one_sentence_for_each_line() -> None:
    """A change to a sentence is then a change to a line."""
    for page in PAGES:
        text = BLOCK.sub("", (ROOT / page).read_text(encoding="utf-8"))
        prose = [line for line in text.splitlines() if not re.match(r"[|# *-]|\d+\.", line)]

        assert [line for line in prose if re.search(r"[a-z`)]\. [A-Z]", line)] == [], page


def test_a_hop_of_a_message_is_a_function_of_its_file() -> None:
    """docs/follow_one_message.md names functions to open, so each has to be where it says."""
    page = (ROOT / "docs/follow_one_message.md").read_text(encoding="utf-8")
    hops = {(hop["file"], hop["name"]) for hop in HOP.finditer(page)}

    assert hops
    for file, name in hops:
        assert fragment((ROOT / file).read_text(encoding="utf-8"), name), (file, name)


def test_the_design_says_where_to_find_things() -> None:
    """Whoever looks for a behaviour opens the file that docs/design.md names."""
    page = (ROOT / "docs/design.md").read_text(encoding="utf-8")
    section = page.partition("\n## Where to find it\n")[2].partition("\n## ")[0]
    places = {(place["file"], place["name"]) for place in PLACE.finditer(section)}

    assert len(places) >= 30
    for file, name in places:
        assert fragment((ROOT / "aionode" / file).read_text(encoding="utf-8"), name), (file, name)


@dataclass(frozen=True)
class Term:
    """A row of the glossary: its words, the classes named with them, and where to look."""

    words: str
    classes: list[str]
    place: str


def glossary() -> list[Term]:
    """Return every row of the glossary."""
    text = (ROOT / "docs/glossary.md").read_text(encoding="utf-8")
    return [
        Term(re.sub(r"\(.*?\)", "", row["words"]), NAME.findall(row[0]), row["place"])
        for row in TERM.finditer(text)
    ]


def test_the_glossary_explains_what_is_in_the_code() -> None:
    """Words that the code no longer has are removed from the glossary."""
    source, written_together = source_of_aionode()

    assert glossary()
    for term in glossary():
        words = [re.sub(r"[\s-]", "", word.lower()) for word in term.words.split(",")]

        assert [word for word in words if word not in written_together] == []
        assert [name for name in term.classes if not re.search(rf"class {name}\b", source)] == []
        assert (ROOT / term.place).exists(), term.place


def source_of_aionode() -> tuple[str, str]:
    """Return the source of all modules but the messages, and the same as one lowercase word."""
    modules = sorted((ROOT / "aionode").rglob("*.py"))
    source = "\n".join(
        module.read_text(encoding="utf-8") for module in modules if "interfaces" not in module.parts
    )
    return source, re.sub(r"[\s_-]", "", source.lower())
