"""A workaround: FastAPI has no hook for response values that no annotation describes.

Its `jsonable_encoder` handles Pydantic models, dataclasses, and then the classes in its own dict;
it does not use `__pydantic_serializer__` or `__get_pydantic_core_schema__`, with which Pydantic
serializes a message. Once it does, `tests/message/test_fastapi_defect.py` fails, and this module
can be removed.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any

__all__ = ["NoDataclass"]


class NoDataclass:
    """An attribute that every dataclass has, and messages do not.

    `jsonable_encoder` asks each value for it before it looks into its dict. FastAPI is imported by
    then, so this registers the function that serializes messages.

    Args:
        write: Converts a message to builtin types that JSON supports.
    """

    def __init__(self, write: Callable[[Any], Any]) -> None:
        self._write = write

    def __set_name__(self, owner: type, _name: str) -> None:
        """Record the class whose instances are serialized."""
        self._cls = owner

    def __get__(self, _message: object, _cls: type) -> Any:
        """Raise AttributeError."""
        encoders = getattr(sys.modules.get("fastapi.encoders"), "encoders_by_class_tuples", None)
        if isinstance(encoders, dict):
            encoders[self._write] = (self._cls,)
        raise AttributeError("__dataclass_fields__")
