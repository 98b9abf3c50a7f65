"""What all processes of a system count, asked from one of them.

::

    snapshot = await observe(node)
    for process in snapshot.processes:
        print(process.program, process.memory_bytes)
    print(snapshot.silent, snapshot.older)

Every context of aionode answers with the counts that its endpoints and callbacks keep anyway: no
message is subscribed to, and nothing runs while nobody asks. Two snapshots give rates: `rates`.

`picture_of` is the graph as something to draw: `to_text`, `to_dot`, `to_mermaid` and `to_svg`.
"""

from aionode.engine.observation import DurationReport, EntityReport, NodeReport, ProcessReport
from aionode.observe._drawing import to_dot, to_mermaid, to_svg, to_text
from aionode.observe._picture import Edge, Picture, Vertex, difference, picture_of
from aionode.observe._rates import EntityRate, ProcessRate, Rates, rates
from aionode.observe._snapshot import Snapshot, observe

__all__ = [
    "DurationReport",
    "Edge",
    "EntityRate",
    "EntityReport",
    "NodeReport",
    "Picture",
    "ProcessRate",
    "ProcessReport",
    "Rates",
    "Snapshot",
    "Vertex",
    "difference",
    "observe",
    "picture_of",
    "rates",
    "to_dot",
    "to_mermaid",
    "to_svg",
    "to_text",
]
