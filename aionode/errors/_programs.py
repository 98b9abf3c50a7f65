"""Errors about packages, executables, and members of systems."""

from __future__ import annotations

from collections.abc import Sequence

from aionode.errors._base import AionodeError, shortened

__all__ = [
    "ExecutableNotFoundError",
    "MemberNotFoundError",
    "NotReadyError",
    "PackageNotFoundError",
    "ProgramStartError",
]


class PackageNotFoundError(AionodeError, LookupError):
    """There is no package of this name.

    Attributes:
        name: The name that was looked up.
        places: The workspace and the folders of installed packages that were searched.
        suggestions: Names of similar packages.
        remark: What the package is and what to use instead, if aionode cannot provide it.
    """

    def __init__(
        self,
        name: str,
        places: tuple[str, ...],
        known: Sequence[str],
        remark: str = "",
        *,
        supplied: Sequence[str] = (),
    ) -> None:
        self.name = name
        self.places = places
        self.remark = remark
        self.suggestions, hint = offered(name, "packages there", known, supplied)
        if remark:
            hint = f"it is {remark}"
        super().__init__(
            f"package {name!r}: not found in {', '.join(places) or 'any folder'}; {hint}; "
            "--workspace FOLDER names the folder that holds it"
        )


class ExecutableNotFoundError(AionodeError, LookupError):
    """A package has no executable of this name.

    Attributes:
        package: The name of the package.
        name: The name that was looked up.
        place: The folder of the package; None if the package is not there, and only aionode's own
            programs stand in for it.
        suggestions: Names of similar executables.
        remark: What the package is and what to use instead, if aionode cannot provide all of it.
    """

    def __init__(
        self,
        package: str,
        name: str,
        place: str | None,
        known: Sequence[str],
        remark: str = "",
    ) -> None:
        self.package = package
        self.name = name
        self.place = place
        self.remark = remark
        self.suggestions, hint = offered(name, "its executables", known)
        if remark and known and place is None:
            hint = f"it has {', '.join(known)}; the package is {remark}"
        super().__init__(
            f"package {package!r}: not found, and aionode has no program {name!r} of it; {hint}; "
            "--workspace FOLDER names the folder that holds the package"
            if place is None
            else f"package {package!r}: no executable {name!r} in {place}; {hint}; they are the "
            "scripts of its setup.py, the programs of its CMakeLists.txt, and what was built"
        )


def offered(
    name: str, what: str, known: Sequence[str], supplied: Sequence[str] = ()
) -> tuple[tuple[str, ...], str]:
    """Return the names close to `name`, and a hint with them, or else with the first ten.

    Args:
        name: The name that was looked up.
        what: What the known names belong to, as text.
        known: The names of what is there.
        supplied: The names that aionode itself supplies, which may be close as well.
    """
    import difflib  # needed only for errors

    near = tuple(difflib.get_close_matches(name, [*known, *supplied], 1))
    more = f" and {len(known) - 10} more" if len(known) > 10 else ""
    hint = f"did you mean {near[0]}?" if near else f"{what}: {', '.join(known[:10]) or 'none'}"
    return near, hint if near else hint + more


class ProgramStartError(AionodeError, OSError):
    """A program could not be started.

    Attributes:
        argv: Its command line.
        problem: The reason.
    """

    def __init__(self, argv: Sequence[str], problem: str) -> None:
        self.argv = list(argv)
        self.problem = problem
        super().__init__(f"{' '.join(self.argv)}: could not be started: {problem}")


class MemberNotFoundError(AionodeError, LookupError):
    """A system has no member of this name.

    Attributes:
        name: The name that was looked up.
        known: The names of its members.
    """

    def __init__(self, name: str, known: Sequence[str]) -> None:
        self.name = name
        self.known = tuple(known)
        super().__init__(f"{name}: no such member; the system has {', '.join(known) or 'none'}")


class NotReadyError(AionodeError, TimeoutError):
    """A member of a system is not ready: something is missing, or the member has ended.

    Attributes:
        name: The member.
        problem: What is missing, or how it ended.
        last_lines: The last lines that it printed.
    """

    def __init__(self, name: str, problem: str, last_lines: Sequence[str] = ()) -> None:
        self.name = name
        self.problem = problem
        self.last_lines = tuple(last_lines)
        lines = "\n".join(f"  {line}" for line in self.last_lines)
        printed = f"; its last lines:\n{lines}" if lines else "; it has printed nothing"
        super().__init__(f"{name}: not ready: {problem}{shortened(printed)}")
