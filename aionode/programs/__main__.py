"""``python -m aionode.programs PACKAGE EXECUTABLE [ARGS]...``: runs one of the programs."""

from __future__ import annotations

import sys
from importlib import import_module

from aionode._packages import program_module


def main() -> None:
    """Run the program named by the first two arguments; the remaining ones are its own.

    Raises:
        SystemExit: With status 2 if there is no such program.
    """
    module = program_module(*sys.argv[1:3]) if len(sys.argv) > 2 else None
    if module is None:
        sys.stderr.write("usage: python -m aionode.programs PACKAGE EXECUTABLE [ARGS]...\n")
        raise SystemExit(2)
    sys.argv[:] = sys.argv[2:]
    import_module(module).main()


if __name__ == "__main__":
    main()
