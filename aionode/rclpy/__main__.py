"""``python -m aionode.rclpy program.py`` runs an rclpy program."""

from __future__ import annotations

import sys

from aionode.rclpy._program import main

main(sys.argv[1:])
