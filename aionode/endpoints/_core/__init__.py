"""The machinery behind every endpoint: queue, callbacks, entry in the graph. Private."""
