"""Tests that a program sees only the documented names of a node and its context."""

from __future__ import annotations

import inspect

import pytest

from aionode import Context, Node, Supervisor
from aionode.engine.transport.local import LocalTransport
from aionode.lifecycle import LifecycleNode
from aionode.testing import FaultyTransport, ManualClock, local_context

LIFETIME = """
context destroy_node destroyed ended get_clock get_fully_qualified_name get_logger get_name
get_namespace graph is_running resolve_service_name resolve_topic_name run until_destroyed
"""
ENTITIES = """
clients create_action_client create_action_server create_client create_publisher create_rate
create_service create_subscription create_timer destroy_client destroy_publisher destroy_rate
destroy_service destroy_subscription destroy_timer publishers services subscriptions timers
"""
PARAMETERS = """
add_on_set_parameters_callback add_post_set_parameters_callback add_pre_set_parameters_callback
declare_parameter declare_parameters declare_struct describe_parameter describe_parameters
get_parameter get_parameter_or get_parameter_type get_parameter_types get_parameters
get_parameters_by_prefix has_parameter list_parameters remove_on_set_parameters_callback
remove_post_set_parameters_callback remove_pre_set_parameters_callback set_descriptor
set_parameters set_parameters_atomically undeclare_parameter
"""
GRAPH = """
count_clients count_publishers count_services count_subscribers find_action
find_message find_service find_type
get_action_client_names_and_types_by_node get_action_names_and_types
get_action_server_names_and_types_by_node get_client_names_and_types_by_node
get_fully_qualified_node_names get_node_names get_node_names_and_namespaces
get_node_names_and_namespaces_with_enclaves get_publisher_names_and_types_by_node
get_publishers_info_by_topic get_service_names_and_types get_service_names_and_types_by_node
get_subscriber_names_and_types_by_node get_subscriptions_info_by_topic get_topic_names_and_types
wait_for_node
"""
NODE = LIFETIME + ENTITIES + PARAMETERS + GRAPH
LIFECYCLE = """
add_managed_entity create_lifecycle_publisher create_lifecycle_service
create_lifecycle_subscription create_lifecycle_timer destroy_lifecycle_publisher lifecycle_events
lifecycle_state on_activate on_cleanup on_configure on_deactivate on_error on_shutdown
report_progress trigger_activate trigger_cleanup trigger_configure trigger_deactivate
trigger_shutdown
"""
CONTEXT = """
add_reporter arguments as_default causes default domain_id dropped drops graph network new_uuid ok
participant report ros_distro seed shutdown time_base transports
"""
TRANSPORT = """
abandon all_known close create_node create_reader create_requester create_server create_writer
drops link_status observe open other_domains send_rest silent_processes tell
"""


def public_names(subject: object) -> list[str]:
    """Return the attributes that code completion offers."""
    return [name for name in dir(subject) if not name.startswith("_")]


@pytest.mark.parametrize(
    ("subject", "documented"),
    [
        (Node("node", context=local_context()), NODE),
        (LifecycleNode("node", context=local_context()), NODE + LIFECYCLE),
        (local_context(), CONTEXT),
        (Supervisor(lambda: Node("node")), "health node run"),
        (
            ManualClock(),
            "advance call_at jump now slice_ns stall steady_ns system_ns through_suspend",
        ),
        (FaultyTransport(LocalTransport()), TRANSPORT + "delay drop duplicate inner reorder"),
    ],
    ids=lambda value: "" if isinstance(value, str) else type(value).__name__,
)
def test_a_program_sees_the_documented_names_only(subject: object, documented: str) -> None:
    """Names for other parts of aionode begin with an underscore, so completion omits them."""
    assert public_names(subject) == sorted(documented.split())


def test_the_list_of_the_context_is_that_of_the_class() -> None:
    """The attributes of an instance are those that the docstring lists."""
    attributes = set(public_names(local_context())) - set(public_names(Context))

    assert all(f"\n    {name}: " in inspect.cleandoc(Context.__doc__ or "") for name in attributes)
