"""XML and YAML launch files as elements that know their line numbers."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any
from xml.parsers import expat

import yaml

from aionode._process.bounded_yaml import composed_yaml, value_of_node
from aionode.errors import LaunchFileError

__all__ = ["Element", "read_xml", "read_yaml"]


MAX_DEPTH = 100
"""Maximum nesting of elements in XML; YAML has its own limit."""


@dataclass
class Element:
    """One element: its name, attributes and children."""

    name: str
    where: str
    attributes: dict[str, Any] = field(default_factory=dict)
    children: list[Element] = field(default_factory=list)

    def all(self, name: str) -> Iterator[Element]:
        """Yield the children with this name."""
        return (child for child in self.children if child.name == name)


def read_xml(path: str, text: bytes) -> Element:
    """Return the root element of a file.

    A document type is refused: its entities could grow without bound, and read other files.

    Raises:
        LaunchFileError: It is not a valid launch file.
    """
    parser = expat.ParserCreate()
    root = Element("", path)
    stack = [root]

    def start(name: str, attributes: dict[str, str]) -> None:
        element = Element(name, f"{path}:{parser.CurrentLineNumber}", attributes)
        stack[-1].children.append(element)
        stack.append(element)
        if len(stack) > MAX_DEPTH:
            problem = f"elements nested deeper than {MAX_DEPTH}"
            raise LaunchFileError(path, problem, line=parser.CurrentLineNumber)

    def refuse(*_: object) -> None:
        raise LaunchFileError(
            path, "a document type (<!DOCTYPE>) is not supported", line=parser.CurrentLineNumber
        )

    def end(_: str) -> None:
        stack.pop()

    parser.StartElementHandler = start
    parser.EndElementHandler = end
    parser.StartDoctypeDeclHandler = refuse
    try:
        parser.Parse(text, True)
    except expat.ExpatError as error:
        problem = f"not valid XML: {expat.ErrorString(error.code)}"
        raise LaunchFileError(path, problem, line=error.lineno) from error
    return root.children[0]


def read_yaml(path: str, text: bytes) -> Element:
    """Return the root element of a file.

    Raises:
        LaunchFileError: It is not a valid launch file.
    """
    try:
        node = composed_yaml(text)
        if not isinstance(node, yaml.MappingNode):
            raise LaunchFileError(path, "expected 'launch:' and a list of actions", line=1)
        return next(elements(path, node), Element("", path))
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        problem = f"not valid YAML: {getattr(error, 'problem', None) or error}"
        line = None if mark is None else min(mark.line, text.rstrip().count(b"\n")) + 1
        raise LaunchFileError(path, problem, line=line) from error


def elements(path: str, node: yaml.MappingNode) -> Iterator[Element]:
    """Yield the elements for the keys of a mapping."""
    for key, value in node.value:
        yield element(path, str(key.value), value, key.start_mark.line + 1)


def element(path: str, name: str, node: yaml.Node, line: int) -> Element:
    """Return the element of this name described by a value."""
    result = Element(name, f"{path}:{line}")
    if isinstance(node, yaml.SequenceNode):
        result.children = list(children(path, node, name))
    elif isinstance(node, yaml.MappingNode):
        for key, value in node.value:
            fill(result, path, str(key.value), value)
    elif node.value:
        raise LaunchFileError(path, f"'{name}' is {node.value!r}; use a mapping", line=line)
    return result


def fill(parent: Element, path: str, key: str, value: yaml.Node) -> None:
    """Add one key of a mapping to an element: an attribute, or elements of this name."""
    if key == "children" and isinstance(value, yaml.SequenceNode):
        parent.children += children(path, value, parent.name)
    elif isinstance(value, yaml.SequenceNode) and any(
        isinstance(item, yaml.MappingNode) for item in value.value
    ):
        for item in value.value:
            parent.children.append(element(path, key, item, item.start_mark.line + 1))
    else:
        parent.attributes[key] = value_of_node(value)


def children(path: str, node: yaml.SequenceNode, name: str) -> Iterator[Element]:
    """Yield the elements of a list of mappings, each with one key: the name of an action."""
    for item in node.value:
        if not isinstance(item, yaml.MappingNode):
            at = item.start_mark.line + 1
            problem = f"in '{name}', {item.value!r} is not an action; use a mapping"
            raise LaunchFileError(path, problem, line=at)
        yield from elements(path, item)
