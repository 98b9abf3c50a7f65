"""Programs of one file that show one feature each, using public names only.

Run one with ``python -m aionode.examples.pubsub``; the others are `service`, `timers`, `fibonacci`,
`lifecycle` and `overload`. `rover` is a whole robot, in a simulated room.
"""

__all__: list[str] = []
