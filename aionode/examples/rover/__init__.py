"""A rover to try everything with: four nodes in a simulated room, and a page to drive it.

``python -m aionode.examples.rover`` runs all of it in one process; ``aionode launch`` of the file
`rover.launch.py` beside this one starts a process for each part.
"""

__all__: list[str] = []
