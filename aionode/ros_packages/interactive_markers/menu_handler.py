"""Menus of interactive markers."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any

from visualization_msgs.msg import InteractiveMarkerFeedback, MenuEntry

__all__ = ["EntryContext", "MenuHandler"]


class EntryContext:
    """An entry of a menu."""

    def __init__(self) -> None:
        self.title = ""
        self.command = ""
        self.command_type = 0
        self.sub_entries: list[int] = []
        self.visible = True
        self.check_state = MenuHandler.NO_CHECKBOX
        self.feedback_cb: Callable[[Any], Any] | None = None


class MenuHandler:
    """A menu, which several markers may share."""

    NO_CHECKBOX = 0
    CHECKED = 1
    UNCHECKED = 2

    def __init__(self) -> None:
        self.top_level_handles_: list[int] = []
        self.entry_contexts_: dict[int, EntryContext] = {}
        self.current_handle_ = 1
        self.managed_markers_: set[str] = set()

    def insert(
        self,
        title: str,
        parent: int | None = None,
        command_type: int = MenuEntry.FEEDBACK,
        command: str = "",
        callback: Callable[[Any], Any] | None = None,
    ) -> int | None:
        """Add an entry, and return its handle; None if the parent does not exist.

        Args:
            title: Its text.
            parent: The handle of its parent entry.
            command_type: What selecting it does; by default, it sends feedback.
            command: The command, for other types.
            callback: Called with the feedback.
        """
        if parent is not None and parent not in self.entry_contexts_:
            print(f"Parent menu entry {parent} not found.", file=sys.stderr)
            return None
        handle = self.doInsert(title, command_type, command, callback)
        siblings = self.entry_contexts_[parent].sub_entries if parent else self.top_level_handles_
        siblings.append(handle)
        return handle

    def doInsert(
        self,
        title: str,
        command_type: int,
        command: str,
        feedback_cb: Callable[[Any], Any] | None,
    ) -> int:
        """Create an entry that is not in the menu yet, and return its handle."""
        entry = EntryContext()
        entry.title = title
        entry.command_type = command_type
        entry.command = command
        entry.feedback_cb = feedback_cb
        handle = self.current_handle_
        self.entry_contexts_[handle] = entry
        self.current_handle_ += 1
        return handle

    def setVisible(self, handle: int, visible: bool) -> bool:
        """Show or hide an entry, and return whether it exists."""
        if handle in self.entry_contexts_:
            self.entry_contexts_[handle].visible = visible
        return handle in self.entry_contexts_

    def setCheckState(self, handle: int, check_state: int) -> bool:
        """Check or uncheck an entry, and return whether it exists."""
        if handle in self.entry_contexts_:
            self.entry_contexts_[handle].check_state = check_state
        return handle in self.entry_contexts_

    def getCheckState(self, handle: int) -> int | None:
        """Return whether an entry is checked; None if it does not exist."""
        entry = self.entry_contexts_.get(handle)
        return None if entry is None else entry.check_state

    def getTitle(self, handle: int) -> str | None:
        """Return the text of an entry; None if it does not exist."""
        entry = self.entry_contexts_.get(handle)
        return None if entry is None else entry.title

    def apply(self, server: Any, marker_name: str) -> bool:
        """Give a marker the current menu, and return whether the marker exists.

        Args:
            server: Its server, whose `applyChanges` makes the menu visible.
            marker_name: Its name.
        """
        marker = server.get(marker_name)
        if marker is None:
            self.managed_markers_.discard(marker_name)
            return False
        entries: list[Any] = []
        self.pushMenuEntries(self.top_level_handles_, entries, 0)
        marker.menu_entries = entries
        server.insert(
            marker,
            feedback_callback=self.processFeedback,
            feedback_type=InteractiveMarkerFeedback.MENU_SELECT,
        )
        self.managed_markers_.add(marker_name)
        return True

    def reApply(self, server: Any) -> bool:
        """Give all its markers the current menu, and return whether they exist."""
        applied = [self.apply(server, name) for name in list(self.managed_markers_)]
        return all(applied)

    def processFeedback(self, feedback: Any) -> None:
        """Call the callback of the selected entry."""
        entry = self.entry_contexts_.get(feedback.menu_entry_id)
        if entry is not None and entry.feedback_cb is not None:
            entry.feedback_cb(feedback)

    def pushMenuEntries(
        self, handles_in: list[int], entries_out: list[Any], parent_handle: int
    ) -> bool:
        """Add the messages of entries, and of those below them."""
        for handle in handles_in:
            entry = self.entry_contexts_[handle]
            if entry.visible:
                entries_out.append(self.makeEntry(entry, handle, parent_handle))
                self.pushMenuEntries(entry.sub_entries, entries_out, handle)
        return True

    def makeEntry(self, context: EntryContext, handle: int, parent_handle: int) -> Any:
        """Return the message of an entry."""
        box = {self.CHECKED: "[x] ", self.UNCHECKED: "[ ] "}.get(context.check_state, "")
        return MenuEntry(
            id=handle,
            parent_id=parent_handle,
            title=box + context.title,
            command=context.command,
            command_type=context.command_type,
        )
