"""Shows the tree of another process in the terminal."""

from __future__ import annotations

import argparse
import sys

from py_trees import console
from py_trees.common import Duration

import rclpy
from py_trees_ros import exceptions, trees
from rclpy.executors import ExternalShutdownException

__all__ = ["command_line_argument_parser", "main"]

SETUP_SEC = 5.0
PERIOD_SEC = 2.0


def command_line_argument_parser(formatted_for_sphinx: bool = True) -> argparse.ArgumentParser:
    """Return the parser of the arguments."""
    parser = argparse.ArgumentParser(prog="py-trees-tree-watcher", description=__doc__)
    parser.add_argument(
        "topic_name",
        nargs="?",
        help="the topic of snapshots to show; by default, the tree's node opens one",
    )
    parser.add_argument(
        "-n", "--namespace-hint", help="a text in the services' names, if there are several trees"
    )
    parser.add_argument(
        "-a",
        "--blackboard-activity",
        action="store_true",
        help="show who read and wrote the blackboard",
    )
    parser.add_argument(
        "-b", "--blackboard-data", action="store_true", help="show the variables of the last tick"
    )
    parser.add_argument(
        "-s", "--statistics", action="store_true", help="show the times of the ticks"
    )
    modes = parser.add_mutually_exclusive_group()
    for option, mode, text in (
        ("--snapshots", trees.WatcherMode.SNAPSHOTS, "print each snapshot, which is the default"),
        ("--dot-graph", trees.WatcherMode.DOT_GRAPH, "draw the tree once"),
    ):
        modes.add_argument(option, dest="mode", action="store_const", const=mode, help=text)
    parser.set_defaults(mode=trees.WatcherMode.SNAPSHOTS)
    return parser


def main(command_line_args: list[str] | None = None) -> None:
    """Show the tree until Ctrl-C, or until a drawn one is closed."""
    args = command_line_argument_parser().parse_args(command_line_args)
    is_timed = args.statistics or args.blackboard_data or args.blackboard_activity
    watcher = trees.Watcher(
        namespace_hint=args.namespace_hint,
        topic_name=args.topic_name,
        parameters=trees.SnapshotStream.Parameters(
            blackboard_data=args.blackboard_data,
            blackboard_activity=args.blackboard_activity,
            snapshot_period=PERIOD_SEC if is_timed else Duration.INFINITE,
        ),
        mode=args.mode,
        statistics=args.statistics,
    )
    rclpy.init()
    try:
        watcher.setup(timeout_sec=SETUP_SEC)
        while not watcher.done and rclpy.ok():
            rclpy.spin_once(watcher.node, timeout_sec=0.1)
        if watcher.xdot_process is not None:
            watcher.xdot_process.wait()
    except exceptions.MultipleFoundError as error:
        sys.exit(f"{console.red}ERROR: {error}; select one with --namespace-hint{console.reset}")
    except (exceptions.NotFoundError, exceptions.TimedOutError) as error:
        sys.exit(f"{console.red}ERROR: {error}{console.reset}")
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        watcher.shutdown()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
