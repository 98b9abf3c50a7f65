"""Rules for names: validation, expansion and remapping.

A name goes through four steps, which `resolve` does in this order::

    validate  what the user wrote          ~/{node}_scan   (the rules of rcl)
    expand    to an absolute name          /ns/lidar/lidar_scan
    remap     the first rule that matches  /scan
    validate  the result                   /scan           (the stricter rules of rmw)

The error messages are those of rcl and rmw, which users may know or can look up.
"""

from __future__ import annotations

import re
from enum import Enum
from functools import lru_cache
from typing import TYPE_CHECKING, Literal

from msgspec import Struct

from aionode.errors import (
    InvalidNamespaceException,
    InvalidNodeNameException,
    InvalidRemapRuleError,
    InvalidServiceNameException,
    InvalidTopicNameException,
    brief,
)

if TYPE_CHECKING:
    from collections.abc import Iterable

__all__ = [
    "RemapKind",
    "RemapRule",
    "expand",
    "fully_qualified_name",
    "is_full_name",
    "is_full_node_name",
    "is_hidden",
    "is_plain",
    "is_type_name",
    "logger_name",
    "normalize_namespace",
    "remap",
    "remap_namespace",
    "remap_node_name",
    "resolve",
    "split_node_name",
    "validate_full_topic_name",
    "validate_namespace",
    "validate_node_name",
    "validate_topic_name",
]

NODE_NAME_MAX_LENGTH = 255
TOPIC_MAX_LENGTH = 247  # DDS allows 255, and rmw keeps 8 for a prefix and a suffix
NAMESPACE_MAX_LENGTH = 245  # leaves room for "/x"

ORDINARY = re.compile("~?[A-Za-z0-9_/]+")
PLAIN = re.compile("[A-Za-z0-9_/%@:,.+~-]*")
TYPE_NAME = re.compile("[A-Za-z][A-Za-z0-9_]*(/[A-Za-z][A-Za-z0-9_]*)+")

CHARACTERS = (
    "topic name must not contain characters other than alphanumerics, '_', '~', '{', or '}'"
)

BRACES = "topic name must not have unmatched (unbalanced) curly braces '{}'"

Problem = tuple[str, int]
"""The broken rule, and the index of the offending character."""


# Validation


def validate_topic_name(name: str, *, is_service: bool = False) -> Literal[True]:
    """Return True if `name` is valid for a topic or service.

    It may be relative or absolute, and contain ``~`` and ``{}``.

    Raises:
        InvalidTopicNameException: The name of a topic is invalid.
        InvalidServiceNameException: The name of a service is invalid.
    """
    expect_text(name, "service name" if is_service else "topic name")
    if problem := topic_name_problem(name):
        raise name_error(name, problem, is_service=is_service)
    return True


def validate_full_topic_name(name: str, *, is_service: bool = False) -> Literal[True]:
    """Return True if `name` is a valid absolute name after expansion.

    Raises:
        InvalidTopicNameException: The name of a topic is invalid.
        InvalidServiceNameException: The name of a service is invalid.
    """
    if problem := full_name_problem(name):
        raise name_error(name, problem, is_service=is_service)
    return True


def validate_namespace(namespace: str) -> Literal[True]:
    """Return True if `namespace` is valid: absolute, ``/`` for the root.

    Raises:
        InvalidNamespaceException: It is not.
    """
    expect_text(namespace, "namespace")
    if namespace == "/":
        return True
    problem = full_name_problem(namespace, "namespace", NAMESPACE_MAX_LENGTH)
    if problem:
        raise InvalidNamespaceException(namespace, *problem)
    return True


def validate_node_name(node_name: str) -> Literal[True]:
    """Return True if `node_name` is one word of letters, digits and ``_``.

    Raises:
        InvalidNodeNameException: It is not.
    """
    expect_text(node_name, "node name")
    if problem := node_name_problem(node_name):
        raise InvalidNodeNameException(node_name, *problem)
    return True


def expect_text(name: object, what: str) -> None:
    """Raise TypeError unless `name` is a str."""
    if not isinstance(name, str):
        raise TypeError(f"{what}: got {brief(name)} ({type(name).__name__}); a str is needed")


def topic_name_problem(name: str) -> Problem | None:
    """Return the rule of rcl that an unexpanded name breaks, or None."""
    if not name:
        return "topic name must not be empty string", 0
    if is_digit(name[0]):
        return "topic name token must not start with a number", 0
    if name.endswith("/"):
        return "topic name must not end with a forward slash", len(name) - 1
    return character_problem(name) or token_problem(name)


def character_problem(name: str) -> Problem | None:
    """Return the problem of the first character that is not allowed where it is, or None."""
    if ORDINARY.fullmatch(name):
        return None
    opened = -1  # index of the open brace
    for i, char in enumerate(name):
        if char == "~":
            if i > 0:
                return "topic name must not have tilde '~' unless it is the first character", i
            continue
        inside = opened >= 0
        problem = problem_inside(char, first=i == opened + 1) if inside else problem_outside(char)
        if problem:
            return problem, i
        if char in "{}":
            opened = i if char == "{" else -1
    return (BRACES, opened) if opened >= 0 else None


def problem_inside(char: str, *, first: bool) -> str | None:
    """Return the problem of a character between braces, or None."""
    if char == "}":
        return None
    if first and is_digit(char):
        return "substitution name must not start with a number"
    if not is_word(char):
        return "substitution name must not contain characters other than alphanumerics or '_'"
    return None


def problem_outside(char: str) -> str | None:
    """Return the problem of a character outside braces, or None."""
    if char == "}":
        return BRACES
    return None if is_word(char) or char in "/{" else CHARACTERS


def token_problem(name: str) -> Problem | None:
    """Return the problem of the first token with an invalid first character, or None."""
    if name[0] == "~" and len(name) > 1 and name[1] != "/":
        # rcl does not check the last character, so it accepts "~a" but not "~ab". Here both are
        # refused.
        return (
            "topic name must not have a tilde '~' that is not followed by a forward slash '/'",
            1,
        )
    starts_with_digit = any(is_digit(token[:1]) for token in name.split("/"))
    if starts_with_digit and (match := re.search("/(?=[0-9])", name)):
        return "topic name token must not start with a number", match.end()
    return None


def full_name_problem(
    name: str, what: str = "topic name", max_length: int = TOPIC_MAX_LENGTH
) -> Problem | None:
    """Return the rule of rmw that an absolute name breaks, or None; `what` is its subject."""
    if not name:
        return f"{what} must not be empty", 0
    if name[0] != "/":
        return f"{what} must be absolute, it must lead with a '/'", 0
    if name[-1] == "/":
        unless = ", unless only a '/'" if what == "namespace" else ""
        return f"{what} must not end with a '/'{unless}", len(name) - 1
    if not all(map(is_token, name[1:].split("/"))):
        return part_problem(name, what)
    if len(name) > max_length:
        subject = "topic length" if what == "topic name" else what
        return f"{subject} should not exceed '{max_length}'", max_length - 1
    return None


def part_problem(name: str, what: str) -> Problem | None:
    """Return the problem of a name's characters, or of the first character of a token."""
    if match := re.search("[^A-Za-z0-9_/]", name):
        return (
            f"{what} must not contain characters other than alphanumerics, '_', or '/'",
            match.start(),
        )
    if match := re.search("/(?=[/0-9])", name):
        index = match.end()
        if name[index] == "/":
            return f"{what} must not contain repeated '/'", index
        return f"{what} must not have a token that starts with a number", index
    return None


def node_name_problem(name: str) -> Problem | None:
    """Return the rule of rmw that a node name breaks, or None."""
    if not name:
        return "node name must not be empty", 0
    if not is_token(name) and (match := re.search("[^A-Za-z0-9_]", name)):
        return (
            "node name must not contain characters other than alphanumerics or '_'",
            match.start(),
        )
    if is_digit(name[0]):
        return "node name must not start with a number", 0
    if len(name) > NODE_NAME_MAX_LENGTH:
        limit = NODE_NAME_MAX_LENGTH
        return f"node name length should not exceed '{limit}'", limit - 1
    return None


def name_error(
    name: str, problem: Problem, *, is_service: bool
) -> InvalidTopicNameException | InvalidServiceNameException:
    """Return the error for an invalid topic or service name."""
    error = InvalidServiceNameException if is_service else InvalidTopicNameException
    return error(name, *problem)


def is_digit(char: str) -> bool:
    """Return whether `char` is an ASCII digit; str.isdigit() accepts those of all scripts."""
    return "0" <= char <= "9"


def is_token(text: str) -> bool:
    """Return whether `text` is ASCII letters, digits and ``_``, and does not start with a digit."""
    return text.isascii() and text.isidentifier()


def is_word(char: str) -> bool:
    """Return whether `char` is allowed anywhere in a token."""
    return char == "_" or (char.isascii() and char.isalnum())


# Expansion


def expand(name: str, node_name: str, namespace: str, *, is_service: bool = False) -> str:
    """Return the absolute form of `name` as used by a node.

    ``~`` becomes the node's full name; ``{node}``, ``{ns}`` and ``{namespace}`` are filled in; a
    name that is still relative is prefixed with the node's namespace. The result may still be
    invalid: check it with `validate_full_topic_name`.

    Raises:
        InvalidTopicNameException: The name is invalid, or has an unknown substitution.
        InvalidServiceNameException: The same for a service.
        InvalidNodeNameException: The node's name is invalid.
        InvalidNamespaceException: The namespace is invalid.
    """
    validate_topic_name(name, is_service=is_service)
    validate_node_name(node_name)
    validate_namespace(namespace)
    substitutions = {"{node}": node_name, "{ns}": namespace, "{namespace}": namespace}

    def fill_in(match: re.Match[str]) -> str:
        value = substitutions.get(match[0])
        if value is None:
            problem = f"unknown substitution: {match[0]}"
            raise name_error(name, (problem, match.start()), is_service=is_service)
        return value

    expanded = re.sub(r"\{[^}]*\}", fill_in, name) if "{" in name else name
    return absolute(expanded, node_name, namespace)


def absolute(name: str, node_name: str, namespace: str) -> str:
    """Resolve `name` against the node (``~``) or its namespace (relative); keep absolute names."""
    if name.startswith("~"):
        return fully_qualified_name(namespace, node_name) + name[1:]
    if name.startswith("/"):
        return name
    return fully_qualified_name(namespace, name)


def fully_qualified_name(namespace: str, node_name: str) -> str:
    """Return ``/ns/node``, or ``/node`` in the root namespace."""
    return f"/{node_name}" if namespace in {"/", ""} else f"{namespace}/{node_name}"


def logger_name(namespace: str, node_name: str) -> str:
    """Return the name of a node's logger: ``ns.node``, or ``node`` in the root namespace."""
    return fully_qualified_name(namespace, node_name)[1:].replace("/", ".")


def split_node_name(full_name: str) -> tuple[str, str]:
    """Return the namespace and name of a node; the inverse of `fully_qualified_name`."""
    namespace, _, node_name = full_name.rpartition("/")
    return namespace or "/", node_name


def normalize_namespace(namespace: str | None) -> str:
    """Return `namespace` in normal form: absolute, and ``/`` if empty.

    Raises:
        InvalidNamespaceException: The result is invalid.
    """
    if namespace is None or namespace == "":
        return "/"
    expect_text(namespace, "namespace")
    result = namespace if namespace.startswith("/") else f"/{namespace}"
    validate_namespace(result)
    return result


def is_plain(*names: str) -> bool:
    """Return whether names sent by another process consist of the characters of ROS names.

    Anything else is not a ROS name, and could carry escape sequences for the terminal that lists
    it.
    """
    return all(PLAIN.fullmatch(name) for name in names)


def is_full_name(name: str) -> bool:
    """Return whether an absolute name sent by another process is a possible ROS name.

    ROS nodes announce no others, and tools use names as paths, as in ``/../../etc``.
    """
    return full_name_problem(name) is None


def is_full_node_name(name: str, namespace: str, enclave: str = "/") -> bool:
    """Return whether a node name sent by another process is a possible ROS name."""
    return node_name_problem(name) is None and all(
        path == "/" or is_full_name(path) for path in (namespace, enclave)
    )


def is_type_name(name: str) -> bool:
    """Return whether a type name sent by another process is a possible ROS name."""
    return TYPE_NAME.fullmatch(name) is not None


def is_hidden(name: str) -> bool:
    """Return whether tools hide `name` by default: one of its tokens starts with ``_``."""
    return name.startswith("_") or "/_" in name


# Remapping


class RemapKind(Enum):
    """The kind of name that a remap rule changes."""

    NODE_NAME = "node name"
    NAMESPACE = "namespace"
    TOPIC = "topic"
    SERVICE = "service"
    TOPIC_OR_SERVICE = "topic or service"


WORD = "[A-Za-z_][A-Za-z0-9_]*"
# Not compiled here: `re` does so on first use, and most programs have no rules.
RULE = (
    rf"(?s)(?:(?P<node>{WORD}):(?!//|=))?(?P<url>rostopic://|rosservice://)?"
    r"(?P<match>.*?):=(?P<new>.*)"
)
MATCH = rf"(?:~/|/)?(?:{WORD}|\*\*?)(?:/(?:{WORD}|\*\*?))*"
REPLACEMENT = rf"(?:~/|/)?(?:{WORD}|\\[1-9])(?:/(?:{WORD}|\\[1-9]))*"
KINDS = {
    "__node": RemapKind.NODE_NAME,
    "__name": RemapKind.NODE_NAME,
    "__ns": RemapKind.NAMESPACE,
    "rostopic://": RemapKind.TOPIC,
    "rosservice://": RemapKind.SERVICE,
}


class RemapRule(Struct, frozen=True):
    r"""One rule that renames a node, topic or service.

    Its text is ``match:=replacement``:

    ======================== ============================================================
    ``foo:=bar``             topics and services; both sides are expanded as names are
    ``rostopic://foo:=bar``  topics only; ``rosservice://`` services only
    ``node:foo:=bar``        in nodes of this name only
    ``__node:=new``          the node's name (also ``__name``)
    ``__ns:=/new``           the node's namespace
    ``/foo/*:=/bar/\1``      ``*`` is one token, ``\1`` to ``\9`` what the wildcards matched
    ``/foo/**:=/bar/\1``     ``**`` is one or more tokens; in front of a name (``**/foo``) any
                             number of them, none included
    ======================== ============================================================

    Attributes:
        kind: What the rule changes.
        match: The names that it applies to; empty for a node's name or namespace.
        replacement: The new name.
        node: Name of the only node that it applies to, or None for all.
    """

    kind: RemapKind
    match: str
    replacement: str
    node: str | None = None

    @classmethod
    def parse(cls, text: str) -> RemapRule:
        """Parse a remap rule.

        Raises:
            InvalidRemapRuleError: It is not a rule; the error says what is wrong with it.
        """
        parts = re.fullmatch(RULE, text)
        if parts is None:
            raise InvalidRemapRuleError(text, "no ':='; a rule is 'from:=to'")
        node, url, match, new = parts.group("node", "url", "match", "new")
        if not url and match in {"__node", "__name", "__ns"}:
            kind = KINDS[match]
            check_special(text, kind, new)
            return cls(kind, "", new, node)
        check_sides(text, match, new)
        return cls(KINDS.get(url, RemapKind.TOPIC_OR_SERVICE), match, new, node)

    def __str__(self) -> str:
        """Return the text that `parse` reads."""
        word = {
            RemapKind.NODE_NAME: "__node",
            RemapKind.NAMESPACE: "__ns",
            RemapKind.TOPIC: f"rostopic://{self.match}",
            RemapKind.SERVICE: f"rosservice://{self.match}",
        }.get(self.kind, self.match)
        scope = f"{self.node}:" if self.node else ""
        return f"{scope}{word}:={self.replacement}"

    def applies_to(self, kind: RemapKind, node_name: str) -> bool:
        """Return whether the rule applies to names of `kind` in a node of this name."""
        if self.node is not None and self.node != node_name:
            return False
        if self.kind is RemapKind.TOPIC_OR_SERVICE:
            return kind in {RemapKind.TOPIC, RemapKind.SERVICE}
        return self.kind is kind

    def new_name(self, name: str, node_name: str, namespace: str) -> str | None:
        """Return the new name of an absolute `name`, or None if the rule does not match."""
        match = match_pattern(self.match, node_name, namespace).fullmatch(name)
        if match is None:
            return None
        new = self.replacement
        for number, captured in enumerate(match.groups(), start=1):
            new = new.replace(f"\\{number}", captured)
        # `**` in front captures "/a/b" or nothing, so slashes may meet or end the name.
        new = re.sub("/+", "/", new).rstrip("/")
        return absolute(new, node_name, namespace)


@lru_cache(maxsize=1024)
def match_pattern(match: str, node_name: str, namespace: str) -> re.Pattern[str]:
    """Compile a rule's left side, for one node, to a regular expression."""
    if match.startswith("**"):
        start, rest = "((?:/[^/]+)*)", match[2:]
    elif match.startswith("*"):
        start, rest = "", f"/{match}"  # a name that starts with a wildcard is absolute
    else:
        start, rest = "", absolute(match, node_name, namespace)
    wild = {"*": "([^/]+)", "**": "([^/]+(?:/[^/]+)*)"}
    tokens = (wild.get(token) or re.escape(token) for token in rest.split("/"))
    return re.compile(start + "/".join(tokens))


def check_special(text: str, kind: RemapKind, new: str) -> None:
    """Raise InvalidRemapRuleError if `new` cannot be a node's name or namespace."""
    if kind is RemapKind.NODE_NAME:
        problem = node_name_problem(new)
    elif new == "/":
        problem = None
    else:
        problem = full_name_problem(new, "namespace", NAMESPACE_MAX_LENGTH)
    if problem:
        raise InvalidRemapRuleError(text, f"'{new}' cannot be a {kind.value}: {problem[0]}")


def check_sides(text: str, match: str, new: str) -> None:
    """Raise InvalidRemapRuleError if one side of a rule for names is invalid."""
    names = "names are tokens of letters, digits and '_' with '/' between them, after '/' or '~/'"
    if not re.fullmatch(MATCH, match):
        problem = f"'{match}' cannot be matched; {names}, and a whole token may be '*' or '**'"
        raise InvalidRemapRuleError(text, problem)
    if not re.fullmatch(REPLACEMENT, new):
        problem = f"'{new}' is not a name; {names}, and a whole token may be '\\1' to '\\9'"
        raise InvalidRemapRuleError(text, problem)
    wildcards = sum(token in {"*", "**"} for token in match.split("/"))
    highest = max((int(digit) for digit in re.findall(r"\\([1-9])", new)), default=0)
    if highest > wildcards:
        problem = f"'\\{highest}' stands for wildcard {highest}, but '{match}' has {wildcards}"
        raise InvalidRemapRuleError(text, problem)


def remap(
    rules: Iterable[RemapRule],
    name: str,
    node_name: str,
    namespace: str,
    *,
    is_service: bool = False,
) -> str:
    """Apply the first matching rule to an absolute name; without one, return it unchanged.

    Only one rule applies: with ``/a:=/b /b:=/c``, ``/a`` becomes ``/b``. Give the node's own rules
    before those of the process.
    """
    kind = RemapKind.SERVICE if is_service else RemapKind.TOPIC
    for rule in rules:
        if rule.applies_to(kind, node_name):
            new = rule.new_name(name, node_name, namespace)
            if new is not None:
                return new
    return name


def remap_node_name(rules: Iterable[RemapRule], node_name: str) -> str:
    """Return the node's name after the first ``__node`` rule, if any.

    This rule's node scope is compared with the name as written in the code, that of all later rules
    with the new name.
    """
    return first_replacement(rules, RemapKind.NODE_NAME, node_name) or node_name


def remap_namespace(rules: Iterable[RemapRule], node_name: str, namespace: str) -> str:
    """Return the node's namespace after the first ``__ns`` rule, if any."""
    return first_replacement(rules, RemapKind.NAMESPACE, node_name) or namespace


def first_replacement(rules: Iterable[RemapRule], kind: RemapKind, node_name: str) -> str | None:
    """Return the replacement of the first rule of `kind` for this node."""
    for rule in rules:
        if rule.applies_to(kind, node_name):
            return rule.replacement
    return None


def resolve(
    name: str,
    node_name: str,
    namespace: str,
    rules: Iterable[RemapRule] = (),
    *,
    is_service: bool = False,
) -> str:
    """Resolve the name of a topic or service of a node to its absolute name.

    Raises:
        InvalidTopicNameException: `name` or its expansion is invalid.
        InvalidServiceNameException: The same for a service.
    """
    expanded = expand(name, node_name, namespace, is_service=is_service)
    validate_full_topic_name(expanded, is_service=is_service)
    remapped = remap(rules, expanded, node_name, namespace, is_service=is_service)
    if remapped is not expanded:
        validate_full_topic_name(remapped, is_service=is_service)
    return remapped
