"""Systems: processes and nodes that are started, watched and stopped as one unit.

::

    async def main(system: System) -> None:
        system.process("driver", ["my_driver"], ready=TopicPublished("/odom"))
        system.node("planner", "my_robot.planner:Planner", restart="on-failure")
        await system.ready()

    aionode.system.run(main)
"""

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
