"""Show, check and play the bags in a clone of rosbag2, whose folder is the argument.

Prints the exit status of each command; its own is 1 if one of them fails.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

COMMANDS = (("info",), ("check",), ("play", "--rate", "1000"))


def main(folder: Path) -> int:
    """Run the commands for each bag, and return how many failed."""
    failed = 0
    for bag in sorted(each.parent for each in folder.rglob("resources/**/metadata.yaml")):
        for command, *options in COMMANDS:
            ran = subprocess.run(
                [sys.executable, "-m", "aionode", "bag", command, str(bag), *options],
                capture_output=True,
                text=True,
                timeout=300,
                check=False,
            )
            is_wrong = ran.returncode != 0 or "Traceback" in ran.stderr
            failed += is_wrong
            sys.stdout.write(f"{command} {bag}: {ran.returncode}\n{ran.stderr * is_wrong}")
    return failed


if __name__ == "__main__":
    sys.exit(1 if main(Path(sys.argv[1])) else 0)
