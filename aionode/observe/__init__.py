"""What all processes of a system count, asked from one of them.

::

    snapshot = await observe(node)
    for process in snapshot.processes:
        print(process.program, process.memory_bytes)
    print(snapshot.silent, snapshot.older)

Every context of aionode answers with the counts that its endpoints and callbacks keep anyway: no
message is subscribed to, and nothing runs while nobody asks. Two snapshots give rates: `rates`.
"""

from aionode.engine.observation import DurationReport, EntityReport, NodeReport, ProcessReport
from aionode.observe._rates import EntityRate, ProcessRate, Rates, rates
from aionode.observe._snapshot import Snapshot, observe

__all__ = [
    "DurationReport",
    "EntityRate",
    "EntityReport",
    "NodeReport",
    "ProcessRate",
    "ProcessReport",
    "Rates",
    "Snapshot",
    "observe",
    "rates",
]
