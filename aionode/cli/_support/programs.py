"""rclpy programs and executables of packages, found without click, which takes time to import."""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterator, Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Final

from aionode.errors import AionodeError, CommandError, PackageNotFoundError

if TYPE_CHECKING:
    from aionode._packages import Packages

__all__ = ["Programs", "module_of"]

PACKAGE: Final = re.compile(r"[a-zA-Z][a-zA-Z0-9_-]+")


def module_of(args: Sequence[str]) -> list[str] | None:
    """Return the module that ``aionode run`` executes for a program in Python, and its arguments.

    None if the command line has to be parsed first, for options, node classes and other programs,
    or if there is an error to report.
    """
    if not args or args[0].startswith("-") or ":" in args[0]:
        return None
    try:
        command = Programs(None).command(args) or []
    except (AionodeError, OSError):
        return None
    return command[2:] if command[:2] == [sys.executable, "-m"] else None


class Programs:
    """rclpy programs and executables of packages.

    Args:
        workspace: The folder with the packages; defaults to the workspace around the current
            folder.
    """

    def __init__(self, workspace: str | None) -> None:
        self._workspace = [] if workspace is None else ["--workspace", workspace]

    @cached_property
    def _packages(self) -> Packages:
        """The packages of the workspace; the file of a program does not need them."""
        from aionode._packages import Packages, workspace_of

        if self._workspace:
            return Packages(Path(self._workspace[1]))
        current = Path.cwd()
        return Packages(workspace_of(current) or current)

    def use_workspace(self, specs: Sequence[str]) -> None:
        """Make the types of the given workspace, or the one around the files, known to nodes."""
        from aionode._packages import use, workspace_of

        files = (Path(source) for source in (spec.partition(":")[0] for spec in specs))
        around = (workspace_of(file) for file in files if file.suffix == ".py")
        workspace = self._workspace[1] if self._workspace else next(filter(None, around), None)
        if workspace is not None:
            use(workspace)

    def under_rclpy(self, *program: str) -> list[str]:
        """Return the command line of an rclpy program: its file, or ``-m`` and its module."""
        own = [sys.executable, "-m", "aionode.rclpy"]
        return [*own, *self._workspace, *program]

    def command(self, args: Sequence[str]) -> list[str] | None:
        """Return the command line that the arguments stand for; None if they name node classes.

        Raises:
            CommandError: an executable of a package is missing.
            PackageNotFoundError: two words are neither a package with an executable, nor modules.
            ExecutableNotFoundError: the package has no such executable.
        """
        if not args:
            return None
        if is_rclpy_program(args[0]):
            return self.under_rclpy(*args)
        source, colon, function = args[0].partition(":")
        if not colon:
            return self._executable(args)
        file = self._module_file(source)
        if file is None or not is_rclpy_program(str(file)):
            return None
        path = ("--path", str(module_folder(source, file)))
        module = file.stem if source.endswith(".py") else source
        return self.under_rclpy(*path, "-m", f"{module}:{function}", *args[1:])

    def module_folders(self, specs: Sequence[str]) -> list[str]:
        """Return the package folders from which node classes are imported."""
        sources = dict.fromkeys(spec.partition(":")[0] for spec in specs)
        files = {source: self._module_file(source) for source in sources}
        return [str(module_folder(source, file)) for source, file in files.items() if file]

    def _executable(self, args: Sequence[str]) -> list[str] | None:
        """Return the command line for a package and its executable."""
        name, *rest = args
        if not PACKAGE.fullmatch(name):
            return None
        named = rest[0] if rest and not rest[0].startswith("-") and ":" not in rest[0] else None
        try:
            if named is not None:
                return [*self._packages.command(name, named), *rest[1:]]
            if self._module_file(name, here=True) is not None:
                return None
            known = ", ".join(self._packages.executables(name)) or "none"
        except PackageNotFoundError:
            if named is None or self._module_file(name) is not None:
                return None  # modules with node classes; errors about them are reported later
            raise
        raise CommandError(f"{name}: give an executable of this package: {known}")

    def _module_file(self, source: str, *, here: bool = False) -> Path | None:
        """Return the file of a module: in this folder, on PYTHONPATH, or in a package."""
        if source.endswith(".py"):
            return Path(source) if Path(source).is_file() else None
        inside = Path(*source.split("."))
        for folder in self._module_folders("" if here or not source else inside.parts[0]):
            for file in (inside.with_suffix(".py"), inside / "__init__.py"):
                if Path(folder, file).is_file():
                    return Path(folder, file)
        return None

    def _module_folders(self, module: str) -> Iterator[str]:
        """Yield the folders that may contain a module; the packages' folders come last."""
        yield str(Path.cwd())
        yield from filter(None, sys.path)
        root = self._packages.module_root(module) if module else None
        if root is not None:
            yield str(root)


def module_folder(source: str, file: Path) -> Path:
    """Return the folder from which the module with this name and file is imported."""
    if source.endswith(".py"):
        return file.parent
    depth = source.count(".") + (file.name == "__init__.py")
    return file.parents[depth]


def is_rclpy_program(name: str) -> bool:
    """Return whether a name is that of a file that imports rclpy or ROS message packages.

    A Python executable of an installed package is one too: it imports that package.
    """
    if not name.endswith(".py"):
        from aionode._packages import is_python

        return Path(name).is_file() and is_python(Path(name))
    try:
        tree = ast.parse(Path(name).read_bytes())
    except (OSError, SyntaxError, ValueError):
        return False
    modules = {
        module
        for node in ast.walk(tree)
        for module in (
            [alias.name for alias in node.names]
            if isinstance(node, ast.Import)
            else [node.module or ""]
            if isinstance(node, ast.ImportFrom)
            else []
        )
    }
    packages = {module.partition(".")[0] for module in modules}
    if "rclpy" in packages:
        return True
    from aionode.interfaces import shipped_packages  # it loads the base of all messages

    return not packages.isdisjoint(shipped_packages())
