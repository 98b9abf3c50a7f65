"""What `aionode top` shows, as tables of plain values."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final

from aionode.errors import escaped

if TYPE_CHECKING:
    from collections.abc import Iterable

    from aionode.interfaces.diagnostic_msgs.msg import DiagnosticStatus
    from aionode.observe import EntityRate, Rates

__all__ = ["TABLES", "Table", "diagnostics", "notes", "record_of", "tables_of", "text_of"]

LOST: Final = ("dropped", "lost", "expired")

LEVELS: Final = ("0 ok", "1 warning", "2 error", "3 stale")
"""The levels of statuses, in their order."""

TABLES: Final = ("processes", "nodes", "topics", "services", "actions", "callbacks")


@dataclass(slots=True)
class Table:
    """Rows of one kind.

    Attributes:
        columns: The names of the columns.
        rows: The rows, by key.
        sorted_by: The column by which they are sorted unless another one is chosen.
        descending: Whether the largest comes first.
    """

    columns: tuple[str, ...]
    rows: dict[str, tuple[Any, ...]] = field(default_factory=dict)
    sorted_by: int = 0
    descending: bool = False

    def in_order(
        self, column: int | None = None, *, reverse: bool = False
    ) -> list[tuple[str, Any]]:
        """Return the rows sorted by a column: texts ascending, numbers descending."""
        by = self.sorted_by if column is None else column
        descending = (self.descending if column is None else by > 0) ^ reverse

        def key(item: tuple[str, tuple[Any, ...]]) -> tuple[bool, float, str]:
            value = item[1][by]
            is_text = isinstance(value, str)
            return is_text, 0.0 if is_text else float(value), value if is_text else item[0]

        return sorted(self.rows.items(), key=key, reverse=descending)


def tables_of(rates: Rates) -> dict[str, Table]:
    """Return all tables, by name."""
    entities = list(rates.entities())
    return {
        "processes": processes(rates),
        "nodes": nodes(rates),
        "topics": topics(entities),
        "services": asked(entities, "service"),
        "actions": asked(entities, "action server"),
        "callbacks": callbacks(entities),
    }


def processes(rates: Rates) -> Table:
    """Return the processes with their processor time and memory."""
    table = Table(
        ("program", "pid", "host", "cpu %", "MiB", "nodes", "waits for cpu", "aionode"),
        sorted_by=3,
        descending=True,
    )
    for process in rates.processes:
        report = process.report
        if report.nodes:  # tools, this one among them, have none
            table.rows[report.participant] = (
                report.program,
                report.pid,
                report.host,
                round(100 * process.cpu, 1),
                report.memory_bytes // 2**20,
                len(report.nodes),
                report.processor_waits,
                report.version,
            )
    return table


def nodes(rates: Rates) -> Table:
    """Return the nodes with what they do."""
    table = Table(("node", "entities", "events/s", "unfinished", "errors", "lost", "pid"))
    for process in rates.processes:
        by_node: dict[str, list[EntityRate]] = defaultdict(list)
        for entity in process.entities:
            by_node[entity.node].append(entity)
        for node in process.report.nodes:
            own = by_node[node.name]
            table.rows[f"{process.report.participant} {node.name}"] = (
                node.name,
                len(own),
                round(sum(entity.hz for entity in own), 1),
                node.unfinished,
                total(own, "errors"),
                sum(total(own, name) for name in LOST),
                process.report.pid,
            )
    return table


def total(entities: Iterable[EntityRate], count: str) -> int:
    """Return the sum of a count of entities."""
    return sum(entity.report.counts.get(count, 0) for entity in entities)


def by_name(entities: Iterable[EntityRate], *kinds: str) -> dict[str, list[EntityRate]]:
    """Return the entities of some kinds by their names."""
    found: dict[str, list[EntityRate]] = defaultdict(list)
    for entity in entities:
        if entity.report.kind in kinds:
            found[entity.report.name].append(entity)
    return found


def topics(entities: list[EntityRate]) -> Table:
    """Return the topics with their rates, and what did not arrive."""
    table = Table(
        ("topic", "Hz", "heard Hz", "publishers", "subscriptions", "dropped", "lost", "type"),
        sorted_by=1,
        descending=True,
    )
    for name, ends in by_name(entities, "publisher", "subscription").items():
        writers = [end for end in ends if end.report.kind == "publisher"]
        readers = [end for end in ends if end.report.kind == "subscription"]
        table.rows[name] = (
            name,
            round(sum(writer.hz for writer in writers), 2),
            round(sum(reader.hz for reader in readers), 2),
            len(writers),
            len(readers),
            total(ends, "dropped"),
            total(readers, "lost"),
            ends[0].report.type_name,
        )
    return table


def asked(entities: list[EntityRate], kind: str) -> Table:
    """Return the services or actions with their request rates and durations."""
    table = Table(
        (kind.split(maxsplit=1)[0], "Hz", "calls", "errors", "p50 ms", "p99 ms", "nodes", "type"),
        sorted_by=1,
        descending=True,
    )
    for name, servers in by_name(entities, kind).items():
        table.rows[name] = (
            name,
            round(sum(server.hz for server in servers), 2),
            total(servers, "received"),
            total(servers, "errors"),
            milliseconds(servers[0], "run_time", 50),
            milliseconds(servers[0], "run_time", 99),
            ", ".join(sorted({server.node for server in servers})),
            servers[0].report.type_name,
        )
    return table


def callbacks(entities: list[EntityRate]) -> Table:
    """Return the callbacks with their waits, their run times, and how long they block the loop."""
    table = Table(
        ("callback", "node", "of", "Hz", "wait p99 ms", "run p50 ms", "run p99 ms", "block p99 ms",
         "block max ms", "errors"),
        sorted_by=7,
        descending=True,
    )  # fmt: skip
    seen: dict[str, int] = defaultdict(int)
    for entity in entities:
        report = entity.report
        if not report.callback:
            continue
        key = f"{entity.node} {report.kind} {report.name} {report.callback}"
        seen[key] += 1
        blocking = report.durations.get("blocking")
        table.rows[f"{key} {seen[key]}"] = (
            report.callback,
            entity.node,
            f"{report.kind} {report.name}".strip(),
            round(entity.hz, 2),
            milliseconds(entity, "queue_wait", 99),
            milliseconds(entity, "run_time", 50),
            milliseconds(entity, "run_time", 99),
            milliseconds(entity, "blocking", 99),
            0.0 if blocking is None else round(blocking.max_ns / 1e6, 3),
            report.counts.get("errors", 0),
        )
    return table


def diagnostics(statuses: Iterable[DiagnosticStatus]) -> Table:
    """Return the diagnostics of nodes and their devices, the worst first."""
    table = Table(("status", "level", "message", "hardware"), sorted_by=1, descending=True)
    for status in statuses:
        level = status.level[0]
        table.rows[status.name] = (
            status.name,
            LEVELS[level] if level < len(LEVELS) else str(level),
            status.message,
            status.hardware_id,
        )
    return table


def milliseconds(entity: EntityRate, duration: str, percent: float) -> float:
    """Return a percentile of a duration of an entity since the last snapshot."""
    measured = entity.durations.get(duration)
    return 0.0 if measured is None else round(measured.percentile_ns(percent) / 1e6, 3)


def notes(rates: Rates) -> list[str]:
    """Return lines that name the processes missing from the tables, and why."""
    found = rates.snapshot
    lines = [
        f"{', '.join(names)}: no answer: frozen, blocked or dead" for names in found.silent.values()
    ]
    lines += found.unreached
    lines += [
        f"{', '.join(names)}: its version of aionode is too old to make reports"
        for names in found.older.values()
    ]
    lines += [
        f"{', '.join(names)}: its report cannot be read" for names in found.unreadable.values()
    ]
    if found.foreign:
        lines.append(f"{', '.join(found.foreign)}: not aionode, so without counts")
    return [escaped(line, one_line=True) for line in lines]


def record_of(rates: Rates) -> dict[str, Any]:
    """Return all tables as one record."""
    record: dict[str, Any] = {
        name: [dict(zip(table.columns, row, strict=True)) for _, row in table.in_order()]
        for name, table in tables_of(rates).items()
    }
    return record | {"notes": notes(rates)}


def shown(value: object) -> str:
    """Return a cell as text on one line, as other programs and nodes may have any name."""
    return escaped(str(value), one_line=True)


def text_of(rates: Rates) -> str:
    """Return all tables as text."""
    parts = []
    for table in tables_of(rates).values():
        if not table.rows:
            continue
        rows = [table.columns, *(tuple(map(shown, row)) for _, row in table.in_order())]
        widths = [max(len(row[column]) for row in rows) for column in range(len(table.columns))]
        parts.append(
            "\n".join(
                "  ".join(
                    cell.ljust(width) if column == 0 else cell.rjust(width)
                    for column, (cell, width) in enumerate(zip(row, widths, strict=True))
                ).rstrip()
                for row in rows
            )
        )
    return "\n\n".join([*parts, *notes(rates)])
