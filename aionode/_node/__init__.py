"""The classes and built-in services that make up `aionode.Node`."""
