"""The command line without an installed script: ``python -m aionode topic list``."""

from aionode.cli import main

__all__: list[str] = []

if __name__ == "__main__":
    raise SystemExit(main())
