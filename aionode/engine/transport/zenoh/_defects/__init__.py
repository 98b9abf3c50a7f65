"""Defects of Zenoh that aionode works around: one module for each.

The docstring of each says what Zenoh does, in which versions, where it was reported, and how
aionode mends it. A mend that cannot be cut out of its surroundings is named there with its place.
`tests/zenoh_defects` has a program for each module, of the same name, that needs nothing but Zenoh,
and fails when Zenoh no longer does it: ``make zenoh-defects``. Then the mend can go.

``AIONODE_ZENOH_UNMENDED=closing,lingering`` switches the mends of these modules off.

Two races have no module, as no program shows them within seconds: Zenoh may deliver the end of a
token after its return (`Watcher.check` in `_graph_watcher` compares), and a subscriber asks once
for what it misses of a history, also if the connection is lost meanwhile (`ZenohWriter`
acknowledges those of KEEP_ALL).

Behaviour that Zenoh documents is no defect, though aionode has to live with it: DROP drops without
a word (`_acknowledgements`), a router carries nothing between its peers (`_local_router`,
`_router_matching`), gossip tells all of all (`_local_sessions`, `_connect_slots`).
"""
