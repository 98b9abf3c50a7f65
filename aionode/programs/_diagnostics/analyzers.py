"""The analyzers of diagnostic_aggregator: each reports on the parts of a robot it accepts."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Final, Protocol

from aionode.errors import CommandError
from aionode.interfaces.diagnostic_msgs.msg import DiagnosticStatus, KeyValue

__all__ = ["Analyzer", "Analyzers", "Group", "Other", "level_of"]

OK, WARN, ERROR, STALE = range(4)
NAMES: Final = ("OK", "Warning", "Error", "Stale")

TIMEOUT_SEC: Final = 5.0
MAX_ITEMS: Final = 10_000
"""Number of parts that an analyzer keeps, since any publisher may invent names."""

PACKAGE: Final = "diagnostic_aggregator/"


def level_of(status: DiagnosticStatus) -> int:
    """Return the level of a part as a number; anything but the four levels is an error."""
    level = status.level[0]
    return level if level <= STALE else ERROR


def report_of(name: str, level: int, message: str = "", **others: Any) -> DiagnosticStatus:
    """Return a part's state."""
    return DiagnosticStatus(name=name, level=bytes([level]), message=message, **others)


def output_name(name: str) -> str:
    """Return the name of a part without slashes, which would create groups."""
    return name.replace("/", " ")


def without_prefix(name: str, prefix: str) -> str:
    """Remove a prefix, and the separator after it, from the last part of a path."""
    if not prefix:
        return name
    start, slash, last = name.rpartition("/")
    return start + slash + last.removeprefix(prefix).removeprefix(":").lstrip(" ")


class Analyzer(Protocol):
    """Accepts parts of a robot, and reports on them.

    Attributes:
        path: The name of its own state.
        name: Its name for users.
    """

    path: str
    name: str

    def match(self, name: str) -> bool:
        """Return whether it accepts a part."""

    def analyze(self, status: DiagnosticStatus) -> None:
        """Process the state of a part."""

    def report(self) -> list[DiagnosticStatus]:
        """Return its own state, and those of all its parts, under its path."""


@dataclass
class Item:
    """The newest state of a part, and its arrival time in seconds."""

    status: DiagnosticStatus
    at: float


@dataclass
class Items:
    """The parts of an analyzer, and the state derived from theirs.

    Attributes:
        path: The name of its own state.
        name: Its name for users.
        now: Returns the time, in seconds.
        timeout: The time without news after which a part is stale; 0 for never.
        expected: The required number of parts; below 0, any number.
        is_forgetful: Whether stale parts are forgotten.
    """

    path: str
    name: str
    now: Callable[[], float]
    timeout: float = TIMEOUT_SEC
    expected: int = -1
    is_forgetful: bool = False
    items: dict[str, Item] = field(default_factory=dict)

    def analyze(self, status: DiagnosticStatus) -> None:
        """Process the state of a part."""
        if status.name in self.items or len(self.items) < MAX_ITEMS:
            self.items[status.name] = Item(status, self.now())

    def report(self) -> list[DiagnosticStatus]:
        """Return the group's own state, and those of all parts."""
        now = self.now()

        def is_stale(item: Item) -> bool:
            return self.timeout > 0 and now - item.at > self.timeout

        if self.is_forgetful:
            self.items = {name: item for name, item in self.items.items() if not is_stale(item)}
        level, all_stale = OK, True
        values, parts = [], []
        for name, item in sorted(self.items.items()):
            own = STALE if is_stale(item) else level_of(item.status)
            level = max(level, own)
            all_stale = all_stale and own == STALE
            values.append(KeyValue(key=name, value=item.status.message))
            parts.append(
                report_of(
                    f"{self.path}/{output_name(name)}",
                    own,
                    item.status.message,
                    hardware_id=item.status.hardware_id,
                    values=item.status.values,
                )
            )
        if all_stale:
            level = OK if self.is_forgetful else STALE
        elif level == STALE:
            level = ERROR  # the group's own state is stale only if all parts are
        message = NAMES[level]
        found = len(self.items)
        if self.expected == 0 and not found:
            level, message = OK, NAMES[OK]
        elif self.expected > 0 and found != self.expected:
            level = max(level, ERROR)
            message = f"Expected {self.expected}, found {found}"
            if not found:
                message = f"No items found, expected {self.expected}"
        return [report_of(self.path, level, message, values=values), *parts]


class Generic(Items):
    """``GenericAnalyzer``: accepts parts by their names.

    Args:
        path: The path of its group.
        parameters: Its configuration.
        now: Returns the time, in seconds.

    Raises:
        CommandError: It would accept nothing, or a parameter is invalid.
    """

    def __init__(self, path: str, parameters: Mapping[str, Any], now: Callable[[], float]) -> None:
        def texts(name: str) -> list[str]:
            value = parameters.get(name, [])
            if isinstance(value, str):
                return [value]
            if isinstance(value, list | tuple) and all(isinstance(each, str) for each in value):
                return list(value)
            raise CommandError(
                f"'{name}' of {parameters['path']} is {value!r}; use a list of strings"
            )

        def given(name: str, usual: Any) -> Any:
            value = parameters.get(name, usual)
            if type(value) is int and isinstance(usual, float):
                value = float(value)
            if type(value) is not type(usual):
                raise CommandError(
                    f"'{name}' of {parameters['path']} is {value!r}; "
                    f"its type has to be {type(usual).__name__}"
                )
            return value

        timeout, is_forgetful = given("timeout", TIMEOUT_SEC), given("discard_stale", False)
        super().__init__(
            f"{path}/{parameters['path']}",
            str(parameters["path"]),
            now,
            timeout,
            given("num_items", -1),
            is_forgetful and timeout > 0,
        )
        both = texts("find_and_remove_prefix")
        self.prefixes = [output_name(each) for each in (*texts("remove_prefix"), *both)]
        self.starts = (*texts("startswith"), *both)
        self.parts = texts("contains")
        self.names = {*texts("expected"), *texts("name")}
        try:
            self.patterns = [re.compile(each) for each in texts("regex")]
        except re.error as error:
            raise CommandError(f"'regex' of {parameters['path']} is invalid: {error}") from None
        if not (self.starts or self.parts or self.names or self.patterns):
            raise CommandError(
                f"GenericAnalyzer '{parameters['path']}' was not initialized with any way of "
                "checking diagnostics; use startswith, contains, expected, name or regex"
            )
        for name in texts("expected"):
            self.items[name] = Item(report_of(name, STALE, "Missing"), now())

    def match(self, name: str) -> bool:
        """Return whether it accepts a part."""
        return (
            name in self.names
            or name.startswith(self.starts)
            or any(part in name for part in self.parts)
            or any(pattern.fullmatch(name) for pattern in self.patterns)
        )

    def report(self) -> list[DiagnosticStatus]:
        """Return its own state, and those of all parts, without the prefixes of their names."""
        own, *parts = super().report()
        for prefix in self.prefixes:
            for part in parts:
                part.name = without_prefix(part.name, prefix)
        return [own, *parts]


class Discard(Generic):
    """``DiscardAnalyzer``: accepts parts, and reports nothing."""

    def analyze(self, status: DiagnosticStatus) -> None:
        """Ignore a part."""

    def report(self) -> list[DiagnosticStatus]:
        """Return nothing."""
        return []


class Ignore:
    """``IgnoreAnalyzer``: accepts nothing."""

    path = name = ""

    def match(self, name: str) -> bool:  # noqa: ARG002  # none
        """Accept no part."""
        return False

    def analyze(self, status: DiagnosticStatus) -> None:
        """Accept no part."""

    def report(self) -> list[DiagnosticStatus]:
        """Return nothing."""
        return []


class Other(Items):
    """Reports on the parts that no analyzer accepts.

    Args:
        path: The path of the whole aggregator.
        is_error: Whether their existence is an error.
        now: Returns the time, in seconds.
    """

    def __init__(self, path: str, *, is_error: bool, now: Callable[[], float]) -> None:
        super().__init__(f"{path}/Other", "Other", now, is_forgetful=True)
        self.is_error = is_error

    def report(self) -> list[DiagnosticStatus]:
        """Return the states of all such parts, if there are any."""
        own, *parts = super().report()
        if not parts:
            return []
        if self.is_error:
            own.level, own.message = bytes([ERROR]), 'Unanalyzed items found in "Other"'
        return [own, *parts]


@dataclass
class Group:
    """``AnalyzerGroup``: passes a part to all its analyzers that accept it.

    Attributes:
        path: The name of its own state; none if it is empty.
        name: Its name for users.
        analyzers: The analyzers in it.
        failed: The analyzers that could not be created, by name, with the reason.
    """

    path: str
    name: str
    analyzers: list[Analyzer] = field(default_factory=list)
    failed: dict[str, str] = field(default_factory=dict)

    def match(self, name: str) -> bool:
        """Return whether one of them accepts a part."""
        return any(analyzer.match(name) for analyzer in self.analyzers)

    def analyze(self, status: DiagnosticStatus) -> None:
        """Pass the state of a part to all that accept the part."""
        for analyzer in self.analyzers:
            if analyzer.match(status.name):
                analyzer.analyze(status)

    def report(self) -> list[DiagnosticStatus]:
        """Return the states of all, followed by its own."""
        if not self.analyzers:
            name = self.path if self.path not in ("", "/") else "/AnalyzerGroup"
            return [report_of(name, ERROR, "No analyzers")]
        reports: list[DiagnosticStatus] = []
        values, levels = [], []
        for analyzer in self.analyzers:
            states = analyzer.report()
            reports += states
            for state in states:
                if state.name == analyzer.path:
                    values.append(KeyValue(key=analyzer.name, value=state.message))
                    levels.append(level_of(state))
        level = max(levels, default=OK)
        if level == STALE and set(levels) != {STALE}:
            level = ERROR
        if self.path not in ("", "/"):
            reports.append(report_of(self.path, level, NAMES[level], values=values))
        reports += [
            report_of(f"{self.path}/{output_name(name)}", STALE, why)
            for name, why in self.failed.items()
        ]
        return reports


KINDS: Final[dict[str, Any]] = {"GenericAnalyzer": Generic, "DiscardAnalyzer": Discard}


@dataclass
class Analyzers:
    """Creates analyzers from parameters.

    Attributes:
        now: Returns the time, in seconds.
        tell: Called with each problem.
    """

    now: Callable[[], float]
    tell: Callable[[str], object]

    def group(self, path: str, parameters: Mapping[str, Any]) -> Group:
        """Return a group of the analyzers named by parameters."""
        group = Group(path, path)
        owners = {}
        for name in parameters:
            owner, _, last = name.rpartition(".")
            if last == "type" and owner.removeprefix("analyzers.").count(".") == 0 and owner:
                owners[owner] = parameters[name]
        for owner, kind in sorted(owners.items()):
            own = {
                name.removeprefix(f"{owner}."): value
                for name, value in parameters.items()
                if name.startswith(f"{owner}.")
            }
            if "path" not in own:
                continue
            try:
                group.analyzers.append(self.analyzer(str(kind), path, own))
            except CommandError as error:
                self.tell(f"Unable to initialize analyzer '{owner}', type: {kind}: {error}")
                group.failed[owner] = "Analyzer init failed"
        if not group.analyzers and path:
            self.tell(f"No analyzers initialized in AnalyzerGroup '{path}'")
        return group

    def analyzer(self, kind: str, path: str, parameters: Mapping[str, Any]) -> Analyzer:
        """Return an analyzer.

        Raises:
            CommandError: There is no such kind, or its parameters are invalid.
        """
        name = kind.removeprefix(PACKAGE)
        if name == "AnalyzerGroup":
            return self.group(f"{path}/{parameters['path']}", parameters)
        if name == "IgnoreAnalyzer":
            return Ignore()
        if name not in KINDS:
            raise CommandError(
                f"Unable to find Analyzer class {kind}; use AnalyzerGroup, IgnoreAnalyzer, "
                f"{' or '.join(KINDS)}; C++ plugins are not supported here"
            )
        made: Analyzer = KINDS[name](path, parameters, self.now)
        return made
