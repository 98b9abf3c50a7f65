"""The live view of `aionode top`, in a terminal."""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING, Any, ClassVar, Final

from rich.text import Text
from textual.app import App, ComposeResult
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

from aionode.cli._nouns.top.tables import TABLES, Table, notes, tables_of
from aionode.errors import escaped
from aionode.interfaces.rcl_interfaces.msg import Log
from aionode.observe import observe, rates
from aionode.qos import qos_profile_rosout_default

if TYPE_CHECKING:
    from aionode.node import Node
    from aionode.observe import Snapshot

__all__ = ["TopApp"]

KEPT: Final = 120
"""The looks that the plot of a row shows."""

MOST_ROWS: Final = 500
"""The most rows of a table."""

LEVELS: Final = {10: "dim", 20: "", 30: "yellow", 40: "red", 50: "bold red"}


class TopApp(App[None]):
    """Tables of what all processes do, asked again and again.

    Args:
        node: The command's node.
        interval: The time between two looks, in seconds.
    """

    CSS = """
    #notes { color: $error; height: auto; }
    #filter { display: none; }
    #filter.shown { display: block; }
    TabbedContent { height: 1fr; }
    DataTable { height: 1fr; }
    #plot { height: 3; }
    #of { height: 1; color: $text-muted; }
    """
    TITLE = "aionode top"
    BINDINGS: ClassVar[list[Any]] = [
        ("q", "quit", "quit"),
        ("/", "filter", "filter"),
        ("s", "sort", "sort by the next column"),
        ("r", "reverse", "other way round"),
        ("space", "pause", "pause"),
        *[(str(number), f"tab('{name}')", name) for number, name in enumerate((*TABLES, "log"), 1)],
    ]

    def __init__(self, node: Node, interval: float = 2.0) -> None:
        super().__init__()
        self._node = node
        self._interval = interval
        self._before: Snapshot | None = None
        self._tables: dict[str, Table] = {}
        self._sorted: dict[str, tuple[int | None, bool]] = dict.fromkeys(TABLES, (None, False))
        self._wanted = ""
        self._paused = False
        self._history: dict[tuple[str, str], deque[float]] = {}

    def compose(self) -> ComposeResult:
        """Make the view."""
        yield Static(id="notes")
        with TabbedContent(initial="processes"):
            for name in TABLES:
                with TabPane(name, id=name):
                    yield DataTable(id=f"{name}-table", cursor_type="row")
            with TabPane("log", id="log"):
                yield RichLog(id="log-lines", max_lines=1000, wrap=True)
        yield Static(id="of")
        yield Sparkline([], id="plot")
        yield Input(placeholder="show rows that contain …", id="filter", disabled=True)
        yield Footer()

    async def on_mount(self) -> None:
        """Look for the first time, and from then on again and again."""
        self.query_one("#processes-table", DataTable).focus()
        self._before = await observe(self._node)
        self.set_interval(self._interval, self.look)

    async def look(self) -> None:
        """Ask all processes, and show what they have done since the last look."""
        before, self._before = self._before, await observe(self._node)
        if before is None or self._paused or not self.query("#notes"):  # it ends
            return
        found = rates(before, self._before)
        self._tables = tables_of(found)
        for name, table in self._tables.items():
            if "Hz" not in table.columns:
                continue
            column = table.columns.index("Hz")
            for key, row in table.rows.items():
                self._history.setdefault((name, key), deque(maxlen=KEPT)).append(row[column])
        self.query_one("#notes", Static).update(Text(escaped("\n".join(notes(found)))))
        self.show()

    @property
    def shown(self) -> str:
        """The name of the table that is shown."""
        return self.query_one(TabbedContent).active

    def show(self) -> None:
        """Fill the table that is shown, with the cursor on the row on which it was."""
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
        for key, row in rows[:MOST_ROWS]:
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
        """Show the rate of the row under the cursor over time."""
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
        """Sort by the column; again, the other way round."""
        column, reverse = self._sorted[self.shown]
        same = column == event.column_index
        self._sorted[self.shown] = (event.column_index, same and not reverse)
        self.show()

    def on_tabbed_content_tab_activated(self) -> None:
        """Fill the table that is shown now; the log is subscribed to when it is looked at."""
        if self.shown == "log":
            self.hear_log()
        else:
            self.show()

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
        """Sort the other way round."""
        if self.shown in self._sorted:
            column, reverse = self._sorted[self.shown]
            self._sorted[self.shown] = (column, not reverse)
            self.show()

    def action_pause(self) -> None:
        """Keep what is shown, or go on."""
        self._paused = not self._paused

    def action_filter(self) -> None:
        """Type which rows to show."""
        field = self.query_one("#filter", Input)
        field.disabled = False
        field.add_class("shown")
        field.focus()

    def on_input_changed(self, event: Input.Changed) -> None:
        """Show the rows that contain what was typed."""
        self._wanted = event.value
        self.show()

    def on_input_submitted(self, event: Input.Submitted) -> None:
        """Go back to the table."""
        if not event.value:
            event.input.remove_class("shown")
        event.input.disabled = True
        if self.shown in self._sorted:
            self.query_one(f"#{self.shown}-table", DataTable).focus()


def cell_of(value: Any) -> Text:
    """Return a cell: numbers on the right."""
    if isinstance(value, str):
        return Text(escaped(value, one_line=True))
    return Text(f"{value:g}" if isinstance(value, float) else str(value), justify="right")
