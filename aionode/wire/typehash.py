"""Hashes of types; see `aionode.engine.wire.typehash`."""

from aionode.engine.wire.typehash import description_message, referenced_types, type_hash

__all__ = ["description_message", "referenced_types", "type_hash"]
