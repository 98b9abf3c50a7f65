"""Programs of one file that show one thing each; they use public names only.

Run one with ``python -m aionode.examples.pubsub``: also `service`, `timers` and `overload`.
"""

__all__: list[str] = []
