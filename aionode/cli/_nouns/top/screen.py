"""The live view of `aionode top`, in a terminal."""

from __future__ import annotations

import math
from collections import deque
from typing import TYPE_CHECKING, Any, ClassVar, Final

from rich.text import Text
from textual.app import App, ComposeResult
from textual.binding import Binding
from textual.widgets import (
    DataTable,
    Footer,
    Input,
    RichLog,
    Sparkline,
    Static,
    TabbedContent,
    TabPane,
)

from aionode.cli._nouns.top.node_screen import NodeScreen
from aionode.cli._nouns.top.tables import TABLES, Table, diagnostics, notes, tables_of
from aionode.cli._support import lookup
from aionode.cli._support.field_path import field_of
from aionode.errors import AionodeError, escaped
from aionode.interfaces.diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from aionode.interfaces.rcl_interfaces.msg import Log
from aionode.observe import observe, rates
from aionode.qos import qos_profile_rosout_default, qos_profile_sensor_data

if TYPE_CHECKING:
    from aionode.node import Node
    from aionode.observe import Snapshot

__all__ = ["TopApp"]

KEPT: Final = 120
"""Number of snapshots that the plot of a row shows."""

MAX_ROWS: Final = 500
"""Maximum number of rows of a table."""

MAX_STATUSES: Final = 10_000
"""Maximum number of statuses of /diagnostics that are kept."""

SHOWN: Final = (*TABLES, "diagnostics")
"""The tables of the view."""

LEVELS: Final = {10: "dim", 20: "", 30: "yellow", 40: "red", 50: "bold red"}


class TopApp(App[None]):
    """Tables of what all processes do, updated at an interval.

    Args:
        node: The command's node.
        interval: The time between two snapshots, in seconds.
    """

    CSS = """
    #notes { color: $error; height: auto; }
    #filter, #field { display: none; }
    #filter.shown, #field.shown { display: block; }
    TabbedContent { height: 1fr; }
    DataTable { height: 1fr; }
    #plot { height: 3; }
    #of { height: 1; color: $text-muted; }
    """
    TITLE = "aionode top"
    BINDINGS: ClassVar[list[Any]] = [
        ("q", "quit", "quit"),
        Binding("ctrl+c", "quit", show=False, priority=True),  # Textual's own only names a key
        ("/", "filter", "filter"),
        ("s", "sort", "sort by the next column"),
        ("r", "reverse", "other way round"),
        ("space", "pause", "pause"),
        ("f", "field", "plot a field"),
        ("n", "node", "change a node"),
        *[(str(number), f"tab('{name}')", name) for number, name in enumerate((*SHOWN, "log"), 1)],
    ]

    def __init__(self, node: Node, interval: float = 2.0) -> None:
        super().__init__()
        self._node = node
        self._interval = interval
        self._before: Snapshot | None = None
        self._tables: dict[str, Table] = {}
        self._sorted: dict[str, tuple[int | None, bool]] = dict.fromkeys(SHOWN, (None, False))
        self._statuses: dict[str, DiagnosticStatus] = {}
        self._field: Field | None = None
        self._said = ""  # why a field is not plotted
        self._wanted = ""
        self._paused = False
        self._history: dict[tuple[str, str], deque[float]] = {}

    def compose(self) -> ComposeResult:
        """Create the view."""
        yield Static(id="notes")
        with TabbedContent(initial="processes"):
            for name in SHOWN:
                with TabPane(name, id=name):
                    yield DataTable(id=f"{name}-table", cursor_type="row")
            with TabPane("log", id="log"):
                yield RichLog(id="log-lines", max_lines=1000, wrap=True)
        yield Static(id="of")
        yield Sparkline([], id="plot")
        yield Input(placeholder="show rows that contain …", id="filter", disabled=True)
        yield Input(placeholder="field, as twist.twist.linear.x", id="field", disabled=True)
        yield Footer()

    async def on_mount(self) -> None:
        """Take the first snapshot, and then one after each interval."""
        self.query_one("#processes-table", DataTable).focus()
        self._before = await observe(self._node)
        self.set_interval(self._interval, self.look)

    async def look(self) -> None:
        """Take a snapshot of all processes, and show what they have done since the last one."""
        before, self._before = self._before, await observe(self._node)
        if before is None or self._paused or not self.query("#notes"):  # the view is closing
            return
        found = rates(before, self._before)
        self._tables = tables_of(found) | {"diagnostics": diagnostics(self._statuses.values())}
        for name, table in self._tables.items():
            if "Hz" not in table.columns:
                continue
            column = table.columns.index("Hz")
            for key, row in table.rows.items():
                self._history.setdefault((name, key), deque(maxlen=KEPT)).append(row[column])
        self.query_one("#notes", Static).update(Text("\n".join(notes(found))))
        self.show()

    @property
    def shown(self) -> str:
        """The name of the visible table."""
        return self.query_one(TabbedContent).active

    def show(self) -> None:
        """Fill the visible table, keeping the cursor on its row."""
        name = self.shown
        table = self._tables.get(name)
        if table is None:
            return
        view: DataTable[Any] = self.query_one(f"#{name}-table", DataTable)
        chosen = self.key_of(view)
        column, reverse = self._sorted[name]
        by = table.sorted_by if column is None else column
        view.clear(columns=True)
        for number, title in enumerate(table.columns):
            view.add_column(f"{title} ▾" if number == by else title)
        wanted = self._wanted.lower()
        rows = [
            (key, row)
            for key, row in table.in_order(column, reverse=reverse)
            if wanted in " ".join(map(str, row)).lower()
        ]
        for key, row in rows[:MAX_ROWS]:
            view.add_row(*(cell_of(value) for value in row), key=key)
        if chosen in view.rows:
            view.move_cursor(row=view.get_row_index(chosen), animate=False)
        self.plot(view)

    def key_of(self, view: DataTable[Any]) -> Any:
        """Return the key of the row under the cursor; None if there is none."""
        if not view.row_count or not view.is_valid_coordinate(view.cursor_coordinate):
            return None
        return view.coordinate_to_cell_key(view.cursor_coordinate).row_key.value

    def plot(self, view: DataTable[Any]) -> None:
        """Show the rate of the row under the cursor over time, or the field that was chosen."""
        if self._field is not None:
            self._field.show(self.query_one("#plot", Sparkline), self.query_one("#of", Static))
            return
        if self._said:
            self.query_one("#of", Static).update(Text(escaped(self._said)))
            return
        key = self.key_of(view)
        history = self._history.get((self.shown, str(key)), deque())
        self.query_one("#plot", Sparkline).data = list(history)
        of = f"{key}: {history[-1]:g} Hz, at most {max(history):g} Hz" if history else ""
        self.query_one("#of", Static).update(Text(escaped(of)))

    # What is typed and clicked

    def on_data_table_row_highlighted(self, event: DataTable.RowHighlighted) -> None:
        """Plot another row."""
        self.plot(event.data_table)

    def on_data_table_header_selected(self, event: DataTable.HeaderSelected) -> None:
        """Sort by the column; a second time in reverse."""
        column, reverse = self._sorted[self.shown]
        same = column == event.column_index
        self._sorted[self.shown] = (event.column_index, same and not reverse)
        self.show()

    def on_tabbed_content_tab_activated(self) -> None:
        """Fill the table that is now visible; subscribe to the log when it is first shown."""
        if self.shown == "log":
            self.hear_log()
            return
        if self.shown == "diagnostics":
            self.hear_diagnostics()
        self.show()

    def hear_diagnostics(self) -> None:
        """Subscribe to the diagnostics of nodes, once."""
        if any(each.topic_name == "/diagnostics" for each in self._node.subscriptions):
            return

        def hear(message: DiagnosticArray) -> None:
            for status in message.status:
                if status.name in self._statuses or len(self._statuses) < MAX_STATUSES:
                    self._statuses[status.name] = status

        self._node.create_subscription(DiagnosticArray, "/diagnostics", hear, 100)

    def hear_log(self) -> None:
        """Subscribe to the log, once."""
        if any(each.topic_name == "/rosout" for each in self._node.subscriptions):
            return
        lines = self.query_one("#log-lines", RichLog)

        def hear(message: Log) -> None:
            text = f"[{message.name}] {message.msg}"
            lines.write(Text(escaped(text), style=LEVELS.get(message.level, "")))

        self._node.create_subscription(Log, "/rosout", hear, qos_profile_rosout_default)

    def action_tab(self, name: str) -> None:
        """Show another table."""
        self._said = ""
        self.query_one(TabbedContent).active = name
        if name in self._sorted:
            self.query_one(f"#{name}-table", DataTable).focus()

    def action_sort(self) -> None:
        """Sort by the next column."""
        table = self._tables.get(self.shown)
        if table is not None:
            column, _ = self._sorted[self.shown]
            by = table.sorted_by if column is None else column
            self._sorted[self.shown] = ((by + 1) % len(table.columns), False)
            self.show()

    def action_reverse(self) -> None:
        """Reverse the order."""
        if self.shown in self._sorted:
            column, reverse = self._sorted[self.shown]
            self._sorted[self.shown] = (column, not reverse)
            self.show()

    def action_pause(self) -> None:
        """Pause or resume the display."""
        self._paused = not self._paused

    def action_filter(self) -> None:
        """Ask which rows to show."""
        field = self.query_one("#filter", Input)
        field.disabled = False
        field.add_class("shown")
        field.focus()

    def action_node(self) -> None:
        """Show the parameters and transitions of the node under the cursor."""
        if self.shown in {"nodes", "callbacks"}:
            view: DataTable[Any] = self.query_one(f"#{self.shown}-table", DataTable)
            table, key = self._tables.get(self.shown), self.key_of(view)
            if table is not None and key in table.rows:
                self.push_screen(
                    NodeScreen(self._node, table.rows[key][table.columns.index("node")])
                )

    def action_field(self) -> None:
        """Ask which field of the topic to plot; a second time, plot rates again."""
        self._said = ""
        if self._field is not None:
            self._field.end()
            self._field = None
            self.show()
        elif self.shown == "topics" and self._tables:
            field = self.query_one("#field", Input)
            field.disabled = False
            field.add_class("shown")
            field.focus()

    async def plot_field(self, path: str) -> None:
        """Subscribe to the topic under the cursor, and plot a field."""
        view: DataTable[Any] = self.query_one("#topics-table", DataTable)
        topic = self.key_of(view)
        self.query_one("#field").remove_class("shown")
        view.focus()
        if not path or topic not in self._tables["topics"].rows:
            return
        try:
            type_name = self._tables["topics"].rows[topic][-1]
            msg_type = await lookup.topic_type(self._node, topic, type_name)
            self._field = Field(self._node, topic, path, msg_type)
        except AionodeError as error:
            self._said = str(error)
        self.plot(view)

    def on_input_changed(self, event: Input.Changed) -> None:
        """Show the rows that contain what was typed."""
        if event.input.id != "filter":
            return
        self._wanted = event.value
        self.show()

    async def on_input_submitted(self, event: Input.Submitted) -> None:
        """Go back to the table."""
        if event.input.id == "field":
            event.input.disabled = True
            await self.plot_field(event.value)
            return
        if not event.value:
            event.input.remove_class("shown")
        event.input.disabled = True
        if self.shown in self._sorted:
            self.query_one(f"#{self.shown}-table", DataTable).focus()


class Field:
    """A field of a topic over time.

    Args:
        node: The command's node.
        topic: The topic, which it subscribes to.
        path: The path of the field.
        msg_type: The type of the topic.

    Raises:
        CommandError: the type has no such field.
    """

    def __init__(self, node: Node, topic: str, path: str, msg_type: Any) -> None:
        if "[" not in path:  # an array of a message that nobody has sent is empty
            field_of(msg_type(), path)
        self._name, self._path = f"{topic}.{path}", path
        self._values: deque[float] = deque(maxlen=KEPT)
        self._problem = "nothing yet"
        self._subscription = node.create_subscription(
            msg_type, topic, self._hear, qos_profile_sensor_data
        )

    def _hear(self, message: Any) -> None:
        try:
            value, _ = field_of(message, self._path)
            self._values.append(float(value))
        except (AionodeError, TypeError, ValueError) as error:
            self._problem = str(error)

    def show(self, plot: Sparkline, of: Static) -> None:
        """Draw the plot, with its newest value."""
        plot.data = [value for value in self._values if math.isfinite(value)]
        newest = f"{self._values[-1]:.6g}" if self._values else self._problem
        of.update(Text(escaped(f"{self._name}: {newest}   (f plots rates again)")))

    def end(self) -> None:
        """End the subscription."""
        self._subscription.destroy()


def cell_of(value: Any) -> Text:
    """Return a cell, with numbers aligned right."""
    if isinstance(value, str):
        return Text(escaped(value, one_line=True))
    return Text(f"{value:g}" if isinstance(value, float) else str(value), justify="right")
