"""Defects of programs of others that run with aionode's rclpy, and what works around them.

`tests/rclpy/test_defects.py` fails for each once it has been mended; then its workaround can go.
"""

from __future__ import annotations

from importlib import import_module
from pathlib import Path

__all__ = ["prepare"]


def prepare(program: str) -> None:
    """Work around the defects of a program, given its path, before it runs.

    xacro 2.1.1 handles ``xml.parsers.expat.ExpatError`` without importing that module, which its
    first file does, so for a file that does not exist it ends with "module 'xml' has no attribute
    'parsers'". Not reported.
    """
    if Path(program).name == "xacro":
        import_module("xml.parsers.expat")
