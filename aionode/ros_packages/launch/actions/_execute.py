"""Actions that start processes."""

from __future__ import annotations

import os
import re
import shlex
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, Final

from aionode._packages import is_terminal, is_window
from aionode.launch.plan import Log, ParameterValues, Process
from launch.action import Action
from launch.descriptions import Executable
from launch.event_handlers import OnProcessExit
from launch.launch_context import LaunchContext
from launch.substitution import (
    SomeSubstitutionsType,
    perform_substitutions,
    text_of,
)
from launch.substitutions import program_of
from launch.utilities.type_utils import perform_typed_substitution

__all__ = ["ExecuteLocal", "ExecuteProcess"]

WITHOUT_TERMINAL: Final = (
    "{}: its terminal '{}' is missing, so it runs without one; if it reads keys, run it in a "
    "terminal of your own instead"
)


class ExecuteLocal(Action):
    """Starts a process."""

    def __init__(
        self,
        *,
        process_description: Executable,
        shell: bool = False,
        output: SomeSubstitutionsType = "log",
        on_exit: Any = None,
        respawn: Any = False,
        respawn_delay: float | None = None,
        respawn_max_retries: int = -1,
        sigterm_timeout: Any = None,
        sigkill_timeout: Any = None,
        emulate_tty: bool = False,
        output_format: str | None = None,
        cached_output: bool = False,
        log_cmd: bool = False,
        condition: Any = None,
    ) -> None:
        super().__init__(condition=condition)
        self.process_description = process_description
        self.shell = shell
        self.output = output
        self._ExecuteLocal__on_exit = on_exit
        self._ExecuteLocal__respawn = respawn
        self._ExecuteLocal__respawn_delay = respawn_delay
        self._ExecuteLocal__respawn_max_retries = respawn_max_retries
        self.sigterm_timeout = sigterm_timeout
        self.sigkill_timeout = sigkill_timeout
        self.emulate_tty = emulate_tty
        self._ExecuteLocal__cached_output = cached_output
        self._ExecuteLocal__log_cmd = log_cmd
        self._ExecuteLocal__cached = {1: bytearray(), 2: bytearray()}
        self.process_details: dict[str, Any] | None = None
        """Details of the process while it runs: name, cmd, pid, …."""
        self.return_code: int | None = None

    def _ExecuteLocal__arguments_of_ros(
        self, context: LaunchContext
    ) -> list[str | ParameterValues]:
        """Return the arguments that follow those of the description."""
        return []

    def _ExecuteLocal__executable_words(self, context: LaunchContext) -> list[str]:
        """Return the program and its arguments; what is wrong with the program comes first."""
        program, *rest = self.process_description.cmd
        words = self._ExecuteLocal__program_words(context, program)
        return [*words, *(perform_substitutions(context, word) for word in rest)]

    def _ExecuteLocal__program_words(self, context: LaunchContext, program: list[Any]) -> list[str]:
        """Return the path of the program, or the command that starts it.

        Raises:
            PackageNotFoundError: It is a window that is not here.
        """
        # An executable of a package that is not built is a command rather than a path.
        command = getattr(program[0], "_ExecutableInPackage__command", None)
        if len(program) == 1 and callable(command):
            return list(command(context))
        word = perform_substitutions(context, program)
        name = Path(word.partition(" ")[0]).name  # a line for the shell is one word
        if is_window(name) and program_of(name, context) is None:
            raise context.packages.not_found(name)
        return [word]

    def _ExecuteLocal__program_name(self, context: LaunchContext, words: list[str]) -> str:
        """Return the name of the program, from which the process gets its name."""
        names = getattr(self.process_description.cmd[0][0], "_ExecutableInPackage__names", None)
        return str(names(context)[1]) if callable(names) else Path(words[0]).name

    def _ExecuteLocal__node_name_in(self, context: LaunchContext) -> str | None:
        """Return the full name of the process's node, if known."""
        return None

    def _ExecuteLocal__autostarts(self, context: LaunchContext) -> bool:
        """Return whether it is a managed node that is configured and activated automatically."""
        return False

    def execute(self, context: LaunchContext) -> None:
        """Record what to start."""
        described = self.process_description
        words = self._ExecuteLocal__executable_words(context)
        program = self._ExecuteLocal__program_name(context, words)
        prefix = self._ExecuteLocal__prefix(context, program)
        argv = [*prefix, *words, *self._ExecuteLocal__arguments_of_ros(context)]
        if self._ExecuteLocal__log_cmd:
            shown = [str(getattr(word, "content", word)) for word in argv]
            context.steps.append(Log(f"process details: cmd='{shlex.join(shown)}'"))
        base = Path(prefix[0]).name if prefix else program
        if described.name is not None:
            base = perform_substitutions(context, described.name)
        if self._ExecuteLocal__on_exit is not None:
            handler = OnProcessExit(target_action=self, on_exit=self._ExecuteLocal__on_exit)
            context.register_event_handler(handler)
        context.steps.append(
            Process(
                action=self,
                name=context.unique_name(base),
                argv=argv,
                env=self._ExecuteLocal__environment(context),
                cwd=None
                if described.cwd is None
                else perform_substitutions(context, described.cwd),
                where=self._LaunchDescriptionEntity__where,
                node_name=self._ExecuteLocal__node_name_in(context),
                shell=self.shell,
                respawn=bool(
                    perform_typed_substitution(context, self._ExecuteLocal__respawn, bool)
                ),
                respawn_delay_sec=self._ExecuteLocal__respawn_delay or 0.0,
                respawn_max_retries=self._ExecuteLocal__respawn_max_retries,
                output=self._ExecuteLocal__output(context),
                **self._ExecuteLocal__limits(context),
                on_output=self._ExecuteLocal__note_output
                if self._ExecuteLocal__cached_output
                else None,
                emulate_tty=self._ExecuteLocal__emulates_tty(context),
                autostart=self._ExecuteLocal__autostarts(context),
            )
        )

    def _ExecuteLocal__limits(self, context: LaunchContext) -> dict[str, float]:
        """Return the signal timeouts that are set, in seconds."""
        times = {}
        for name, option in (("sigterm", "term_after_sec"), ("sigkill", "kill_after_sec")):
            configured = context.launch_configurations.get(f"{name}_timeout")
            given = getattr(self, f"{name}_timeout")
            given = configured if given is None else given
            if given is not None:
                times[option] = self._ExecuteLocal__number(context, f"{name}_timeout", given)
        return times

    def _ExecuteLocal__number(self, context: LaunchContext, name: str, given: Any) -> float:
        try:
            return float(perform_typed_substitution(context, given, float))
        except ValueError as error:
            raise ValueError(f"{name}: {error}; use a number of seconds") from None

    def _ExecuteLocal__emulates_tty(self, context: LaunchContext) -> bool:
        given = context.launch_configurations.get("emulate_tty", self.emulate_tty)
        return bool(perform_typed_substitution(context, given, bool))

    def _ExecuteLocal__prefix(self, context: LaunchContext, program: str) -> list[str]:
        """Return the command prefixed to the program, such as ``gdb --args``."""
        described = self.process_description
        if described.prefix is not None:
            prefix = shlex.split(perform_substitutions(context, described.prefix))
        elif re.match(str(context.launch_configurations.get("launch-prefix-filter", "")), program):
            prefix = shlex.split(str(context.launch_configurations.get("launch-prefix", "")))
        else:
            prefix = []
        if prefix and is_terminal(prefix[0]) and program_of(prefix[0], context) is None:
            context.steps.append(Log(WITHOUT_TERMINAL.format(program, prefix[0]), "WARN"))
            return []
        return prefix

    def _ExecuteLocal__environment(self, context: LaunchContext) -> dict[str, str]:
        described = self.process_description

        def texts(pairs: Mapping[Any, Any]) -> dict[str, str]:
            return {
                text_of(context, name): text_of(context, value) for name, value in pairs.items()
            }

        base = context.environment if described.env is None else texts(described.env)
        return {**base, **texts(described.additional_env or {})}

    def _ExecuteLocal__output(self, context: LaunchContext) -> str:
        if isinstance(self.output, Mapping):
            return ",".join(f"{name}={value}" for name, value in self.output.items())
        return text_of(context, self.output)

    def describe(self) -> str:
        """Return the program, and the file that defines the action."""
        return f"{type(self).__name__} of {os.path.basename(self._LaunchDescriptionEntity__where)}"  # noqa: PTH119  # with the line

    def _ExecuteLocal__note_output(self, output: bytes, stream: int) -> None:
        """Keep output of the process: 1 is standard output, 2 is standard error."""
        self._ExecuteLocal__cached[stream] += output

    def get_stdout(self) -> str:
        """Return the process's standard output so far.

        Raises:
            RuntimeError: The action has no ``cached_output=True``.
        """
        return self._ExecuteLocal__written_to(1)

    def get_stderr(self) -> str:
        """Return the process's standard error so far.

        Raises:
            RuntimeError: The action has no ``cached_output=True``.
        """
        return self._ExecuteLocal__written_to(2)

    def _ExecuteLocal__written_to(self, stream: int) -> str:
        if not self._ExecuteLocal__cached_output:
            raise RuntimeError("cached output must be true to be able to get output")
        return self._ExecuteLocal__cached[stream].decode(errors="replace")


class ExecuteProcess(ExecuteLocal):
    """Starts a command."""

    def __init__(
        self,
        *,
        cmd: Iterable[SomeSubstitutionsType],
        prefix: SomeSubstitutionsType | None = None,
        name: SomeSubstitutionsType | None = None,
        cwd: SomeSubstitutionsType | None = None,
        env: Mapping[Any, Any] | None = None,
        additional_env: Mapping[Any, Any] | None = None,
        **options: Any,
    ) -> None:
        described = Executable(
            cmd=cmd, prefix=prefix, name=name, cwd=cwd, env=env, additional_env=additional_env
        )
        super().__init__(process_description=described, **options)

    @property
    def cmd(self) -> list[Any]:
        """The words of the command."""
        return self.process_description.cmd

    @property
    def name(self) -> Any:
        """The name of the process."""
        return self.process_description.name
