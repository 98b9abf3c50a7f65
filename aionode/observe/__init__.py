"""The counts of all processes of a system, and the causes of their messages.

::

    snapshot = await observe(node)
    for process in snapshot.processes:
        print(process.program, process.memory_bytes)
    print(snapshot.silent, snapshot.older)

Every aionode context answers with counts that its endpoints and callbacks keep anyway: nothing is
subscribed to, and nothing runs while nobody asks. `rates` computes rates from two snapshots.

`why` returns what led to the last message of a topic, from callback to callback and from process to
process; `to_chains` formats it. Contexts keep the data for it only on request:
``AIONODE_CAUSES=1`` or ``Context(causes=True)``. `record_trace` records their callbacks on a common
time axis for Perfetto, and `export_spans` exports them to OpenTelemetry. `CauseRecorder` turns them
into texts for a recording, from which `RecordedCauses` answers later.

`picture_of` returns the graph for drawing by `to_text`, `to_dot`, `to_mermaid` and `to_svg`.
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
