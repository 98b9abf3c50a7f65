"""Shows the blackboard of another process in the terminal, or lists its variables."""

from __future__ import annotations

import argparse
import sys
from typing import Any

from py_trees import console
from std_msgs.msg import String

import rclpy
from py_trees_ros import exceptions, utilities
from py_trees_ros.blackboard import BlackboardWatcher
from rclpy.executors import ExternalShutdownException

__all__ = ["command_line_argument_parser", "main", "pretty_print_variables"]

SETUP_SEC = 2.0


def command_line_argument_parser(formatted_for_sphinx: bool = True) -> argparse.ArgumentParser:
    """Return the parser of the arguments."""
    parser = argparse.ArgumentParser(prog="py-trees-blackboard-watcher", description=__doc__)
    parser.add_argument("-l", "--list", action="store_true", help="list the names of variables")
    parser.add_argument(
        "-a", "--activity", action="store_true", help="show who read and wrote the variables"
    )
    parser.add_argument(
        "-v",
        "--visited",
        action="store_true",
        help="show only variables that behaviours of the last tick use",
    )
    parser.add_argument(
        "-n", "--namespace", help="a text in the services' names, if there are several trees"
    )
    parser.add_argument(
        "variables",
        nargs=argparse.REMAINDER,
        help="what to show, such as odometry.pose.pose; everything by default",
    )
    return parser


def pretty_print_variables(variables: list[str]) -> None:
    """Print names, with fields indented below their variable."""
    print(f"\n{console.bold}{console.cyan}Blackboard Variables:{console.reset}{console.yellow}")
    for variable in variables:
        parts = variable.split(".")
        print(f"{'    ' * len(parts)}{'.' if len(parts) > 1 else ''}{parts[-1]}")
    print(console.reset)


def answer_of(watcher: BlackboardWatcher, key: str, **fields: Any) -> Any:
    """Return the response of a service of the other process."""
    request, client = watcher.create_service_client(key)
    for name, value in fields.items():
        setattr(request, name, value)
    future = client.call_async(request)
    rclpy.spin_until_future_complete(watcher.node, future, timeout_sec=utilities.SERVER_SEC)
    watcher.node.destroy_client(client)
    if not future.done() or future.result() is None:
        raise exceptions.ServiceError(f"service call failed [{watcher.service_names[key]}]")
    return future.result()


def main(command_line_args: list[str] | None = None) -> None:
    """List the variables, or show them until Ctrl-C."""
    args = command_line_argument_parser().parse_args(command_line_args)
    rclpy.init()
    watcher = BlackboardWatcher(namespace_hint=args.namespace)
    try:
        watcher.setup(timeout_sec=SETUP_SEC)
        if args.list:
            pretty_print_variables(answer_of(watcher, "list").variables)
            return
        opened = answer_of(
            watcher,
            "open",
            variables=[variable.strip(",[]") for variable in args.variables],
            filter_on_visited_path=args.visited,
            with_activity_stream=args.activity,
        )
        watcher.node.create_subscription(
            String,
            opened.topic,
            watcher.echo_blackboard_contents,
            utilities.qos_profile_unlatched(),
        )
        rclpy.spin(watcher.node)
    except exceptions.MultipleFoundError as error:
        sys.exit(f"{console.red}ERROR: {error}; select one with --namespace{console.reset}")
    except (
        exceptions.NotFoundError,
        exceptions.NotReadyError,
        exceptions.ServiceError,
        exceptions.TimedOutError,
    ) as error:
        sys.exit(f"{console.red}ERROR: {error}{console.reset}")
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        watcher.shutdown()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
