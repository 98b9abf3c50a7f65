"""Managed nodes within one process."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine
from typing import Any, Literal

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from aionode import Node
from aionode.errors import (
    CallbackCancelledError,
    CallbackSignatureError,
    ServiceError,
    TransitionError,
)
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.lifecycle_msgs.msg import Transition, TransitionEvent
from aionode.interfaces.lifecycle_msgs.srv import ChangeState, GetAvailableTransitions, GetState
from aionode.interfaces.std_msgs.msg import String
from aionode.lifecycle import (
    LifecycleEvent,
    LifecycleNode,
    ManagedEntity,
    State,
    TransitionCallbackReturn,
)
from aionode.testing import ManualClock, local_context, settle

SUCCESS = TransitionCallbackReturn.SUCCESS
FAILURE = TransitionCallbackReturn.FAILURE
ERROR = TransitionCallbackReturn.ERROR


def runner_of(node: Any) -> Any:
    """Return the object that runs the transitions of a node."""
    return node._LifecycleNode__transitions


class Managed(LifecycleNode):
    """Returns, raises or awaits what a test wants, in any of its callbacks."""

    def __init__(self, **options: Any) -> None:
        super().__init__("managed", **options)
        self.outcomes: dict[str, Any] = {}
        self.calls: list[tuple[str, str]] = []
        self.error: Exception | None = None

    async def do(self, name: str, state: State, otherwise: Any) -> TransitionCallbackReturn:
        """Record the call, and do what the test wants."""
        self.calls.append((name, state.label))
        outcome = self.outcomes.get(name, otherwise)
        if isinstance(outcome, Exception):
            raise outcome
        if isinstance(outcome, asyncio.Event):
            await outcome.wait()
            return SUCCESS
        result: TransitionCallbackReturn = outcome() if callable(outcome) else outcome
        return result

    async def on_configure(self, state: State) -> TransitionCallbackReturn:
        """Do what the test wants."""
        return await self.do("configure", state, super().on_configure(state))

    async def on_activate(self, state: State) -> TransitionCallbackReturn:
        """Do what the test wants."""
        return await self.do("activate", state, super().on_activate(state))

    async def on_deactivate(self, state: State) -> TransitionCallbackReturn:
        """Do what the test wants."""
        return await self.do("deactivate", state, super().on_deactivate(state))

    async def on_cleanup(self, state: State) -> TransitionCallbackReturn:
        """Do what the test wants."""
        return await self.do("cleanup", state, super().on_cleanup(state))

    async def on_shutdown(self, state: State) -> TransitionCallbackReturn:
        """Do what the test wants."""
        return await self.do("shutdown", state, super().on_shutdown(state))

    async def on_error(
        self, state: State, error: Exception | None = None
    ) -> TransitionCallbackReturn:
        """Keep the error."""
        self.error = error
        return await self.do("error", state, FAILURE)


@pytest.fixture
async def managed(node_factory: Callable[..., Any]) -> Managed:
    """A managed node that runs."""
    node: Managed = node_factory(Managed)
    await settle()
    return node


async def test_a_node_goes_through_its_life(managed: Managed) -> None:
    """Each callback gets the state in which its transition started."""
    await managed.trigger_configure()
    await managed.trigger_activate()
    await managed.trigger_deactivate()
    await managed.trigger_cleanup()
    await managed.trigger_shutdown()

    assert managed.calls == [
        ("configure", "unconfigured"),
        ("activate", "inactive"),
        ("deactivate", "active"),
        ("cleanup", "inactive"),
        ("shutdown", "unconfigured"),
    ]
    assert managed.lifecycle_state == State("finalized", 4)


async def test_a_failure_returns_to_the_start(managed: Managed) -> None:
    """FAILURE is not an error: the node may be asked again."""
    managed.outcomes["configure"] = FAILURE

    assert await managed.trigger_configure() is FAILURE
    assert managed.lifecycle_state.label == "unconfigured"


async def test_an_exception_reaches_on_error_and_the_caller(managed: Managed) -> None:
    """With rclpy it is swallowed."""
    broken = OSError("no such camera")
    managed.outcomes["configure"] = broken
    managed.outcomes["error"] = SUCCESS

    with pytest.raises(TransitionError, match="cannot configure: OSError: no such camera") as info:
        await managed.trigger_configure()

    assert info.value.__cause__ is broken
    assert managed.error is broken
    assert managed.calls[-1] == ("error", "unconfigured")
    assert managed.lifecycle_state.label == "unconfigured"


async def test_an_error_that_is_not_put_right_finalizes(managed: Managed) -> None:
    """As the table says for a failed `on_error`."""
    managed.outcomes["configure"] = ERROR

    assert await managed.trigger_configure() is ERROR
    assert managed.lifecycle_state.label == "finalized"


async def test_an_error_without_on_error_makes_the_node_unconfigured(
    node_factory: Callable[..., Any],
) -> None:
    """As in rclpy, whose default asks the entities, which recover."""

    class Broken(LifecycleNode):
        def on_configure(self, state: State) -> TransitionCallbackReturn:
            return ERROR

    class Recovering(ManagedEntity):
        asked_in = ""

        def on_error(self, state: State) -> TransitionCallbackReturn:
            self.asked_in = state.label
            return SUCCESS

    broken: Any = node_factory(Broken, "broken")
    entity = Recovering()
    broken.add_managed_entity(entity)

    assert await broken.trigger_configure() is ERROR
    assert broken.lifecycle_state.label == "unconfigured"
    assert entity.asked_in == "unconfigured"


def test_something_that_is_no_managed_entity_is_refused() -> None:
    """With the class to derive from."""
    node = LifecycleNode("managed", context=local_context())

    with pytest.raises(TypeError, match="is not a managed entity; derive its class from"):
        node.add_managed_entity("camera")  # type: ignore[arg-type]


async def test_a_result_of_another_kind_is_an_error(managed: Managed) -> None:
    """With rclpy the node stays in `configuring` forever."""
    managed.outcomes["configure"] = lambda: None

    with pytest.raises(TransitionError, match="on_configure returned None; return Transition"):
        await managed.trigger_configure()

    assert managed.lifecycle_state.label == "finalized"


async def test_a_transition_from_another_state_names_those_there_are(managed: Managed) -> None:
    """The error says what fits."""
    with pytest.raises(
        TransitionError, match="available are: configure, shutdown; the node is unc"
    ):
        await managed.trigger_activate()


def test_a_callback_with_wrong_arguments_is_refused_when_the_node_is_made() -> None:
    """With rclpy the TypeError is swallowed when it is called."""

    class Wrong(LifecycleNode):
        def on_configure(self) -> TransitionCallbackReturn:  # type: ignore[override]
            return SUCCESS

    with pytest.raises(CallbackSignatureError, match=r"on_configure"):
        Wrong("wrong")


async def test_a_callback_may_call_services_of_its_own_node(
    node_factory: Callable[..., Any],
) -> None:
    """In rclpy that deadlocks."""

    class Asking(LifecycleNode):
        async def on_configure(self, state: State) -> TransitionCallbackReturn:
            client = self.create_client(AddTwoInts, "/add")
            response = await client.call(AddTwoInts.Request(a=1, b=2))
            return SUCCESS if response.sum == 3 else FAILURE

    asking = node_factory(Asking, "asking")
    asking.create_service(AddTwoInts, "/add", lambda request: AddTwoInts.Response(sum=3))
    await settle()

    assert await asking.trigger_configure() is SUCCESS


async def change(node: Node, label: str = "", transition_id: int = 0) -> bool:
    """Ask a managed node over its service."""
    client = node.create_client(ChangeState, "/managed/change_state")
    request = ChangeState.Request(transition=Transition(label=label, id=transition_id))
    return (await client.call(request)).success


async def state_of(node: Node) -> str:
    """Ask a managed node for its state."""
    client = node.create_client(GetState, "/managed/get_state")
    return (await client.call(GetState.Request())).current_state.label


async def test_get_state_answers_during_a_transition(node: Node, managed: Managed) -> None:
    """With rclpy it waits until the transition has ended."""
    managed.outcomes["configure"] = asyncio.Event()
    async with asyncio.TaskGroup() as tasks:
        changing = tasks.create_task(change(node, "configure"))
        await settle()
        assert await state_of(node) == "configuring"
        managed.outcomes["configure"].set()

    assert changing.result()
    assert await state_of(node) == "inactive"


async def test_an_unknown_request_is_refused_without_an_event(node: Node, managed: Managed) -> None:
    """Activating is not available yet, and 99 is not a number of a transition."""
    events = node.create_subscription(TransitionEvent, "/managed/transition_event")

    assert not await change(node, "activate")
    assert not await change(node, transition_id=99)
    await settle()
    assert events.stats.received == 0
    assert managed.calls == []


async def test_each_transition_publishes_two_events(node: Node, managed: Managed) -> None:
    """One leads into the transition state and one out of it, with labels and numbers."""
    events: list[tuple[str, str]] = []
    node.create_subscription(
        TransitionEvent,
        "/managed/transition_event",
        lambda msg: events.append((msg.start_state.label, msg.goal_state.label)),
    )
    await settle()

    await change(node, "configure")
    await settle()

    assert events == [("unconfigured", "configuring"), ("configuring", "inactive")]


async def test_another_request_cancels_a_transition(node: Node, managed: Managed) -> None:
    """`transition_failure` is what the table offers in `configuring`."""
    managed.outcomes["configure"] = asyncio.Event()
    async with asyncio.TaskGroup() as tasks:
        changing = tasks.create_task(change(node, "configure"))
        await settle()
        canceled = await change(node, "transition_failure")

    assert canceled
    assert not changing.result()
    assert managed.lifecycle_state.label == "unconfigured"


async def test_success_cannot_be_requested(node: Node, managed: Managed) -> None:
    """Only the callback decides whether the node is configured."""
    managed.outcomes["configure"] = asyncio.Event()
    async with asyncio.TaskGroup() as tasks:
        tasks.create_task(change(node, "configure"))
        await settle()
        assert not await change(node, "transition_success")
        assert managed.lifecycle_state.label == "configuring"
        managed.outcomes["configure"].set()


async def test_shutdown_cancels_what_is_under_way(node: Node, managed: Managed) -> None:
    """A shutdown need not wait for a camera."""
    managed.outcomes["configure"] = asyncio.Event()
    async with asyncio.TaskGroup() as tasks:
        tasks.create_task(change(node, "configure"))
        await settle()
        assert await change(node, transition_id=Transition.TRANSITION_UNCONFIGURED_SHUTDOWN)

    assert managed.lifecycle_state.label == "finalized"


async def test_a_shutdown_is_not_overtaken_by_another_attempt(node: Node, managed: Managed) -> None:
    """A program that tries until the camera is there starts again at the moment of the failure."""
    managed.outcomes["configure"] = asyncio.Event()

    async def try_again() -> None:
        while await managed.trigger_configure() is FAILURE:
            pass

    async with asyncio.TaskGroup() as tasks:
        trying = tasks.create_task(failure_of(try_again()))
        await settle()
        assert await change(node, "shutdown")

    assert "available are: shutdown" in str(trying.result())
    assert managed.lifecycle_state.label == "finalized"


async def failure_of(trying: Coroutine[Any, Any, None]) -> TransitionError:
    """Return the error with which something ends."""
    with pytest.raises(TransitionError) as info:
        await trying
    return info.value


async def test_an_exception_during_the_cancellation_is_an_error(
    node: Node, managed: Managed
) -> None:
    """A camera that does not close has to reach the log and `on_error`, as at any other time."""

    class Stuck(asyncio.Event):
        async def wait(self) -> Literal[True]:
            try:
                return await super().wait()
            except asyncio.CancelledError as error:
                raise OSError("the camera does not close") from error

    managed.outcomes["configure"] = Stuck()
    managed.outcomes["error"] = SUCCESS
    async with asyncio.TaskGroup() as tasks:
        changing = tasks.create_task(change(node, "configure"))
        await settle()
        await change(node, "transition_failure")

    assert not changing.result()
    assert managed.calls[-1] == ("error", "unconfigured")
    assert isinstance(managed.error, OSError)


async def test_the_cancellation_of_what_a_callback_awaits_is_an_error(
    node: Node, managed: Managed
) -> None:
    """A client that was destroyed is for `on_error`; the requester was told of a broken service."""
    lost: asyncio.Future[None] = asyncio.get_running_loop().create_future()
    lost.cancel()
    managed.outcomes["configure"] = lost.result
    managed.outcomes["error"] = SUCCESS

    assert not await change(node, "configure")
    assert managed.calls[-1] == ("error", "unconfigured")
    with pytest.raises(TransitionError) as info:
        await managed.trigger_configure()
    assert isinstance(info.value.__cause__, CallbackCancelledError)


async def test_the_end_of_a_node_cancels_its_transition(
    node: Node, node_factory: Callable[..., Any]
) -> None:
    """As Ctrl-C does: the callback may tidy up, and the state is a primary one."""
    managed: Managed = node_factory(Managed)
    managed.outcomes["configure"] = asyncio.Event()
    client = node.create_client(ChangeState, "/managed/change_state")
    call = client.call_async(ChangeState.Request(transition=Transition(label="configure")))
    await settle()
    assert managed.lifecycle_state.label == "configuring"

    managed.destroy_node()
    await settle()

    assert managed.lifecycle_state.label == "unconfigured"
    with pytest.raises(ServiceError):
        await call


async def test_a_timeout_cancels_a_transition(managed: Managed) -> None:
    """`asyncio.timeout` around `trigger_configure` leaves the node unconfigured."""
    managed.outcomes["configure"] = asyncio.Event()

    with pytest.raises(TimeoutError):
        async with asyncio.timeout(0.001):
            await managed.trigger_configure()

    assert managed.lifecycle_state.label == "unconfigured"


async def test_the_available_transitions_are_those_of_the_state(
    node: Node, managed: Managed
) -> None:
    """The graph has all of them."""
    available = node.create_client(GetAvailableTransitions, "/managed/get_available_transitions")
    graph = node.create_client(GetAvailableTransitions, "/managed/get_transition_graph")

    now = await available.call(GetAvailableTransitions.Request())
    every = await graph.call(GetAvailableTransitions.Request())

    assert [one.transition.label for one in now.available_transitions] == ["configure", "shutdown"]
    assert len(every.available_transitions) == 25


async def test_progress_is_told_while_a_transition_runs(managed: Managed) -> None:
    """A program can show how far a node is."""
    seen: list[LifecycleEvent] = []

    async def watch() -> None:
        async for event in managed.lifecycle_events():
            seen.append(event)  # noqa: PERF401  # it is looked at meanwhile

    def configure() -> TransitionCallbackReturn:
        managed.report_progress("loading the map", 0.5)
        return SUCCESS

    managed.outcomes["configure"] = configure
    watcher = asyncio.get_running_loop().create_task(watch())
    await settle()
    await managed.trigger_configure()
    await settle()
    watcher.cancel()

    assert [(event.state.label, event.progress, event.fraction) for event in seen] == [
        ("configuring", "", None),
        ("configuring", "loading the map", 0.5),
        ("inactive", "", None),
    ]


# Entities


async def test_a_publisher_sends_only_while_active(node: Node, managed: Managed) -> None:
    """Messages published before are dropped and counted."""
    publisher = managed.create_lifecycle_publisher(String, "/chatter", 10)
    heard: list[str] = []
    node.create_subscription(String, "/chatter", lambda msg: heard.append(msg.data))
    await managed.trigger_configure()
    publisher.publish(String(data="before"))
    await managed.trigger_activate()
    publisher.publish(String(data="while"))
    await managed.trigger_deactivate()
    publisher.publish(String(data="after"))
    await settle()

    assert heard == ["while"]
    assert publisher.discarded == 2


async def test_a_subscription_is_heard_only_while_active(node: Node, managed: Managed) -> None:
    """Its callback may be a coroutine."""
    heard: list[str] = []

    async def hear(msg: String) -> None:
        heard.append(msg.data)

    managed.create_lifecycle_subscription(String, "/chatter", hear)
    publisher = node.create_publisher(String, "/chatter", 10)
    publisher.publish(String(data="before"))
    await settle()
    await managed.trigger_configure()
    await managed.trigger_activate()
    publisher.publish(String(data="while"))
    await settle()

    assert heard == ["while"]


async def test_a_service_refuses_with_a_reason_while_inactive(node: Node, managed: Managed) -> None:
    """The client is told, and the node lives on."""
    managed.create_lifecycle_service(
        AddTwoInts, "/add", lambda request: AddTwoInts.Response(sum=request.a + request.b)
    )
    client = node.create_client(AddTwoInts, "/add")

    with pytest.raises(ServiceError, match="the node is not active; activate it first"):
        await client.call(AddTwoInts.Request(a=1, b=2))
    await managed.trigger_configure()
    await managed.trigger_activate()

    assert (await client.call(AddTwoInts.Request(a=1, b=2))).sum == 3


async def test_a_timer_runs_only_while_active(
    manual_clock: ManualClock, node_factory: Callable[..., Any]
) -> None:
    """An activation begins a new period."""
    managed: Managed = node_factory(Managed)
    ticks: list[int] = []
    managed.create_lifecycle_timer(1.0, lambda: ticks.append(1))
    await manual_clock.advance(2.0)
    await managed.trigger_configure()
    await managed.trigger_activate()
    await manual_clock.advance(2.5)
    await managed.trigger_deactivate()
    await manual_clock.advance(2.0)

    assert len(ticks) == 2


async def test_a_timer_of_an_active_node_can_be_reset_and_canceled(
    manual_clock: ManualClock, node_factory: Callable[..., Any]
) -> None:
    """It is the watchdog of managed wheels: each command resets it."""
    managed: Managed = node_factory(Managed)
    ticks: list[int] = []
    timer = managed.create_lifecycle_timer(1.0, lambda: ticks.append(1))
    await managed.trigger_configure()
    await managed.trigger_activate()
    for _ in range(3):
        await manual_clock.advance(0.9)
        timer.reset()
    assert ticks == []

    await manual_clock.advance(1.0)
    assert ticks == [1]

    timer.cancel()
    assert timer.is_canceled()
    await manual_clock.advance(5.0)
    timer.reset()
    await manual_clock.advance(1.0)
    assert ticks == [1, 1]


async def test_a_timer_of_a_node_that_is_not_active_is_not_reset(
    manual_clock: ManualClock, node_factory: Callable[..., Any]
) -> None:
    """The callback of a subscription may reset it in any state."""
    managed: Managed = node_factory(Managed)
    ticks: list[int] = []
    timer = managed.create_lifecycle_timer(1.0, lambda: ticks.append(1))
    timer.reset()
    await manual_clock.advance(2.0)

    assert ticks == []
    assert timer.is_canceled()


async def test_the_events_of_a_node_end_with_it(managed: Managed) -> None:
    """Whoever reads them would wait forever."""

    async def read() -> list[str]:
        return [event.state.label async for event in managed.lifecycle_events()]

    async with asyncio.TaskGroup() as tasks:
        reading = tasks.create_task(read())
        await settle()
        await managed.trigger_configure()
        managed.destroy_node()

    assert reading.result() == ["configuring", "inactive"]
    assert await read() == []


async def test_no_entity_stays_enabled_when_activation_fails(managed: Managed) -> None:
    """Although `super().on_activate` has enabled it before."""
    publisher = managed.create_lifecycle_publisher(String, "/chatter", 10)
    managed.outcomes["activate"] = FAILURE
    await managed.trigger_configure()
    await managed.trigger_activate()

    assert managed.lifecycle_state.label == "inactive"
    assert not publisher.is_activated


async def test_entities_are_enabled_again_when_deactivation_fails(managed: Managed) -> None:
    """The node is active still, so it works."""
    publisher = managed.create_lifecycle_publisher(String, "/chatter", 10)
    await managed.trigger_configure()
    await managed.trigger_activate()
    managed.outcomes["deactivate"] = FAILURE
    await managed.trigger_deactivate()

    assert managed.lifecycle_state.label == "active"
    assert publisher.is_activated


class Slow(LifecycleNode):
    """Awaits several times in each callback, `on_error` included."""

    failing = False

    async def work(self, state: State) -> TransitionCallbackReturn:
        """Await three times."""
        for _ in range(3):
            await asyncio.get_running_loop().run_in_executor(None, int)
        if self.failing:
            raise OSError("broken")
        return SUCCESS

    on_configure = on_activate = on_deactivate = on_cleanup = on_shutdown = work

    async def on_error(
        self, state: State, error: Exception | None = None
    ) -> TransitionCallbackReturn:
        """Await three times more."""
        self.failing = False
        return await self.work(state)


@settings(deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(
    st.lists(
        st.tuples(
            st.sampled_from(["configure", "activate", "deactivate", "cleanup", "shutdown"]),
            st.integers(0, 12),
            st.booleans(),
            st.sampled_from(["task", "failure", "error", "shutdown"]),
        ),
        max_size=8,
    )
)
def test_a_cancellation_at_any_await_leaves_a_primary_state(
    steps: list[tuple[str, int, bool, str]],
) -> None:
    """Wherever and however a transition is cut, the node is in a state from which it can go on."""

    async def run() -> None:
        async with local_context() as context, Slow("slow", context=context) as node:
            for label, turns, failing, how in steps:
                node.failing = failing
                task = asyncio.get_running_loop().create_task(getattr(node, f"trigger_{label}")())
                for _ in range(turns):
                    await asyncio.sleep(0)  # noqa: TID251  # counts turns of the loop
                if how == "task":
                    task.cancel()
                elif how == "shutdown":
                    await asyncio.gather(node.trigger_shutdown(), return_exceptions=True)
                else:
                    runner_of(node).cancel(FAILURE if how == "failure" else ERROR)
                await asyncio.gather(task, return_exceptions=True)
                assert not runner_of(node).machine.in_transition
                assert runner_of(node)._idle.is_set()

    asyncio.run(run())


async def test_two_hundred_transitions_while_topics_flow(node: Node, managed: Managed) -> None:
    """No state is lost, and none is stuck."""
    flowing = node.create_publisher(String, "/chatter", 10)
    managed.create_lifecycle_subscription(String, "/chatter", lambda msg: None)
    states = []
    for _ in range(50):
        for label in ("configure", "activate", "deactivate", "cleanup"):
            flowing.publish(String(data=label))
            assert await change(node, label)
            states.append(managed.lifecycle_state.label)

    assert states == ["inactive", "active", "inactive", "unconfigured"] * 50
