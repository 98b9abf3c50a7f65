"""A running launch description: its processes, timers and events, on top of a system."""

from __future__ import annotations

import asyncio
import os
import re
import sys
import tempfile
from collections.abc import Callable, Coroutine, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import yaml

from aionode.clock import SteadyClock
from aionode.errors import LaunchFileError
from aionode.interfaces.composition_interfaces.srv import LoadNode
from aionode.interfaces.lifecycle_msgs.msg import Transition, TransitionEvent
from aionode.interfaces.lifecycle_msgs.srv import ChangeState
from aionode.launch._evaluation import (
    description_of_text,
    evaluate,
    failure_of,
    load_description,
)
from aionode.launch._process_events import ProcessEvents
from aionode.launch.plan import (
    Call,
    Completed,
    Component,
    Emit,
    LoadNodes,
    Log,
    ParameterValues,
    Process,
    Step,
    Timer,
    Watch,
)
from aionode.parameter import Parameter
from launch.event import Event
from launch.event_handler import entities_of
from launch.event_handlers import OnProcessIO
from launch.events import ExecutionComplete, Shutdown
from launch.events.process import (
    ProcessTargetedEvent,
    ShutdownProcess,
    SignalProcess,
)
from launch_ros.actions import LifecycleNode
from launch_ros.events import lifecycle

if TYPE_CHECKING:
    from aionode.system import Member, System
    from launch.launch_context import LaunchContext
    from launch.launch_service import LaunchService

__all__ = ["RunningLaunch", "description_of_text", "first_of", "run_service"]


NODE_LIMIT_SEC: Final = 30.0
"""Maximum time from the start of a process until its node is in the graph, in seconds. It is long,
as the machine may be busy; a process that ends before its node appears is noticed at once.
"""


class RunningLaunch:
    """Runs a launch description.

    Args:
        system: The system that its processes and nodes are added to.
        waits_for_nodes: Whether a process is ready only when its node is in the graph.
        stays: Whether it goes on when nothing is running any more, until a shutdown is requested.

    Attributes:
        begun: Set when the first steps are done, so that the processes and nodes are members.
    """

    def __init__(
        self, system: System, *, waits_for_nodes: bool = False, stays: bool = False
    ) -> None:
        self.system = system
        self.waits_for_nodes = waits_for_nodes
        self.stays = stays
        self.begun = asyncio.Event()
        self.members: dict[Any, Member] = {}
        """The last process that each action started."""
        self._watches: list[Watch] = []
        self._events: asyncio.Queue[Event] = asyncio.Queue()
        self._clock = SteadyClock()
        self._work: set[asyncio.Task[None]] = set()
        """Work that may still start something: timers, requests, running processes."""
        self._work_of: dict[Any, asyncio.Task[None]] = {}
        """The last work that each action started."""
        self._ends: dict[asyncio.Task[None], Event] = {}
        """The event reported to handlers when work has ended."""
        self._hears_output = False
        self._idle = asyncio.Event()
        self._is_shutdown = False

    async def run(self, steps: Iterable[Step]) -> None:
        """Execute the steps until nothing is running any more or a shutdown is requested.

        Event handlers see a shutdown in any case, even if this is cancelled.

        Raises:
            LaunchFileError: An event handler or a timer cannot be evaluated.
        """
        with tempfile.TemporaryDirectory(prefix="aionode_launch_") as folder:
            self._folder = Path(folder)
            try:
                async with asyncio.TaskGroup() as self._tasks:
                    beside = [
                        self._tasks.create_task(self._handle_events()),
                        self._tasks.create_task(self._end_with_system()),
                    ]
                    self.carry_out(steps)
                    self.begun.set()
                    self._note_idle()
                    await self._idle.wait()
                    for task in beside:
                        task.cancel()
                    for task in self._work:
                        task.cancel()
            except BaseExceptionGroup as group:
                raise first_of(group) from None
            finally:
                if not self._is_shutdown:
                    self._dispatch(Shutdown(reason="the launch ends"))

    async def _end_with_system(self) -> None:
        """Shut down when the system is asked to end."""
        await self.system.end_requested()
        self._events.put_nowait(Shutdown(reason="the system ends"))

    def _spawn(self, work: Coroutine[Any, Any, None], action: Any = None) -> None:
        if self._is_shutdown:
            work.close()  # a task would be cancelled at once
            return
        task = self._tasks.create_task(work)
        self._work.add(task)
        if action is not None:
            self._work_of[action] = task
        task.add_done_callback(self._forget)

    def _forget(self, task: asyncio.Task[None]) -> None:
        self._work.discard(task)
        if (event := self._ends.pop(task, None)) is not None:
            self._events.put_nowait(event)
        self._note_idle()

    def _note_idle(self) -> None:
        if self._is_shutdown or not (self.stays or self._work or self._events.qsize()):
            self._idle.set()

    # Steps

    def carry_out(self, steps: Iterable[Step]) -> None:
        """Execute steps: start processes, timers and handlers."""
        steps = list(steps)
        self._hears_output |= any(
            isinstance(step, Watch) and isinstance(step.handler, OnProcessIO) for step in steps
        )
        does: dict[type[Step], Callable[[Any], object]] = {
            Call: lambda step: self._spawn(self._call(step), step.action),
            Completed: self._note_completed,
            Emit: lambda step: self._events.put_nowait(step.event),
            LoadNodes: self._load,
            Log: lambda step: self.system.log.note(step.text),
            Process: self._start,
            Timer: lambda step: self._spawn(self._wait_for(step), step.action),
            Watch: self._watch,
        }
        for step in steps:
            does[type(step)](step)

    def add(self, entities: Iterable[Any], context: LaunchContext) -> None:
        """Evaluate and execute entities at run time; an error in them ends the launch."""

        async def work() -> None:
            self.carry_out(evaluate(entities, context))

        self._spawn(work())

    def _watch(self, step: Watch) -> None:
        """Register or unregister an event handler."""
        if step.ends:
            self._watches = [watch for watch in self._watches if watch.handler != step.handler]
        else:
            self._watches.insert(0, step)

    def _start(self, step: Process) -> None:
        """Start a process, and follow it."""
        from aionode.system import NodeExists  # a heavy import, which --print does not need

        if self._is_shutdown:
            return
        argv = self._written(step)
        if step.shell:
            argv = ["/bin/sh", "-c", " ".join(argv)]
        name = step.node_name
        is_awaited = self.waits_for_nodes and name is not None
        retries = step.respawn_max_retries
        events = ProcessEvents(step, argv, self._events.put_nowait)
        member = self.system.process(
            step.name,
            argv,
            # The rest is up to the system, whose processes join the domain of its context.
            env=step.changes(os.environ),
            cwd=step.cwd,
            terminal=step.emulate_tty,
            on_output=self._listener(step, events),
            restart="always" if step.respawn else "never",
            min_delay_sec=step.respawn_delay_sec or 0.5,
            max_restarts=None if retries < 0 else retries,
            ready=NodeExists(name, NODE_LIMIT_SEC) if is_awaited and name is not None else None,
            term_after_sec=step.term_after_sec,
            kill_after_sec=step.kill_after_sec,
        )
        self.members[step.action] = member
        if isinstance(step.action, LifecycleNode):
            self._spawn(self._follow_states(step.action))
            if step.autostart:
                self._spawn(self._activate(step.action.node_name))
        self._spawn(self._follow(member, events), step.action)

    def _listener(
        self, step: Process, events: ProcessEvents
    ) -> Callable[[bytes, int], object] | None:
        """Return the listener for a process's output; None if no handler wants it."""
        listeners: list[Callable[[bytes, int], object]] = []
        if step.on_output is not None:
            listeners.append(step.on_output)
        if self._hears_output:
            listeners.append(events.note_output)

        def listen(output: bytes, stream: int) -> None:
            for listener in listeners:
                listener(output, stream)

        return listen if listeners else None

    def _written(self, step: Process) -> list[str]:
        """Return the command line, with its parameters written to files."""
        argv: list[str] = []
        for number, word in enumerate(step.argv):
            if isinstance(word, ParameterValues):
                file = self._folder / f"{step.name}_{number}.yaml"
                file.write_text(yaml.safe_dump(word.content), encoding="utf-8")
                argv.append(str(file))
            else:
                argv.append(word)
        return argv

    async def _follow(self, member: Member, events: ProcessEvents) -> None:
        """Report each start and end of a process to the event handlers."""
        while True:
            events.look(member)
            if member.is_over() and not self.stays:
                return
            await self.system.changed()

    async def _wait_for(self, step: Timer) -> None:
        await self._clock.sleep(step.period_sec)
        if not (step.is_canceled() or self._is_shutdown):
            self.carry_out(evaluate(step.entities, step.context))

    async def _call(self, step: Call) -> None:
        """Run a coroutine; steps that it adds to its context are executed at once."""
        step.context.steps = AtOnce(self.carry_out)
        try:
            await step.run(step.context)
        except Exception as error:
            raise failure_of(step.action, error) from error

    def _note_completed(self, step: Completed) -> None:
        """Report the completion of an action to the event handlers, if one wants it."""
        event = ExecutionComplete(action=step.action)
        if any(watch.handler.matches(event) for watch in self._watches):
            work = self._work_of.get(step.action)
            if work is None or work.done():
                self._events.put_nowait(event)
            else:
                self._ends[work] = event

    # Events

    async def _handle_events(self) -> None:
        while True:
            event = await self._events.get()
            self._dispatch(event)
            self._note_idle()

    def _dispatch(self, event: Event) -> None:
        """Dispatch an event to the handlers, newest first, and execute what they return."""
        if isinstance(event, Shutdown):
            self._is_shutdown = True
            self.system.log.note(f"shutdown: {event.reason}")
        for watch in list(self._watches):
            if watch not in self._watches or not watch.handler.matches(event):
                continue
            context = watch.context.fork()
            context.is_shutdown = self._is_shutdown
            entities = entities_of(watch.handler.handle(event, context))
            self.carry_out([*evaluate(entities, context)])
        if isinstance(event, ProcessTargetedEvent):
            self._ask_processes(event)
        if isinstance(event, lifecycle.ChangeState):
            self._ask_managed(event)

    def _ask_processes(self, event: ProcessTargetedEvent) -> None:
        for action, member in self.members.items():
            if member.pid is None or not event.process_matcher(action):
                continue
            if isinstance(event, ShutdownProcess):
                self._spawn(self.system.stop(member.name))
            elif isinstance(event, SignalProcess):
                os.kill(member.pid, event.signal)

    # Managed nodes

    def _ask_managed(self, event: lifecycle.ChangeState) -> None:
        for action in self.members:
            if isinstance(action, LifecycleNode) and event.lifecycle_node_matcher(action):
                self._spawn(self._change_state(action.node_name, event.transition_id))

    async def _change_state(self, node_name: str, transition_id: int) -> None:
        """Request a transition of a managed node, once it answers."""
        node = self.system.graph_node
        client = node.create_client(ChangeState, f"{node_name}/change_state")
        try:
            while not await client.wait_for_service(timeout_sec=5.0):
                self.system.log.note(f"waiting for the managed node {node_name}")
            request = ChangeState.Request()
            request.transition.id = transition_id
            response = await client.call(request)
        finally:
            client.destroy()
        if not response.success:
            self.system.log.note(f"{node_name} has not made transition {transition_id}")

    async def _activate(self, node_name: str) -> None:
        """Configure and activate a managed node, once it answers."""
        await self._change_state(node_name, Transition.TRANSITION_CONFIGURE)
        await self._change_state(node_name, Transition.TRANSITION_ACTIVATE)

    async def _follow_states(self, action: LifecycleNode) -> None:
        """Report each transition of a running managed node to the event handlers."""
        member = self.members[action]

        def tell(message: TransitionEvent) -> None:
            self._events.put_nowait(lifecycle.StateTransition(action=action, msg=message))

        topic = f"{action.node_name}/transition_event"
        subscription = self.system.graph_node.create_subscription(TransitionEvent, topic, tell, 10)
        try:
            while not member.is_over():
                await self.system.changed()
        finally:
            subscription.destroy()

    # Nodes of containers

    def _load(self, step: LoadNodes) -> None:
        """Load the nodes of a container; classes of aionode run as tasks of this process."""
        foreign = [component for component in step.components if not component.is_aionode]
        for component in step.components:
            if component.is_aionode:
                self._add_node(component)
        if foreign:
            self._spawn(self._load_foreign(step.container, foreign))

    def _add_node(self, component: Component) -> None:
        name = component.name or snake_case(component.plugin.rpartition(":")[2])
        member = self.system.node(
            name,
            component.plugin,
            parameters=component.parameters or None,
            remappings=component.remappings or None,
            namespace=component.namespace,
        )
        self._spawn(self._until_ended(member))

    async def _until_ended(self, member: Member) -> None:
        while not member.is_over():
            await self.system.changed()

    async def _load_foreign(self, container: str, components: list[Component]) -> None:
        """Load nodes into another program's container, one at a time."""
        node = self.system.graph_node
        client = node.create_client(LoadNode, f"{container}/_container/load_node")
        try:
            while not await client.wait_for_service(timeout_sec=5.0):
                self.system.log.note(f"waiting for the container {container}")
            for component in components:
                response = await client.call(load_request(component))
                done = f"loaded {response.full_node_name or component.plugin}"
                failed = f"cannot load {component.plugin}: {response.error_message}"
                self.system.log.note(f"{container}: {done if response.success else failed}")
        finally:
            client.destroy()


async def run_service(service: LaunchService) -> int:
    """Run a `LaunchService`'s description; return 0, or 1 if it cannot be evaluated."""
    from aionode.system import System  # as above

    context = service.context
    context.load_file = load_description

    def take() -> list[Any]:
        included, service.included = service.included, []
        return included

    try:
        async with System() as system:
            running = RunningLaunch(system, stays=not service.shuts_down_when_idle)
            service.wake = lambda: running.add(take(), context)
            await running.run(evaluate(take(), context))
    except LaunchFileError as error:
        sys.stderr.write(f"{error}\n")
        return 1
    return 0


class AtOnce(list[Step]):
    """The steps of a context at run time; each is executed as it is added."""

    def __init__(self, carry_out: Callable[[list[Step]], object]) -> None:
        self._carry_out = carry_out

    def append(self, step: Step) -> None:
        """Execute a step."""
        self._carry_out([step])


def first_of(error: BaseException) -> BaseException:
    """Unwrap the error of a task group; the first error ended the other tasks."""
    while isinstance(error, BaseExceptionGroup):
        error = error.exceptions[0]
    return error


def load_request(component: Component) -> LoadNode.Request:
    """Return the request that loads a node into a container."""

    def messages(values: dict[str, Any]) -> list[Any]:
        return [Parameter(name, value=value).to_parameter_msg() for name, value in values.items()]

    return LoadNode.Request(
        package_name=component.package,
        plugin_name=component.plugin,
        node_name=component.name or "",
        node_namespace=component.namespace or "",
        remap_rules=[f"{source}:={target}" for source, target in component.remappings],
        parameters=messages(component.parameters),
        extra_arguments=messages(component.extra_arguments),
    )


def snake_case(name: str) -> str:
    """Convert a class name to a node name: ``WordCounter`` to ``word_counter``."""
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower()
