"""The structure of aionode's modules: their imports, and what is private."""

from __future__ import annotations

import ast
import re
from collections import Counter
from functools import cache
from pathlib import Path

import grimp
import pytest

import aionode
from tests import private_reads, structure

pytestmark = pytest.mark.timeout(300)  # beside other work, parsing all modules takes a minute

ROOT = Path(aionode.__file__).parent
MODULES = sorted(
    path for path in ROOT.rglob("*.py") if path.relative_to(ROOT).parts[0] != "interfaces"
)

MAX_PRIVATE_READS = 124
"""How often tests may read private names of aionode; the number only falls."""

MAX_MODULES = 20
"""How many modules may stand at one level."""

LATE = {
    ("aionode.message._message", "aionode.message._schema"): "few programs use Pydantic",
    ("aionode.message._service_types", "aionode.interfaces"): "services have generated messages",
    ("aionode.testing._system", "aionode.launch"): "a system under test may be a launch file",
}
"""Imports against the direction of all others, inside a function, and why."""


@cache
def graph(*, types: bool) -> grimp.ImportGraph:
    """Return who imports whom in aionode, with the imports for type checkers or without."""
    imports = grimp.build_graph("aionode", exclude_type_checking_imports=not types, cache_dir=None)
    for importer, package in LATE:
        for imported in imports.find_modules_directly_imported_by(importer):
            if f"{imported}.".startswith(f"{package}."):
                imports.remove_import(importer=importer, imported=imported)
    return imports


def test_tests_read_fewer_private_names_than_before() -> None:
    """Such a test breaks with each change inside, and passes when the public name is broken."""
    counts = private_reads.count()
    reads = sum(names.total() for names in counts.values())
    assert reads <= MAX_PRIVATE_READS, {str(path): [*names] for path, names in counts.items()}


def test_no_imports_form_a_cycle() -> None:
    """Modules in a cycle can only be understood together, also where only types are imported."""
    found = [sorted(cycle) for cycle in cycles(graph(types=True))]

    assert found == []


def cycles(imports: grimp.ImportGraph) -> set[frozenset[str]]:
    """Return the sets of modules that import one another, directly or not."""
    found = set()
    for module in imports.modules:
        both = imports.find_upstream_modules(module) & imports.find_downstream_modules(module)
        if both:
            found.add(frozenset(both | {module}))
    return found


def test_no_private_name_crosses_a_room() -> None:
    """What begins with an underscore may change without a look at other top-level folders."""
    assert structure.crossings() == []


def test_reading_a_private_attribute_of_another_room_is_a_crossing() -> None:
    """The room that defines the name may read it, and a subclass anywhere of itself."""
    reader = "context._acquire()\nself._acquire()"
    trees = {
        Path("engine/context.py"): ast.parse("class Context:\n    def _acquire(self): ..."),
        Path("engine/bare_node.py"): ast.parse(reader),
        Path("node/_node.py"): ast.parse(reader),
    }

    assert structure.reads(trees) == ["node/_node.py:1: context._acquire"]


def test_what_a_borrower_of_a_loop_may_reach_asks_for_that_loop() -> None:
    """Who has borrowed a loop is not known to asyncio, but to `running_loop`."""
    reached = [
        path
        for path in MODULES
        if path.relative_to(ROOT).parts[0] in {"engine", "clock", "graph.py"}
    ]

    assert [path for path in reached if "get_running_loop" in path.read_text("utf-8")] == []


def test_no_folder_has_more_than_twenty_modules() -> None:
    """A reader finds an idea by its folder; files that the names of ROS decide are free of it."""
    folders = Counter(path.parent.relative_to(ROOT).as_posix() for path in MODULES)
    del folders["ros_packages/rclpy"]

    assert [folder for folder, modules in folders.items() if modules > MAX_MODULES] == []


THREADS_AND_LOCKS = {
    "_thread.allocate_lock",
    "_thread.start_new_thread",
    "aionode._process.sudden_end.start_thread",
    "asyncio.to_thread",
    "concurrent.futures.ThreadPoolExecutor",
    "threading.Barrier",
    "threading.BoundedSemaphore",
    "threading.Condition",
    "threading.Lock",
    "threading.RLock",
    "threading.Semaphore",
    "threading.Thread",
    "threading.Timer",
}
"""What makes a thread, or a lock between threads; and `run_in_executor` of every loop."""


LOCKS = {name for name in THREADS_AND_LOCKS if re.search("ock|Condition|Semaphore|Barrier", name)}


def rows_on_threads_and_locks() -> list[str]:
    """Return the rows of the tables in the design."""
    page = (ROOT.parent / "docs/design.md").read_text(encoding="utf-8")
    section = page.partition("\n## Threads and locks\n")[2].partition("\n## ")[0]
    return [row for row in section.splitlines() if row.startswith("|")]


def test_the_design_names_each_module_that_makes_a_thread_or_a_lock() -> None:
    """Whoever makes one adds its row to the table: who owns it, what it guards, who takes it."""
    rows = rows_on_threads_and_locks()
    named = {file for row in rows for file in re.findall(r"`([\w/]+\.py)`", row)}
    making = {path.relative_to(ROOT).as_posix() for path in MODULES if makes_threads(path)}

    assert making == named


def test_the_design_has_the_name_of_each_thread() -> None:
    """A reader who sees a thread in a debugger, or in ``ps -L``, looks it up by its name."""
    shown = {name for row in rows_on_threads_and_locks() for name in re.findall(r"`([\w-]+)`", row)}
    given = {name for path in MODULES for name in names_of_threads(path)}

    assert given <= shown


def names_of_threads(path: Path) -> set[str]:
    """Return the names that a module gives to threads: arguments called name, or of SendThread."""
    tree = parsed_if_it_has_threads(path)
    calls = [node for node in ast.walk(tree) if isinstance(node, ast.Call)]
    makers = [call for call in calls if ast.unparse(call.func).endswith("Thread")]
    values = [
        value
        for call in makers
        for value in [*call.args[:1], *(word.value for word in call.keywords if word.arg == "name")]
    ]
    return {
        value.value
        for value in values
        if isinstance(value, ast.Constant) and isinstance(value.value, str)
    }


@cache
def parsed_if_it_has_threads(path: Path) -> ast.Module:
    """Return the tree of a module; an empty one if it has no word of threads."""
    text = path.read_text(encoding="utf-8")
    # To parse all modules takes seconds.
    return ast.parse(text if re.search(r"[tT]hread|Executor|run_in_executor", text) else "")


def test_the_design_names_each_lock() -> None:
    """One row may stand for all locks of a kind in its modules; else each has its own."""
    unnamed = []
    for path in MODULES:
        file = path.relative_to(ROOT).as_posix()
        rows = [row for row in rows_on_threads_and_locks() if f"`{file}`" in row]
        of_a_kind = any(row.startswith(("| those ", "| one for each ")) for row in rows)
        unnamed += [
            f"{file}: {lock}"
            for lock in locks_of(path)
            if not of_a_kind and not any(f"`{lock}`" in row for row in rows)
        ]

    assert unnamed == []


def locks_of(path: Path) -> set[str]:
    """Return the locks that a module assigns to something: ``Class._lock``, or ``LOCK``."""
    tree = parsed_if_it_has_threads(path)
    names = imported_names(tree)
    holders = [tree, *(node for node in ast.walk(tree) if isinstance(node, ast.ClassDef))]
    found: dict[ast.AST, str] = {}
    for holder in holders:  # a class comes after what it is in
        prefix = f"{holder.name}." if isinstance(holder, ast.ClassDef) else ""
        for node in ast.walk(holder):
            if not isinstance(node, ast.Assign | ast.AnnAssign):
                continue
            made = node.value
            if isinstance(made, ast.Call) and full_name(made.func, names) in LOCKS:
                target = node.targets[0] if isinstance(node, ast.Assign) else node.target
                found[node] = prefix + ast.unparse(target).removeprefix("self.")
    return set(found.values())


def imported_names(tree: ast.Module) -> dict[str, str]:
    """Return what the names stand for that a module imports."""
    names: dict[str, str] = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names |= {alias.asname or alias.name: alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            names |= {
                alias.asname or alias.name: f"{node.module}.{alias.name}" for alias in node.names
            }
    return names


def makes_threads(path: Path) -> bool:
    """Return whether a module makes threads, or locks between threads."""
    tree = parsed_if_it_has_threads(path)
    names = imported_names(tree)
    used = [
        function
        for node in ast.walk(tree)
        for function in (
            [node.func]
            if isinstance(node, ast.Call)
            else node.bases
            if isinstance(node, ast.ClassDef)
            else []
        )
    ]
    return any(
        (isinstance(function, ast.Attribute) and function.attr == "run_in_executor")
        or full_name(function, names) in THREADS_AND_LOCKS
        for function in used
    )


def full_name(function: ast.expr, names: dict[str, str]) -> str:
    """Return what a name in the source stands for, given what the module imports."""
    first, _, rest = ast.unparse(function).partition(".")
    return f"{names.get(first, first)}.{rest}".rstrip(".")
