"""Lists in the pages of the reference what Sphinx shows there, for those who read the files.

Below each block of directives stands a list of its classes, methods and functions, each with its
signature and the first sentence of its docstring. ``make quotes`` brings these lists up to date,
and Sphinx leaves them out.
"""

from __future__ import annotations

import ast
import enum
import inspect
import re
from functools import cache
from importlib import import_module
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Any, Final

from aionode._distribution import DISTRIBUTIONS
from aionode.idl._distribution_differences import differences
from aionode.interfaces import KINDS, interface_names, shipped_packages

ROOT: Final = Path(__file__).parent.parent
DIRECTIVE: Final = re.compile(
    r"^\.\. auto(?P<kind>\w+):: (?P<name>[\w.]+)(?P<closed>\(\))?.*\n(?P<options>(?:   :.*\n)*)",
    re.MULTILINE,
)
BEGIN: Final = "<!-- contents, for readers of this file: make quotes -->"
END: Final = "<!-- end of contents -->"
LIST: Final = re.compile(rf"\n*{re.escape(BEGIN)}.*?{re.escape(END)}\n", re.DOTALL)
TYPES: Final = re.compile(
    r"(?P<begin><!-- interfaces, .*? -->\n).*(?=<!-- end of interfaces -->)", re.DOTALL
)
HEADING: Final = (
    "In short, with the signature and the file of each name.\n"
    "Its docstring there says the rest, and `make docs` shows all of them on this page.\n"
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
    lines = lines_for(match["name"], found, members=members, inherited=inherited)
    if match["closed"]:  # it is not for users to make
        lines[0] = re.sub(r"^- `([\w.]+)\(.*?\)`, in", r"- `\1`, in", lines[0])
    return lines


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
        shown = f" = {found!r}" if isinstance(found, bool | int | float | str) else ""
        return [f"- `{name}{shown}`"]
    file = found.__module__.replace(".", "/")
    file += ".py" if (ROOT / f"{file}.py").exists() else "/__init__.py"
    lines = [f"- `{signature(name, found)}`, in `{file}`: {first_sentence(found)}"]
    if isinstance(found, type) and members:
        lines += [
            f"  - `{signature(member, value)}`: {first_sentence(value)}"
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


def signature(name: str, found: Any) -> str:
    """Return how something is called, or the type of a property, as its source has it."""
    if isinstance(found, type):
        return name + class_arguments(found)
    if isinstance(found, property):
        getter = definition(found.fget)
        return f"{name}: {ast.unparse(getter.returns)}" if getter and getter.returns else name
    function = definition(found)
    if function is None:
        return name
    result = f" -> {ast.unparse(function.returns)}" if function.returns else ""
    prefix = "async " if isinstance(function, ast.AsyncFunctionDef) else ""
    return f"{prefix}{name}({arguments(function)}){result}"


def class_arguments(cls: type) -> str:
    """Return the arguments of a class in parentheses; nothing where its source has none."""
    if issubclass(cls, enum.Enum) or getattr(cls, "_is_protocol", False):
        return ""
    if function := definition(cls.__init__):
        return f"({arguments(function)})"
    if hasattr(cls, "__struct_fields__") or hasattr(cls, "_fields"):  # msgspec's, or a named tuple
        return f"({', '.join(fields(cls))})"
    return ""


def fields(cls: type) -> list[str]:
    """Return the public fields of a class of aionode, the inherited ones first."""
    found: dict[str, str] = {}
    for each in reversed(cls.__mro__):
        body = classes_of(each.__module__).get(each.__qualname__)
        for statement in body.body if body else ():
            if isinstance(statement, ast.AnnAssign):
                text = ast.unparse(statement)
                if not text.startswith("_") and "ClassVar" not in text:
                    found[text.partition(":")[0]] = text
    return list(found.values())


def arguments(function: ast.FunctionDef | ast.AsyncFunctionDef) -> str:
    """Return the arguments of a function as code has them, without `self` and `cls`."""
    given = function.args
    names = [*given.posonlyargs, *given.args]
    free = [None] * (len(names) - len(given.defaults))  # have no default
    texts = [argument(*each) for each in zip(names, [*free, *given.defaults], strict=True)]
    if given.posonlyargs:
        texts.insert(len(given.posonlyargs), "/")
    if names and names[0].arg in {"self", "cls"}:
        del texts[: 2 if len(given.posonlyargs) == 1 else 1]
    if given.vararg or given.kwonlyargs:
        texts.append(f"*{argument(given.vararg) if given.vararg else ''}")
    texts += [argument(*each) for each in zip(given.kwonlyargs, given.kw_defaults, strict=True)]
    if given.kwarg:
        texts.append(f"**{argument(given.kwarg)}")
    return ", ".join(texts)


def argument(found: ast.arg, default: ast.expr | None = None) -> str:
    """Return one argument with its type and default."""
    equals = " = " if found.annotation else "="
    return ast.unparse(found) + (equals + ast.unparse(default) if default else "")


def definition(found: Any) -> ast.FunctionDef | ast.AsyncFunctionDef | None:
    """Return the source of a function of aionode."""
    code = getattr(inspect.unwrap(found), "__code__", None)
    if code is None or "aionode" not in code.co_filename:
        return None
    return functions_of(code.co_filename).get((code.co_name, code.co_firstlineno))


@cache
def functions_of(
    path: str,
) -> dict[tuple[str, int], ast.FunctionDef | ast.AsyncFunctionDef]:
    """Return the functions in a file by name and first line, as code has them."""
    return {
        (node.name, min([node.lineno, *(each.lineno for each in node.decorator_list)])): node
        for node in ast.walk(ast.parse(Path(path).read_text(encoding="utf-8")))
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)
    }


@cache
def classes_of(module: str) -> dict[str, ast.ClassDef]:
    """Return the classes of a module of aionode by name."""
    if not module.startswith("aionode"):
        return {}
    tree = ast.parse(inspect.getsource(import_module(module)))
    return {node.name: node for node in tree.body if isinstance(node, ast.ClassDef)}
