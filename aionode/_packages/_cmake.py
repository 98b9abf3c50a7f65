"""Reads which files a CMakeLists.txt installs, without running it."""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import islice, pairwise
from pathlib import Path
from typing import Final, NamedTuple

__all__ = ["MAX_FILES", "Install", "calls_of", "installs_of", "matching"]

MAX_FILES: Final = 10_000
"""Maximum files and words of one rule that are read."""

MAX_FOLDERS: Final = 300
"""Maximum folders of a package whose CMakeLists.txt is read."""

MAX_BYTES: Final = 1_000_000
"""Maximum size of a CMakeLists.txt, in bytes."""

MAX_WORD: Final = 4096
"""Maximum length of a word, as variables that refer to each other grow without bound."""

COMMAND: Final = re.compile(r"(\w+)\s*\(([^()]*)\)")
WORD: Final = re.compile(r'"([^"]*)"|([^\s;"]+)')
VARIABLE: Final = re.compile(r"\$\{(\w+)\}")
KINDS: Final = ("FILES", "PROGRAMS", "DIRECTORY")
KEYWORDS: Final = frozenset(
    {
        *("DESTINATION", "TYPE", "PERMISSIONS", "FILE_PERMISSIONS", "DIRECTORY_PERMISSIONS"),
        *("USE_SOURCE_PERMISSIONS", "CONFIGURATIONS", "COMPONENT", "RENAME", "OPTIONAL"),
        *("FILES_MATCHING", "PATTERN", "REGEX", "EXCLUDE", "EXCLUDE_FROM_ALL", "MESSAGE_NEVER"),
    }
)
"""The keywords of ``install`` that end the list of files."""


class Install(NamedTuple):
    """A file or folder that is installed.

    Attributes:
        source: The file or folder.
        folder: The destination folder, below the prefix.
        name: Its name there; empty for a folder of which only the content is installed.
        is_program: Whether it is installed as an executable.
    """

    source: Path
    folder: str
    name: str
    is_program: bool = False


def installs_of(folder: Path, package: str) -> Iterator[Install]:
    """Yield the files and folders that a package's CMakeLists.txt installs.

    Variables set to lists of words or file patterns are followed, and so are folders of the package
    added by ``add_subdirectory``.
    """
    variables = {
        "PROJECT_NAME": [package],
        "CMAKE_INSTALL_PREFIX": ["."],
        "CMAKE_INSTALL_DATADIR": ["share"],
        "CMAKE_INSTALL_DATAROOTDIR": ["share"],
        "CMAKE_SOURCE_DIR": [str(folder)],
        "PROJECT_SOURCE_DIR": [str(folder)],
    }
    yield from installs_in(folder, variables, set())


def calls_of(folder: Path, package: str, function: str) -> list[list[str]]:
    """Return the arguments of each call of a function in a package's CMakeLists.txt."""
    variables = {"PROJECT_NAME": [package], "CMAKE_CURRENT_SOURCE_DIR": [str(folder)]}
    return [
        list(islice(words_of(rest, variables), MAX_FILES))
        for command, rest in COMMAND.findall(text_in(folder))
        if command.lower() == function
    ]


def text_in(folder: Path) -> str:
    """Return the CMakeLists.txt of a folder without its comments; empty if there is none."""
    try:
        with (folder / "CMakeLists.txt").open(encoding="utf-8", errors="replace") as file:
            return re.sub(r"#[^\n]*", "", file.read(MAX_BYTES))
    except OSError:
        return ""


def installs_in(
    folder: Path, variables: dict[str, list[str]], seen: set[Path]
) -> Iterator[Install]:
    """Yield what a folder's CMakeLists.txt installs, and those of the folders that it adds."""
    seen.add(folder)
    variables["CMAKE_CURRENT_SOURCE_DIR"] = [str(folder)]
    for command, rest in COMMAND.findall(text_in(folder)):
        words = list(islice(words_of(rest, variables), MAX_FILES))
        match command.lower(), words:
            case "project", [name, *_]:
                variables["PROJECT_NAME"] = [name]
            case "set", [name, *values]:
                variables[name] = values
            case "file", ["GLOB" | "GLOB_RECURSE" as kind, name, *patterns]:
                variables[name] = globbed(folder, patterns, deep=kind == "GLOB_RECURSE")
            case "install", [kind, *given] if kind in KINDS:
                yield from install_of(kind, given, folder)
            case "add_subdirectory", [name, *_] if ".." not in Path(name).parts:
                inner = folder / name
                is_new = inner not in seen and len(seen) < MAX_FOLDERS
                if is_new and inner != folder and inner.is_relative_to(folder):
                    yield from installs_in(inner, dict(variables), seen)


def words_of(text: str, variables: dict[str, list[str]]) -> Iterator[str]:
    """Yield the words of a command, with variables replaced."""
    for quoted, plain in WORD.findall(text):
        whole = VARIABLE.fullmatch(plain)
        if whole is not None:
            yield from variables.get(whole[1], ())
        else:
            yield replaced((quoted or plain)[:MAX_WORD], variables)[:MAX_WORD]


def replaced(word: str, variables: dict[str, list[str]]) -> str:
    """Replace the variables in a word; unknown ones are kept."""
    return VARIABLE.sub(
        lambda match: ";".join(variables.get(match[1], [match[0]]))[:MAX_WORD], word
    )


def globbed(folder: Path, patterns: list[str], *, deep: bool) -> list[str]:
    """Return the files of ``file(GLOB NAME launch/*.py)``."""
    if patterns[:1] == ["RELATIVE"]:
        patterns = patterns[2:]
    files: list[str] = []
    for pattern in patterns:
        if pattern not in ("CONFIGURE_DEPENDS", "LIST_DIRECTORIES", "true", "false"):
            parent, _, name = pattern.rpartition("/")
            whole = f"{parent}/**/{name}".lstrip("/") if deep and parent else pattern
            files += matching(folder, f"**/{name}" if deep and not parent else whole)
    return files


def matching(folder: Path, pattern: str) -> list[str]:
    """Return the files below a folder that match a pattern, named like `glob.glob` does."""
    import glob  # not needed by most programs

    within = pattern.removeprefix(f"{folder}/")
    if within.startswith("/") or ".." in within.split("/"):
        return []  # could search the whole disk
    found = glob.iglob(within, root_dir=folder, recursive=True)  # noqa: PTH207  # Path.glob includes hidden files
    return sorted(islice(found, MAX_FILES))


def install_of(kind: str, words: list[str], folder: Path) -> Iterator[Install]:
    """Yield what one ``install`` command installs."""
    end = next((at for at, word in enumerate(words) if word in KEYWORDS), len(words))
    files, rest = words[:end], words[end:]
    options = dict(pairwise(rest))
    if "DESTINATION" not in options:
        return
    into = options["DESTINATION"]
    for file in files:
        name = Path(file).name
        if kind == "DIRECTORY":
            name = "" if file.endswith("/") or name == "." else name
        else:
            name = options.get("RENAME", name)
        yield Install(folder / file, into, name, kind != "DIRECTORY")
