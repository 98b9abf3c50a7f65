"""Systems: processes and nodes that are started, watched and stopped as one unit.

::

    async def main(system: System) -> None:
        system.process("driver", ["my_driver"], ready=TopicPublished("/odom"))
        system.node("planner", "my_robot.planner:Planner", restart="on-failure")
        await system.ready()

    aionode.system.run(main)
"""

from typing import TYPE_CHECKING, Final

from aionode._process.first_use import imported_on_first_use

if TYPE_CHECKING:
    from aionode.system._control import SystemCommand
    from aionode.system._log import SystemLog
    from aionode.system._main import run
    from aionode.system._member import Member, MemberOptions
    from aionode.system._readiness import (
        ActionReady,
        Fact,
        NodeActive,
        NodeExists,
        ServiceReady,
        TopicPublished,
    )
    from aionode.system._status import MemberEnd, MemberStatus, SystemHealth
    from aionode.system._system import System

__all__ = [
    "ActionReady",
    "Fact",
    "Member",
    "MemberEnd",
    "MemberOptions",
    "MemberStatus",
    "NodeActive",
    "NodeExists",
    "ServiceReady",
    "System",
    "SystemCommand",
    "SystemHealth",
    "SystemLog",
    "TopicPublished",
    "run",
]

PLACES: Final = {
    "SystemCommand": "_control",
    "SystemLog": "_log",
    "run": "_main",
    "Member": "_member",
    "MemberOptions": "_member",
    "ActionReady": "_readiness",
    "Fact": "_readiness",
    "NodeActive": "_readiness",
    "NodeExists": "_readiness",
    "ServiceReady": "_readiness",
    "TopicPublished": "_readiness",
    "MemberEnd": "_status",
    "MemberStatus": "_status",
    "SystemHealth": "_status",
    "System": "_system",
}
"""The module of each name, imported on first use, as `aionode run` needs only `node_source`."""

__getattr__ = imported_on_first_use(__name__, PLACES, "system")
