"""Generates typed Python modules from interfaces.

Each package becomes a folder with ``msg.py``, ``srv.py`` and ``action.py``, in ruff's format.
Docstrings are the comments at the top of the definitions; where there are none, docstrings of
existing modules are kept, so they can be edited.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import aionode.message
from aionode.idl._build import Builder
from aionode.idl._definition import HALVES, InterfaceText, split_type_name
from aionode.idl._folder import read_folder
from aionode.idl._python_source import (
    WIDTH,
    class_line,
    doc_lines,
    import_lines,
    import_order,
    literal,
    wrapped,
)
from aionode.message import (
    Constant,
    Field,
    FieldType,
    Interface,
    Message,
    constants,
    fields,
    type_name,
)

__all__ = ["generate"]

KIND_NAMES = {"msg": "Messages", "srv": "Services", "action": "Actions"}
BASE_NAMES = {"msg": "Message", "srv": "ServiceType", "action": "ActionType"}
NUMBERS = {"bool": "Bools", "float32": "Floats", "float64": "Floats"}
ZEROS = {"bool": "False", "byte": 'b"\\x00"', "float32": "0.0", "float64": "0.0", "string": '""'}
ZEROS["wstring"] = ZEROS["string"]
MODULE_TEXT = """{what} of {package}.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""


def generate(path: str | Path, out_dir: str | Path) -> list[Path]:
    """Write the interfaces of a folder as Python modules; return the written files.

    A package ``my_msgs`` becomes ``my_msgs/msg.py`` and so on in `out_dir`. If that folder is a
    Python package (has an ``__init__.py``), the modules import each other as parts of it; otherwise
    as top-level packages, which requires `out_dir` on the path. Types of other packages are
    imported from aionode.interfaces.

    Args:
        path: A package with ``msg``, ``srv`` or ``action`` folders, or a folder of packages.
        out_dir: Folder to write to; missing folders are created.

    Raises:
        IdlError: A definition is not valid; nothing is written in that case.
        FileNotFoundError: The folder `path` does not exist.
    """
    texts = read_folder(path)
    builder = Builder(texts, reuse=False)
    out = Path(out_dir).resolve()
    groups: dict[tuple[str, str], list[InterfaceText]] = {}
    for typename in sorted(texts):
        builder.build(typename)
    for typename in builder.built:  # each after the types it uses
        package, kind, _ = split_type_name(typename)
        groups.setdefault((package, kind), []).append(texts[typename])
    module_of_interfaces = {
        package: ".".join((*python_package(out), package)) for package, _ in groups
    }
    sources: dict[Path, str] = {}
    for (package, kind), members in groups.items():
        file = out / package / f"{kind}.py"
        module = Module(package, kind, module_of_interfaces, docstrings(file))
        sources[file] = module.source([(text, builder.built[text.typename]) for text in members])
        top = out / package / "__init__.py"
        sources[top] = f'"""{docstrings(top).get((), f"Interfaces of {package}.")}"""\n'
    for file, source in sources.items():
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(source, encoding="utf-8")
    return list(sources)


def python_package(folder: Path) -> tuple[str, ...]:
    """Return the parts of a folder's dotted name as a Python package; empty if it is not one."""
    parts: list[str] = []
    while (folder / "__init__.py").is_file():
        parts.insert(0, folder.name)
        folder = folder.parent
    return tuple(parts)


def docstrings(file: Path) -> dict[tuple[str, ...], str]:
    """Return the docstrings of a module and its classes, by qualified name in parts."""
    if not file.is_file():
        return {}
    texts: dict[tuple[str, ...], str] = {}

    def collect(node: ast.Module | ast.ClassDef, names: tuple[str, ...]) -> None:
        text = ast.get_docstring(node)
        if text:
            texts[names] = text
        for inner in node.body:
            if isinstance(inner, ast.ClassDef):
                collect(inner, (*names, inner.name))

    collect(ast.parse(file.read_text(encoding="utf-8")), ())
    return texts


class Module:
    """Generates the module of one kind of interface of one package."""

    def __init__(
        self,
        package: str,
        kind: str,
        module_of_interfaces: dict[str, str],
        docs: dict[tuple[str, ...], str],
    ) -> None:
        self.package = package
        self.kind = kind
        self.module_of_interfaces = module_of_interfaces
        self.docs = docs
        self.imports: dict[str, set[str]] = {}
        """Names to import, by module; ``Name as Other`` where the name is taken."""
        self.taken: set[str] = set()
        """Names of classes, fields and constants of this module."""
        self.classes: dict[str, str] = {}
        """Local names of messages of other packages, by ROS name."""

    def source(self, members: list[tuple[InterfaceText, type[Interface]]]) -> str:
        """Return the text of the module."""
        for text, cls in members:
            self.taken.add(split_type_name(text.typename)[2])
            for message in messages_of(cls, self.kind):
                self.taken.update(field.name for field in fields(message))
                self.taken.update(constant.name for constant in constants(message))
        classes = ["\n".join(self.interface(text, cls)) for text, cls in members]
        names = [split_type_name(text.typename)[2] for text, _ in members]
        head = MODULE_TEXT.format(what=KIND_NAMES[self.kind], package=self.package)
        parts = [f'"""{self.docs.get((), head.strip())}\n"""', "\n".join(self.import_lines())]
        exported = [f'"{name}"' for name in sorted(names, key=import_order)]
        parts.append("\n".join(wrapped("__all__ = [", exported, "]")))
        return "\n\n".join(parts) + "\n\n\n" + "\n\n\n".join(classes) + "\n"

    def interface(self, text: InterfaceText, cls: type[Interface]) -> Iterator[str]:
        """Yield the lines of one class, with its messages if it is a service or an action."""
        name = split_type_name(text.typename)[2]
        bases = [self.helper(BASE_NAMES[self.kind]), f'typename="{text.typename}"']
        yield from class_line(name, bases, "")
        comment = text.parts[0].comment
        yield from doc_lines(comment or self.doc(name, fallback=f"{name}."), "    ")
        if issubclass(cls, Message):
            yield from self.body(cls, "    ")
            return
        for half, part in zip(HALVES[self.kind], text.parts, strict=True):
            yield ""
            yield from class_line(half, [self.helper("Message")], "    ")
            own = part.comment if half != HALVES[self.kind][0] else ""
            fallback = f"The {half.lower()} of {name}."
            yield from doc_lines(own or self.doc(name, half, fallback=fallback), "        ")
            yield from self.body(getattr(cls, half), "        ")

    def doc(self, *names: str, fallback: str) -> str:
        """Return the docstring of a class in the existing module, or `fallback`."""
        return self.docs.get(names, fallback)

    def body(self, cls: type[Message], indent: str) -> Iterator[str]:
        """Yield the lines of the constants and fields of a message."""
        groups: tuple[tuple[Constant | Field, ...], ...] = (constants(cls), fields(cls))
        for members in groups:
            if members:
                yield ""
            for member in members:
                yield from self.member(member, indent)

    def member(self, member: Constant | Field, indent: str) -> Iterator[str]:
        """Yield the line of one constant or field; several if it is long."""
        if isinstance(member, Constant):
            annotation = f"{self.outside('typing', 'ClassVar')}[{self.one(member.type)}]"
            value = literal(member.value)
        else:
            annotation = self.annotation(member.type, plain=isinstance(member.default, tuple))
            value = self.default(member)
        line = f"{indent}{member.name}: {annotation} = {value}"
        if len(line) > WIDTH and isinstance(member, Field) and isinstance(member.default, tuple):
            start = f"{indent}{member.name}: {annotation} = ("
            yield from wrapped(start, list(map(literal, member.default)), ")", indent)
        elif (
            len(line) > WIDTH and len(start := f"{indent}{member.name}: {annotation} = (") <= WIDTH
        ):
            yield from (start, f"{indent}    {value}", f"{indent})")
        elif len(line) > WIDTH:
            before, inside = annotation.split("[", 1)
            yield f"{indent}{member.name}: {before}["
            yield from (f"{indent}    {inside[:-1]}", f"{indent}] = {value}")
        else:
            yield line

    def default(self, field: Field) -> str:
        """Return the expression of a field's default."""
        if field.default is not None:
            return literal(field.default)
        if field.type.form == "value" and field.type.nested is None:
            return ZEROS.get(field.type.kind, "0")
        return self.helper("DEFAULT")

    def annotation(self, type_: FieldType, *, plain: bool) -> str:
        """Return the annotation of a field; `plain` omits the part for type checkers."""
        element = self.one(type_)
        if type_.container == "single":
            return element
        holder = self.helper("Array" if type_.container == "array" else "Sequence")
        size = f", {type_.size}" if type_.size else ""
        exact = f"{holder}[{element}{size}]"
        if plain:
            return exact
        if type_.form == "list":
            seen = f"{self.builtin('list')}[{element if type_.nested else self.builtin('str')}]"
        else:
            seen = self.helper(
                "Bytes" if type_.form == "bytes" else NUMBERS.get(type_.kind, "Ints")
            )
        return f"{self.outside('typing', 'Annotated')}[{seen}, {exact}]"

    def one(self, type_: FieldType) -> str:
        """Return the annotation of a single value."""
        if type_.nested is not None:
            return self.message_name(type_name(type_.nested))
        if type_.kind in {"bool", "string"}:
            name = self.builtin("bool" if type_.kind == "bool" else "str")
        else:
            name = self.helper(type_.kind)
        if type_.string_bound is None:
            return name
        return f"{self.helper('Bounded')}[{name}, {type_.string_bound}]"

    def message_name(self, typename: str) -> str:
        """Return the name of a message class in this module."""
        package, kind, name = split_type_name(typename)
        if (package, kind) == (self.package, self.kind):
            return name
        if typename not in self.classes:
            used = {*self.taken, *self.classes.values(), *aionode.message.__all__}
            module = (
                f"{self.module_of_interfaces.get(package, f'aionode.interfaces.{package}')}.{kind}"
            )
            prefix = package.title().replace("_", "")
            self.classes[typename] = f"{prefix}{name}" if name in used else name
            self.need(module, name, self.classes[typename])
        return self.classes[typename]

    def helper(self, name: str) -> str:
        """Import a name from aionode.message; return its local name."""
        return self.outside("aionode.message", name)

    def builtin(self, name: str) -> str:
        """Return the local name of a builtin."""
        return self.outside("builtins", name) if name in self.taken else name

    def outside(self, module: str, name: str) -> str:
        """Import a name; return its local name, which ends in ``_`` if the name is taken."""
        here = f"{name}_" if name in self.taken else name
        self.need(module, name, here)
        return here

    def need(self, module: str, name: str, here: str) -> None:
        """Add an import."""
        self.imports.setdefault(module, set()).add(name if name == here else f"{name} as {here}")

    def import_lines(self) -> Iterator[str]:
        """Yield the import statements, the standard library's first."""
        sections: dict[str, list[str]] = {"standard": [], "aionode": [], "own": []}
        for module in sorted(self.imports):
            standard = module in {"builtins", "typing"}
            section = "standard" if standard else "aionode" if is_aionode(module) else "own"
            sections[section].extend(import_lines(module, self.imports[module]))
        filled = [lines for lines in sections.values() if lines]
        yield "\n\n".join("\n".join(lines) for lines in filled)


def is_aionode(module: str) -> bool:
    """Return whether a module belongs to this library."""
    return module.partition(".")[0] == "aionode"


def messages_of(cls: type[Interface], kind: str) -> list[type[Message]]:
    """Return the messages that an interface consists of."""
    return [cls] if issubclass(cls, Message) else [getattr(cls, half) for half in HALVES[kind]]
