"""What all processes of a system count, asked from one of them.

::

    snapshot = await observe(node)
    for process in snapshot.processes:
        print(process.program, process.memory_bytes)
    print(snapshot.silent, snapshot.older)

Every context of aionode answers with the counts that its endpoints and callbacks keep anyway: no
message is subscribed to, and nothing runs while nobody asks. Two snapshots give rates: `rates`.

`why` tells what led to the last message of a topic, from callback to callback and from process to
process; `to_chains` prints it. Contexts keep what that needs if they were asked to:
``AIONODE_CAUSES=1`` or ``Context(causes=True)``. `record_trace` has their callbacks on one axis of
time, for Perfetto, and `export_spans` hands them to OpenTelemetry. A `CauseRecorder` has them as
texts for a recording, from which `RecordedCauses` answers later.

`picture_of` is the graph as something to draw: `to_text`, `to_dot`, `to_mermaid` and `to_svg`.
"""

from aionode.engine.observation import DurationReport, EntityReport, NodeReport, ProcessReport
from aionode.observe._causes import Cause, Caused, Why, why
from aionode.observe._chains import to_chains
from aionode.observe._drawing import to_dot, to_mermaid, to_svg, to_text
from aionode.observe._picture import Edge, Picture, Vertex, difference, picture_of
from aionode.observe._rates import EntityRate, ProcessRate, Rates, rates
from aionode.observe._recorded import CauseRecorder, RecordedCauses
from aionode.observe._snapshot import Snapshot, observe
from aionode.observe._spans import export_spans
from aionode.observe._trace import Trace, record_trace

__all__ = [
    "Cause",
    "CauseRecorder",
    "Caused",
    "DurationReport",
    "Edge",
    "EntityRate",
    "EntityReport",
    "NodeReport",
    "Picture",
    "ProcessRate",
    "ProcessReport",
    "Rates",
    "RecordedCauses",
    "Snapshot",
    "Trace",
    "Vertex",
    "Why",
    "difference",
    "export_spans",
    "observe",
    "picture_of",
    "rates",
    "record_trace",
    "to_chains",
    "to_dot",
    "to_mermaid",
    "to_svg",
    "to_text",
    "why",
]
