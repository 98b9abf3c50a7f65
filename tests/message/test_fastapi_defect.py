"""The defect of FastAPI that `aionode/message/_fastapi.py` works around."""

from __future__ import annotations

from typing import Any

import pytest
from fastapi.encoders import jsonable_encoder
from pydantic import TypeAdapter
from pydantic_core import CoreSchema, core_schema


class Written:
    """A class with a Pydantic schema that is neither a model nor a dataclass."""

    __slots__ = ()

    @classmethod
    def __get_pydantic_core_schema__(cls, _source: Any, _handler: Any) -> CoreSchema:
        """Return how Pydantic writes it."""
        return core_schema.any_schema(
            serialization=core_schema.plain_serializer_function_ser_schema(lambda _: {"x": 1})
        )


def test_fastapi_writes_nothing_by_pydantic_that_no_annotation_describes() -> None:
    """If this fails, FastAPI was fixed: remove `aionode/message/_fastapi.py` and this file."""
    Written.__pydantic_serializer__ = TypeAdapter(Written).serializer  # type: ignore[attr-defined]

    assert TypeAdapter(Written).dump_python(Written()) == {"x": 1}
    with pytest.raises(ValueError, match="vars"):
        jsonable_encoder(Written())
