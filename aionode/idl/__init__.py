"""Converts interface definitions (``.msg``, ``.srv``, ``.action``) to Python classes and back."""

from __future__ import annotations

from aionode.idl._build import define
from aionode.idl._definition_text import definition_text
from aionode.idl._folder import Interfaces, load_interfaces
from aionode.idl._generator import generate

__all__ = ["Interfaces", "define", "definition_text", "generate", "load_interfaces"]
