"""A workaround: FastAPI has no hook for values in responses that no annotation describes.

Its `jsonable_encoder` writes Pydantic's models and dataclasses, and then the classes in a dict of
its own; it does not ask for `__pydantic_serializer__` or `__get_pydantic_core_schema__`, by which
Pydantic writes a message. `tests/message/test_fastapi_defect.py` fails when it does, and then this
module can go.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any

__all__ = ["NoDataclass"]


class NoDataclass:
    """What every dataclass has, and a message has not.

    `jsonable_encoder` asks each value for it before it looks into its dict. By then FastAPI is
    imported, and gets the function that writes messages.

    Args:
        write: Returns a message as builtin types that JSON has.
    """

    def __init__(self, write: Callable[[Any], Any]) -> None:
        self._write = write

    def __set_name__(self, owner: type, _name: str) -> None:
        """Note the class whose instances are written."""
        self._cls = owner

    def __get__(self, _message: object, _cls: type) -> Any:
        """Raise AttributeError."""
        encoders = getattr(sys.modules.get("fastapi.encoders"), "encoders_by_class_tuples", None)
        if isinstance(encoders, dict):
            encoders[self._write] = (self._cls,)
        raise AttributeError("__dataclass_fields__")
