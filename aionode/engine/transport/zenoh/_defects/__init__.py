"""Zenoh defects that aionode works around, one module for each.

Each docstring says what Zenoh does, in which versions, where it was reported, and how aionode works
around it. If a workaround cannot be separated from its surroundings, the docstring says where it
is. `tests/zenoh_defects` has a program of the same name for each module, which needs nothing but
Zenoh and fails once Zenoh no longer has the defect: ``make zenoh-defects``. Then the workaround can
go.

``AIONODE_ZENOH_UNMENDED=closing,lingering`` disables the workarounds of these modules.

Two races have no module, as no program shows them within seconds: Zenoh may deliver the end of a
token after its return (`Watcher.check` in `graph_watcher` compares), and a subscriber asks only
once for what it misses of a history, even if the connection is lost meanwhile (`ZenohWriter`
acknowledges those of KEEP_ALL).

Behaviour that Zenoh documents is not a defect, though aionode has to live with it: DROP silently
drops (`acknowledgements`), a router forwards nothing between its peers (`local_router`,
`router_matching`), and gossip tells everyone about everyone (`local_sessions`, `connect_slots`).
"""
