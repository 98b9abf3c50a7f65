"""Interface definitions: ``.msg``, ``.srv`` and ``.action`` text to classes, modules and back."""

from __future__ import annotations

from aionode.idl.build import define
from aionode.idl.folder import Interfaces, load_interfaces
from aionode.idl.generator import generate
from aionode.idl.text import definition_text

__all__ = ["Interfaces", "define", "definition_text", "generate", "load_interfaces"]
