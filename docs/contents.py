"""Lists in the pages of the reference what Sphinx shows there, for those who read the files.

Below each block of directives stands a list of its classes, methods and functions, each with the
first sentence of its docstring. ``make quotes`` brings these lists up to date, and Sphinx leaves
them out.
"""

from __future__ import annotations

import inspect
import re
from importlib import import_module
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Any, Final

from aionode._distribution import DISTRIBUTIONS
from aionode.idl._distribution_differences import differences
from aionode.interfaces import KINDS, interface_names, shipped_packages

ROOT: Final = Path(__file__).parent.parent
DIRECTIVE: Final = re.compile(
    r"^\.\. auto(?P<kind>\w+):: (?P<name>[\w.]+).*\n(?P<options>(?:   :.*\n)*)", re.MULTILINE
)
BEGIN: Final = "<!-- contents, for readers of this file: make quotes -->"
END: Final = "<!-- end of contents -->"
LIST: Final = re.compile(rf"\n*{re.escape(BEGIN)}.*?{re.escape(END)}\n", re.DOTALL)
TYPES: Final = re.compile(
    r"(?P<begin><!-- interfaces, .*? -->\n).*(?=<!-- end of interfaces -->)", re.DOTALL
)
HEADING: Final = (
    "In short, with the file of each name.\nIts docstring there says the rest, and `make docs` "
    "shows all of them on this page.\n"
)


def without_contents(page: str) -> str:
    """Return the text of a page without its list."""
    return LIST.sub("\n", page)


def with_contents(page: str) -> str:
    """Return the text of a page of the reference with its list as the docstrings have it now."""
    text = TYPES.sub(lambda match: f"{match['begin']}{shipped_types()}\n", without_contents(page))
    lines = [line for match in DIRECTIVE.finditer(text) for line in lines_of(match)]
    lines = list(dict.fromkeys(lines))
    if not lines:
        return text
    return "\n".join([text.rstrip("\n"), "", BEGIN, "", HEADING, *lines, "", END, ""])


def shipped_types() -> str:
    """Return the sections of the shipped packages: what each is for, and its types."""
    lines: list[str] = []
    for package in sorted(shipped_packages()):
        sentence = first_sentence(import_module(f"aionode.interfaces.{package}"))
        purpose = sentence.partition(": ")[2]
        lines += ["", f"## {package}", "", f"{purpose[:1].upper()}{purpose[1:]}", ""]
        for kind in KINDS:
            start = f"{package}/{kind}/"
            found = [name.removeprefix(start) for name in interface_names(package) if start in name]
            if found:
                lines.append(f"- {kind}: {', '.join(f'`{name}`' for name in found)}")
        for distribution in DISTRIBUTIONS:
            names = [name for name in differences(distribution) if name.startswith(f"{package}/")]
            if names and distribution != "rolling":
                texts = ", ".join(f"`{name.partition('/')[2]}`" for name in names)
                lines.append(f"- others in {distribution.title()}: {texts}")
    return "\n".join([*lines, ""])


def lines_of(match: re.Match[str]) -> list[str]:
    """Return the lines for one directive."""
    found = named(match["name"])
    members = ":no-members:" not in match["options"]
    if isinstance(found, ModuleType):
        names = getattr(found, "__all__", ()) if members else ()
        inner = [
            line
            for name in names
            for line in lines_for(f"{match['name']}.{name}", getattr(found, name))
        ]
        return [f"- `{match['name']}`: {first_sentence(found)}", *inner]
    inherited = ":inherited-members:" in match["options"]
    return lines_for(match["name"], found, members=members, inherited=inherited)


def named(name: str) -> Any:
    """Return what a dotted name stands for: a module, or something in one."""
    try:
        return import_module(name)
    except ModuleNotFoundError:
        module, _, last = name.rpartition(".")
        return getattr(named(module), last)


def lines_for(name: str, found: Any, *, members: bool = True, inherited: bool = False) -> list[str]:
    """Return the line of a class, function or value, and those of the members of a class."""
    if not isinstance(found, type | FunctionType):
        return [f"- `{name}`"]
    file = found.__module__.replace(".", "/")
    file += ".py" if (ROOT / f"{file}.py").exists() else "/__init__.py"
    lines = [f"- `{name}`, in `{file}`: {first_sentence(found)}"]
    if isinstance(found, type) and members:
        lines += [
            f"  - `{member}`: {first_sentence(value)}"
            for member, value in members_of(found, inherited=inherited).items()
        ]
    return lines


def members_of(cls: type, *, inherited: bool) -> dict[str, Any]:
    """Return the public methods and properties of a class that have a docstring."""
    classes = [each for each in cls.__mro__ if each.__module__.startswith("aionode")]
    found: dict[str, Any] = {}
    for each in classes if inherited else [cls]:
        for name, value in vars(each).items():
            function = getattr(value, "__func__", value)  # of a class method
            if not name.startswith("_") and isinstance(function, FunctionType | property):
                found.setdefault(name, function)
    return {name: value for name, value in found.items() if inspect.getdoc(value)}


def first_sentence(found: Any) -> str:
    """Return the first sentence of a docstring, as Markdown."""
    paragraph = (inspect.getdoc(found) or "").partition("\n\n")[0]
    sentence = re.split(r"(?<=[a-z`)])\. |: ?:$", " ".join(paragraph.split()))[0].rstrip(".:")
    return sentence.replace("``", "`") + "."
