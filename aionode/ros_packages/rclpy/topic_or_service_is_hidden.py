"""Hidden names."""

from aionode.names import is_hidden as topic_or_service_is_hidden

__all__ = ["HIDDEN_TOPIC_PREFIX", "topic_or_service_is_hidden"]

HIDDEN_TOPIC_PREFIX = "_"
