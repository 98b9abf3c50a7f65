"""The printed tables of the ipc benchmark."""

from __future__ import annotations

from typing import Any

from benchmarks.ipc_parts.common import (
    BURST,
    CALL_LINK,
    CORES,
    FLOOR_OF,
    FULL,
    IMAGE_FLOOR,
    IMAGE_LINK,
    OVER_LINK,
    PACED,
    SOCKET,
)


def targets(loop: str, tables: dict[str, list[dict[str, Any]]]) -> list[tuple[str, ...]]:
    """Return a line per target of one loop: name, figure, target, met or missed, lower bound."""
    trips = [one for one in tables["round_trips"] if one["loop"] == loop]
    found = {(one["cores"], one["what"], one["speed"]): one for one in trips}
    bursts = {o["what"]: o for o in tables["bursts"] if o["loop"] == loop}
    duty = {o["what"]: o for o in tables["duties"] if o["loop"] == loop}
    placed = list(dict.fromkeys(one["cores"] for one in trips))
    table: list[tuple[str, ...]] = []

    def add(what: str, figure: float, bound: float, unit: str, floor: float) -> None:
        met = figure >= bound if unit == "msg/s" else figure <= bound
        sign = ">=" if unit == "msg/s" else "<="
        form = {"msg/s": ",.0f", "ms": ".3f"}.get(unit, ".2f")
        found_here = f"{figure:{form}} {unit}"
        verdict = "met" if met else "MISSED"
        table.append((loop, what, found_here, f"{sign} {bound:{form}}", verdict, f"{floor:{form}}"))

    for cores in placed:
        for name in (OVER_LINK, CALL_LINK):
            for speed, bound in ((FULL, 1.6), (PACED, 1.4)):
                one, floor = found[cores, name, speed], found[cores, SOCKET, speed]
                what = f"{name}, {speed}, {CORES[cores]}"
                add(f"{what}: p50", one["p50_us"] / floor["p50_us"], bound, "x floor", 1)
                tail = floor["p99_us"] / floor["p50_us"]
                add(f"{what}: p99", one["p99_us"] / one["p50_us"], 2, "x its p50", tail)
    add(
        "burst into a callback", bursts[OVER_LINK]["messages_per_s"], 200_000, "msg/s",
        bursts[SOCKET]["messages_per_s"],
    )  # fmt: skip
    for speed in (FULL, PACED):
        one, floor = (
            found[placed[0], f"{name}, one way", speed]["p50_us"]
            for name in (IMAGE_LINK, IMAGE_FLOOR)
        )
        add(f"{IMAGE_LINK}, one way, {speed}", one / 1e3, 1, "ms", floor / 1e3)
    for side in ("publisher", "reader"):
        one, floor = (duty[name][f"{side}_percent"] for name in (OVER_LINK, SOCKET))
        add(f"100 Hz, {side}", one, 1.5, "% of a core", floor)
    return table


def print_tables(tables: dict[str, list[dict[str, Any]]]) -> list[tuple[str, ...]]:
    """Print everything, and return the lines of the last table."""
    floors = {
        (o["loop"], o["cores"], o["what"], o["speed"]): o["p50_us"] for o in tables["round_trips"]
    }
    print(
        f"{'loop':8} {'cores':5} {'to another process and back, in us':38} {'speed':10} "
        f"{'p50':>8} {'p99':>8} {'p99/p50':>8} {'x floor':>8} {'count':>6}"
    )
    for one in tables["round_trips"]:
        name, _, route = one["what"].partition(", one way")
        floor = FLOOR_OF.get(name, SOCKET) + (", one way" if route or one["what"] != name else "")
        times_floor = one["p50_us"] / floors[one["loop"], one["cores"], floor, one["speed"]]
        print(
            f"{one['loop']:8} {one['cores']:5} {one['what']:38} {one['speed']:10} "
            f"{one['p50_us']:8.1f} {one['p99_us']:8.1f} {one['p99_us'] / one['p50_us']:8.2f} "
            f"{times_floor:8.2f} {one['count']:6}"
        )
    print(
        f"\n{'loop':8} {f'bursts of {BURST:,} into a callback':38} {'msg/s':>10} {'best':>10} "
        f"{'published':>10} lost"
    )
    for one in tables["bursts"]:
        print(
            f"{one['loop']:8} {one['what']:38} {one['messages_per_s']:10,} "
            f"{one['best_per_s']:10,} {one['published_per_s'] or '':>10} {one['lost']:4}"
        )
    print(f"\n{'loop':8} {'100 Hz, % of a core':38} {'publisher':>10} {'reader':>10}  messages")
    for one in tables["duties"]:
        print(
            f"{one['loop']:8} {one['what']:38} {one['publisher_percent']:10.2f} "
            f"{one['reader_percent']:10.2f}  {one['received']} of {one['sent']}"
        )
    print(f"\n{'loop':8} {'target':50} {'figure':>18} {'bound':>11} {'':7} {'the floor has':>14}")
    checked = [
        line
        for loop in dict.fromkeys(one["loop"] for one in tables["duties"])
        for line in targets(loop, tables)
    ]
    for loop, what, figure, bound, met, floor in checked:
        print(f"{loop:8} {what:50} {figure:>18} {bound:>11} {met:7} {floor:>14}")
    return checked
