"""How to add a server to the settings of programs with language models."""

from __future__ import annotations

import shlex
from collections.abc import Callable, Sequence
from typing import Any, Final

import msgspec

__all__ = ["HOSTS", "settings_for"]

NAME: Final = "robot"
"""The name of the server in their settings."""


def settings_for(host: str, command: Sequence[str]) -> str:
    """Return the settings that make a program start a server, as text, and where to put them.

    Args:
        host: A key of `HOSTS`.
        command: The program of the server, and its arguments.
    """
    place, make = HOSTS[host]
    return f"# {place}\n{make(command)}\n"


def servers(key: str, **more: Any) -> Callable[[Sequence[str]], str]:
    """Return a function that writes a server as JSON, under a program's key for servers."""

    def make(command: Sequence[str]) -> str:
        server = {**more, "command": command[0], "args": list(command[1:])}
        return pretty({key: {NAME: server}})

    return make


def pretty(value: Any) -> str:
    """Return JSON with line breaks."""
    return msgspec.json.format(msgspec.json.encode(value), indent=2).decode()


def of_zed(command: Sequence[str]) -> str:
    """Return the settings of Zed."""
    server = {"source": "custom", "command": command[0], "args": list(command[1:])}
    return pretty({"context_servers": {NAME: server}})


def of_codex(command: Sequence[str]) -> str:
    """Return the settings of Codex, as TOML."""
    arguments = ", ".join(map(quoted, command[1:]))
    return f"[mcp_servers.{NAME}]\ncommand = {quoted(command[0])}\nargs = [{arguments}]"


def quoted(text: str) -> str:
    """Return a text quoted as in TOML and JSON."""
    return msgspec.json.encode(text).decode()


HOSTS: Final[dict[str, tuple[str, Callable[[Sequence[str]], str]]]] = {
    "claude-desktop": (
        "Claude Desktop: Settings > Developer > Edit Config (claude_desktop_config.json)",
        servers("mcpServers"),
    ),
    "claude-code": (
        "Claude Code: in a shell",
        lambda command: shlex.join(["claude", "mcp", "add", NAME, "--", *command]),
    ),
    "cursor": ("Cursor: .cursor/mcp.json, or ~/.cursor/mcp.json", servers("mcpServers")),
    "vscode": ("VS Code: .vscode/mcp.json", servers("servers", type="stdio")),
    "windsurf": ("Windsurf: ~/.codeium/windsurf/mcp_config.json", servers("mcpServers")),
    "gemini-cli": ("Gemini CLI: ~/.gemini/settings.json", servers("mcpServers")),
    "codex": ("Codex: ~/.codex/config.toml", of_codex),
    "zed": ("Zed: settings.json", of_zed),
}
"""For each program, the place of its settings, and the function that writes them."""
