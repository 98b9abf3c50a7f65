"""Converts interface definitions (``.msg``, ``.srv``, ``.action``) to Python classes and back."""

from __future__ import annotations

from typing import TYPE_CHECKING

from aionode._process.first_use import imported_on_first_use

if TYPE_CHECKING:
    from aionode.idl._build import define
    from aionode.idl._definition_text import definition_text
    from aionode.idl._folder import Interfaces, load_interfaces
    from aionode.idl._generator import generate

__all__ = ["Interfaces", "define", "definition_text", "generate", "load_interfaces"]

PLACES = {
    "Interfaces": "_folder",
    "define": "_build",
    "definition_text": "_definition_text",
    "generate": "_generator",
    "load_interfaces": "_folder",
}
"""The module of each public name, imported on first use: few programs need any of them."""

__getattr__ = imported_on_first_use(__name__, PLACES)
