"""The structure of aionode's modules: their length, their imports, and what is private."""

from __future__ import annotations

import ast
import re
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

import grimp

import aionode
from tests import private_reads

if TYPE_CHECKING:
    from collections.abc import Iterator

ROOT = Path(aionode.__file__).parent
MODULES = sorted(
    path for path in ROOT.rglob("*.py") if path.relative_to(ROOT).parts[0] != "interfaces"
)

MAX_LINES = 600
MAX_CHAIN = 14
"""How many modules may import one another in a row, each at its top."""

MOST_PRIVATE_READS = 124
"""How often tests may read private names of aionode; the number only falls."""

SHARED = {
    "aionode.arguments._parameter_yaml": "the command line reads and writes parameter files too",
    "aionode.clock._time_base": "timers and goals have alarms, which users do not",
    "aionode.clock._timer_heap": "the manual clock of tests keeps its alarms in one",
    "aionode.clock._values": "QoS and log have times, not clocks; the manual clock has seconds",
    "aionode.endpoints._core": "nodes are made of it, and tools report callbacks by it",
    "aionode.endpoints._qos": "rclpy's publishers and subscriptions have the same events",
    "aionode.endpoints.actions": "aionode.action is its public name",
    "aionode.engine.rules.schedule": "timers of rclpy's API go by the same schedule",
    "aionode.endpoints.timer._timer": "Node.create_timer builds one",
    "aionode.errors._base": "times and field types need its texts, not the exceptions",
    "aionode.idl._named": "programs of rclpy are started with folders of interfaces",
    "aionode.engine.rules.lifecycle_answers": "managed nodes of rclpy's API give the same answers",
    "aionode.logging._severity": "arguments name severities, and do not log",
    "aionode.bag._shrinking": "`aionode bag shrink` is its only user",
    "aionode.bag._yaml_files": "`aionode bag` and programs of rosbag2_py take these files",
    "aionode.bag._types": "programs of rosbag2_py write topics by the names of their types",
    "aionode.message._conversion": "`topic echo` and rclpy's programs cut and describe values, too",
    "aionode.message._field_types": "the codec compiles the fields of a message",
    "aionode.message._memory_size": "queues add up what their messages take",
    "aionode.message._message": "definitions become message classes",
    "aionode.message._validation": "the codec checks values by the same rules",
    "aionode.rclpy._missing": "launch files import packages of ROS that aionode lacks, too",
    "aionode.tf._apply": "the command line prints rotations as matrices and angles",
    "aionode.tf._buffer_core": "buffers of rclpy's programs take the same times and defaults",
    "aionode.tf._remote": "clients of rclpy's programs read the answers of the same servers",
    "aionode.tf._frame_listing": "the command line shows the rates of frames",
    "aionode.tf._waiters": "futures of rclpy's programs wait as tasks do",
    "aionode.engine.transport.network": "contexts and `aionode router` and `doctor` share settings",
    "aionode.engine.transport.send_thread": "contexts of rclpy's programs close before its threads end",
    "aionode.engine.transport.zenoh.session.session": "`aionode router` is a Zenoh session without nodes",
    "aionode.wire": "the wire format belongs to the transports; nothing outside aionode needs it",
}
"""Private modules that other packages of aionode import, and why. A package stands for its own."""


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


def test_a_module_can_be_read_in_one_sitting() -> None:
    """A module beyond the limit has more than one idea: split it, do not raise the limit."""
    lengths = {module: len(module.read_text(encoding="utf-8").splitlines()) for module in MODULES}

    assert {module: length for module, length in lengths.items() if length > MAX_LINES} == {}


def test_texts_name_the_thing_first() -> None:
    """A reader who looks for a thing does not find it behind "what" or "how many"."""
    free_relative = re.compile(r'\n *(?:"""|# )(?:What|Who|How (?:many|much|long|often)) ')

    modules = [path.name for path in MODULES if free_relative.search("\n" + path.read_text())]

    assert not modules


def test_tests_read_fewer_private_names_than_before() -> None:
    """Such a test breaks with each change inside, and passes when the public name is broken."""
    counts = private_reads.count()
    reads = sum(names.total() for names in counts.values())
    assert reads <= MOST_PRIVATE_READS, {str(path): [*names] for path, names in counts.items()}


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


OTHER_APIS = ("aionode.rclpy", "aionode.launch")
"""The names of ROS 2's packages, made of what users of aionode have: that is their bottom."""


def test_imports_are_not_deep() -> None:
    """A reader who follows the imports of a module arrives at the bottom soon.

    The bottom of the APIs of ROS 2's packages is what users of aionode have. Examples are programs
    of users, above it.
    """
    chain = longest_chain()

    assert len(chain) <= MAX_CHAIN, " → ".join(chain)


def longest_chain() -> list[str]:
    """Return the longest series of modules of which each imports the next when it is imported.

    The generated modules of standard messages are not counted.
    """
    imports = graph(types=False)
    chains: dict[str, list[str]] = {}

    def longest_from(module: str) -> list[str]:
        if module not in chains:
            chains[module] = [module]  # where a cycle ends
            below = [longest_from(imported) for imported in imported_at_once(imports, module)]
            chains[module] = [module, *max(below, key=len, default=[])]
        return chains[module]

    modules = sorted(imports.modules - imports.find_descendants("aionode.examples"))
    return max((longest_from(module) for module in modules), key=len)


def imported_at_once(imports: grimp.ImportGraph, module: str) -> list[str]:
    """Return what a module imports at its top, and not in a function."""
    return [
        imported
        for imported in sorted(imports.find_modules_directly_imported_by(module))
        if not imported.startswith("aionode.interfaces")
        and all(imported.startswith(api) == module.startswith(api) for api in OTHER_APIS)
        and any(
            detail["line_number"] not in deferred_lines(module)
            for detail in imports.get_import_details(importer=module, imported=imported)
        )
    ]


@cache
def deferred_lines(module: str) -> frozenset[int]:
    """Return the numbers of the lines of a module that are inside of functions."""
    path = ROOT.parent.joinpath(*module.split("."))
    path = path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
    return frozenset(
        line
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) and node.end_lineno
        for line in range(node.lineno, node.end_lineno + 1)
    )


def test_private_modules_are_imported_within_their_package() -> None:
    """What begins with an underscore may change without a look at other packages."""
    broken = [
        f"{importer} imports {imported}"
        for importer, imported in private_imports()
        if not exceptions_for(imported)
    ]

    assert broken == []


def test_a_private_module_is_shared_as_long_as_it_is_imported() -> None:
    """An exception that nothing needs is taken off the list."""
    used = {name for _, imported in private_imports() for name in exceptions_for(imported)}

    assert set(SHARED) - used == set()


def private_imports() -> Iterator[tuple[str, str]]:
    """Yield importer and imported, for each private module imported from outside its package."""
    imports = graph(types=True)
    for imported in sorted(imports.modules):
        parts = imported.split(".")
        private = [index for index, part in enumerate(parts) if part.startswith("_")]
        if not private or parts[-1] == "__main__":
            continue
        package = ".".join(parts[: private[0]])
        for importer in sorted(imports.find_modules_that_directly_import(imported)):
            if not f"{importer}.".startswith(f"{package}."):
                yield importer, imported


def exceptions_for(imported: str) -> list[str]:
    """Return the entries of SHARED that a module falls under."""
    return [name for name in SHARED if f"{imported}.".startswith(f"{name}.")]


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
