"""The main program: help, wrong arguments, one-line errors, output without a reader."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable

import click
import pytest

from aionode.cli import _main as command
from aionode.cli._main import NOUNS, main, root
from aionode.cli._support.error_text import one_line
from aionode.errors import AionodeError, CommandError, InvalidTopicNameException

VERBS = {
    "bag": {"burst", "convert", "info", "list", "play", "record", "reindex"},
    "action": {"find", "info", "list", "send_goal", "type"},
    "interface": {"generate", "list", "package", "packages", "proto", "show"},
    "node": {"info", "list"},
    "pkg": {"executables", "list", "prefix"},
    "param": {"delete", "describe", "dump", "get", "list", "load", "set"},
    "service": {"call", "find", "info", "list", "type"},
    "topic": {"bw", "delay", "echo", "find", "hz", "info", "list", "pub", "type"},
}


def commands() -> list[tuple[str, click.Command]]:
    """Return every command with its words."""
    commands: list[tuple[str, click.Command]] = []
    context = click.Context(root)
    for noun in NOUNS:
        of_noun = root.get_command(context, noun)
        assert of_noun is not None
        if isinstance(of_noun, click.Group):
            commands += [(f"{noun} {verb}", of_verb) for verb, of_verb in of_noun.commands.items()]
        else:
            commands.append((noun, of_noun))
    return commands


def group_of(noun: str) -> click.Group:
    """Return the group of the commands of a noun."""
    group = root.get_command(click.Context(root), noun)
    assert isinstance(group, click.Group)
    return group


def test_every_verb_of_ros2_is_there() -> None:
    """Users of ros2 type the same commands."""
    words = {words for words, _ in commands()}

    for noun, verbs in VERBS.items():
        assert {f"{noun} {verb}" for verb in verbs} <= words


def test_every_command_has_help(capsys: pytest.CaptureFixture[str]) -> None:
    """Both -h and --help, and a sentence about what it does."""
    for words, _ in commands():
        assert main([*words.split(), "-h"]) == 0

        help_text = capsys.readouterr().out
        assert help_text.startswith(f"Usage: aionode {words} ")
        _, sentence, *_ = help_text.split("\n\n")
        assert len(sentence.strip()) > 10, words


@pytest.mark.parametrize("words", [[], ["topic"]])
def test_no_verb_at_all_shows_what_there_is(
    words: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    """As in ros2; nothing went wrong."""
    assert main(words) == 0
    assert "Commands:" in capsys.readouterr().out


def test_every_command_that_prints_data_has_json() -> None:
    """Only commands that run, take keys, write programs, repair a bag or print code have none."""
    without = {
        words
        for words, of_verb in commands()
        if "--json" not in [name for parameter in of_verb.params for name in parameter.opts]
    }

    assert without == {
        "bag reindex",
        "completion",
        "deploy",
        "gateway types",
        "learn record",
        "new",
        "run",
        "teleop",
    }


def test_help_imports_neither_numpy_nor_zenoh() -> None:
    """Help has to appear at once."""
    program = (
        "import sys; from aionode.cli import main; main(['--help']); "
        "print([name for name in ('numpy', 'zenoh', 'rich', 'uvloop') if name in sys.modules])"
    )

    printed = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    ).stdout

    assert printed.splitlines()[-1] == "[]"


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["topic", "list", "--nope"], "aionode topic list: No such option '--nope'"),
        (["topic", "lst"], "aionode topic: No such command 'lst'"),
        (["topc"], "aionode: No such command 'topc'"),
        (["topic", "echo"], "aionode topic echo: Missing argument 'TOPIC_NAME'"),
        (["topic", "hz"], "aionode topic hz: Missing argument"),
        (["topic", "pub", "/a", "b", "-r", "0"], "aionode topic pub: Invalid value for '-r'"),
        (["topic", "pub", "/a", "b", "-1", "-t", "2"], "Give --once or --times, not both."),
        (["topic", "pub", "/a", "b", "--max-wait-time-secs", "2"], "--wait-matching-subs"),
        (["topic", "pub", "/a", "b", "{}", "--stdin"], "Give the values or --stdin, not both."),
        (["topic", "echo", "/a", "--qos-reliability", "much"], "'best_effort'"),
        (["interface", "show", "a/b", "--interfaces", "/no/folder"], "does not exist"),
        (["completion", "cmd"], "is not one of 'bash', 'zsh', 'fish'"),
    ],
)
def test_wrong_arguments_are_one_line_and_status_two(
    arguments: list[str], says: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """The line names the command whose help describes the arguments."""
    assert main(arguments) == 2

    printed = capsys.readouterr()
    assert printed.out == ""
    assert len(printed.err.splitlines()) == 1
    assert says in printed.err
    assert "--help'." in printed.err


@pytest.fixture
def failing(monkeypatch: pytest.MonkeyPatch) -> Callable[[BaseException], None]:
    """Make ``interface packages`` raise an error."""

    def fail_with(error: BaseException) -> None:
        def packages(**_: object) -> None:
            raise error

        monkeypatch.setattr(group_of("interface").commands["packages"], "callback", packages)

    return fail_with


@pytest.mark.parametrize(
    ("error", "status", "line"),
    [
        (CommandError("Unknown topic '/a'"), 1, "Unknown topic '/a'"),
        (CommandError("no", status=3), 3, "no"),
        (AionodeError("two\n  lines"), 1, "two; lines"),
        (
            InvalidTopicNameException("a b", "must not contain a blank", 1),
            1,
            "Invalid topic name 'a b': must not contain a blank, at character 2 (' ')",
        ),
    ],
)
def test_an_error_is_one_line_on_stderr(
    error: AionodeError,
    status: int,
    line: str,
    failing: Callable[[BaseException], None],
    capsys: pytest.CaptureFixture[str],
) -> None:
    """No traceback, and nothing on stdout."""
    failing(error)

    assert main(["interface", "packages"]) == status
    assert capsys.readouterr() == ("", f"{line}\n")


def test_a_noun_that_is_not_there_is_answered_with_a_similar_one(
    capsys: pytest.CaptureFixture[str],
) -> None:
    """As for options and verbs; nouns are imported late, so click does not know them."""
    assert main(["topc", "list"]) == 2
    assert capsys.readouterr().err == (
        "aionode: No such command 'topc'. Did you mean 'topic'? See 'aionode --help'.\n"
    )


def test_an_index_behind_the_end_is_left_out() -> None:
    """An empty name has no invalid character."""
    text = one_line(InvalidTopicNameException("", "must not be empty", 0))

    assert text == "Invalid topic name '': must not be empty"


def test_ctrl_c_before_the_loop_runs_is_an_interruption(
    failing: Callable[[BaseException], None], capsys: pytest.CaptureFixture[str]
) -> None:
    """Status 130, and no traceback."""
    failing(KeyboardInterrupt())

    assert main(["interface", "packages"]) == 130
    assert capsys.readouterr().err.strip() == ""


def test_a_bug_is_not_hidden(failing: Callable[[BaseException], None]) -> None:
    """A bug needs its traceback."""
    failing(ZeroDivisionError())

    with pytest.raises(ZeroDivisionError):
        main(["interface", "packages"])


def test_a_reader_that_goes_away_ends_a_command_quietly(
    failing: Callable[[BaseException], None],
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """``| head`` is not an error."""
    silenced: list[object] = []
    monkeypatch.setattr(command, "discard", silenced.append)
    failing(BrokenPipeError())

    assert main(["interface", "packages"]) == 0
    assert capsys.readouterr().err == ""
    assert silenced == [sys.stdout]


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_completion_prints_the_script_of_a_shell(
    shell: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """The script says how to install it permanently."""
    assert main(["completion", shell]) == 0

    script = capsys.readouterr().out
    assert f"_AIONODE_COMPLETE={shell}_complete" in script
    assert script.startswith("# Put the following into ~/")


def test_the_shell_is_offered_types(monkeypatch: pytest.MonkeyPatch) -> None:
    """First packages, then their types: all types together would be hundreds."""
    context = click.Context(root)
    show = group_of("interface").commands["show"]
    (argument,) = (parameter for parameter in show.params if parameter.name == "type_name")

    packages = [item.value for item in argument.shell_complete(context, "std_s")]
    types = [item.value for item in argument.shell_complete(context, "std_srvs/srv/S")]

    assert packages == ["std_srvs/"]
    assert types == ["std_srvs/srv/SetBool"]
