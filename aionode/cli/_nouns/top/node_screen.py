"""The view of one node in `aionode top`: its parameters and transitions, changed in place."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, ClassVar, Final

import msgspec
from rich.text import Text
from textual.screen import ModalScreen
from textual.widgets import DataTable, Footer, Input, Static

from aionode.cli._nouns.lifecycle import managed_nodes, transitions
from aionode.cli._nouns.param import message_of, parameter_value, parameters_of
from aionode.cli._nouns.param.text import plain
from aionode.errors import AionodeError, escaped
from aionode.interfaces.lifecycle_msgs.srv import ChangeState
from aionode.parameter import Parameter

if TYPE_CHECKING:
    from collections.abc import Iterator

    from textual.app import ComposeResult

    from aionode.node import Node

__all__ = ["NodeScreen"]

PATIENCE_S: Final = 30.0
"""How long a transition may take, in seconds: some connect to devices."""


class NodeScreen(ModalScreen[None]):
    """The parameters of a node and, of a managed one, the transitions that are available.

    Args:
        node: The command's node.
        name: The full name of the other node.
    """

    CSS = """
    NodeScreen { padding: 1 4; }
    #what { height: 1; }
    #said { height: auto; color: $warning; }
    #rows { height: 1fr; }
    """
    BINDINGS: ClassVar[list[Any]] = [("escape", "leave", "back")]

    def __init__(self, node: Node, name: str) -> None:
        super().__init__()
        self._node = node
        self._of = name
        self._chosen = ""

    def compose(self) -> ComposeResult:
        """Create the view."""
        yield Static(
            Text(escaped(f"{self._of}: Enter changes a parameter, or the state")), id="what"
        )
        yield DataTable(id="rows", cursor_type="row")
        yield Input(id="value", disabled=True)
        yield Static(id="said")
        yield Footer()

    async def on_mount(self) -> None:
        """Ask the node."""
        self.query_one("#rows", DataTable).add_columns("", "name", "value")
        self.query_one("#rows").focus()
        await self.fill()

    async def fill(self) -> None:
        """Show the current parameters and transitions of the node."""
        rows: DataTable[Any] = self.query_one("#rows", DataTable)
        rows.clear()
        with self.telling():
            if self._of in managed_nodes(self._node, hidden=True):
                with borrowed_clients(self._node):
                    available = await transitions(self._node, self._of)
                for each in available:
                    change, label = each.transition, each.goal_state.label
                    cells = ("transition", change.label, f"to {label}")
                    rows.add_row(*map(cell, cells), key=f"transition {change.label}")
            async with parameters_of(self._node, self._of) as client:
                names = sorted((await client.list_parameters()).names)
                for parameter in await client.get_parameters(names):
                    value = msgspec.json.encode(plain(parameter)).decode()
                    row = ("parameter", parameter.name, value)
                    rows.add_row(*map(cell, row), key=f"parameter {parameter.name}")

    async def on_data_table_row_selected(self, event: DataTable.RowSelected) -> None:
        """Perform a transition, or ask for the value of a parameter."""
        kind, _, name = str(event.row_key.value).partition(" ")
        if kind == "transition":
            await self.change_state(name)
            return
        self._chosen = name
        field = self.query_one("#value", Input)
        field.disabled = False
        field.value = event.data_table.get_row(event.row_key)[2].plain
        field.focus()

    async def on_input_submitted(self, event: Input.Submitted) -> None:
        """Set the parameter."""
        event.stop()
        event.input.disabled = True
        self.query_one("#rows").focus()
        with self.telling():
            message = message_of(self._chosen, parameter_value(event.value))
            async with parameters_of(self._node, self._of) as client:
                (result,) = await client.set_parameters([Parameter.from_parameter_msg(message)])
            refused = f"{self._chosen}: refused: {result.reason}"
            self.say(f"{self._chosen}: set" if result.successful else refused)
        await self.fill()

    async def change_state(self, label: str) -> None:
        """Perform a transition."""
        with self.telling(), borrowed_clients(self._node):
            client = self._node.create_client(ChangeState, f"{self._of}/change_state")
            request = ChangeState.Request()
            request.transition.label = label
            response = await client.call(request, timeout_sec=PATIENCE_S)
            self.say(f"{label}: {'done' if response.success else 'refused or failed; see its log'}")
        await self.fill()

    @contextmanager
    def telling(self) -> Iterator[None]:
        """Show why something failed in the block."""
        try:
            yield
        except AionodeError as error:
            self.say(str(error))

    def say(self, text: str) -> None:
        """Show a line below."""
        self.query_one("#said", Static).update(Text(escaped(text)))

    def action_leave(self) -> None:
        """Go back; first leave the input of a value."""
        field = self.query_one("#value", Input)
        if field.has_focus:
            field.disabled = True
            self.query_one("#rows").focus()
        else:
            self.dismiss()


@contextmanager
def borrowed_clients(node: Node) -> Iterator[None]:
    """Destroy the clients that are created in the block."""
    before = set(node.clients)
    try:
        yield
    finally:
        for client in set(node.clients) - before:
            client.destroy()


def cell(value: str) -> Text:
    """Return a cell with text from another program."""
    return Text(escaped(value, one_line=True))
