"""Logging has rcutils' console format and rclpy's filters, on top of the standard library."""

from __future__ import annotations

import io
import logging as standard
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode import logging
from aionode.clock import ROSClock, Time
from aionode.errors import AionodeError, ConfigurationError
from aionode.logging import LogEvent, LoggingSeverity
from aionode.logging._console import ConsoleSettings, LineFormatter
from aionode.logging._filters import CallSite, LogOptions

STAMP_NS = 1_234_567_890_123_456_789
SECOND = 1_000_000_000

VARIABLES = (
    "RCUTILS_CONSOLE_OUTPUT_FORMAT",
    "RCUTILS_LOGGING_USE_STDOUT",
    "RCUTILS_LOGGING_BUFFERED_STREAM",
    "RCUTILS_COLORIZED_OUTPUT",
    "ROS_LOG_DIR",
    "ROS_HOME",
)


SINKS: list[Callable[[], None]] = []
"""Removes the sinks that a test has added."""


@pytest.fixture(autouse=True)
def fresh(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Start each test with the logging state of a new process, and restore it afterwards."""
    for variable in VARIABLES:
        monkeypatch.delenv(variable, raising=False)
    logging.clear_config()
    yield
    for remove in SINKS:
        remove()
    SINKS.clear()
    monkeypatch.undo()
    logging.clear_config()
    logging.shutdown()


def logger(name: str = "talker") -> logging.RcutilsLogger:
    """Return a logger whose clock stands still."""
    return logging.get_logger(name, now_ns=lambda: STAMP_NS)


# The line


def test_a_line_looks_as_in_ros(capsys: pytest.CaptureFixture[str]) -> None:
    """The tutorial shows this line."""
    logger("simple_publisher").info('Publishing: "Hello"')

    out, err = capsys.readouterr()
    assert err == '[INFO] [1234567890.123456789] [simple_publisher]: Publishing: "Hello"\n'
    assert out == ""


def test_each_method_has_its_severity(capsys: pytest.CaptureFixture[str]) -> None:
    """Five names, spelled as in rcutils."""
    log = logger()
    log.set_level(LoggingSeverity.DEBUG)
    log.debug("m")
    log.info("m")
    log.warning("m")
    log.warn("m")  # noqa: G010 - rclpy's older name
    log.error("m")
    log.fatal("m")

    severities = [line.split()[0] for line in capsys.readouterr().err.splitlines()]
    assert severities == ["[DEBUG]", "[INFO]", "[WARN]", "[WARN]", "[ERROR]", "[FATAL]"]


def test_percent_signs_and_braces_are_text(capsys: pytest.CaptureFixture[str]) -> None:
    """A message is not a template."""
    logger().info("100 % {name} %s %(x)d")

    assert capsys.readouterr().err.endswith("[talker]: 100 % {name} %s %(x)d\n")


def test_all_tokens_of_the_format_are_filled_in(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """rcutils documents nine tokens and five escapes."""  # noqa: D403
    monkeypatch.setenv(
        "RCUTILS_CONSOLE_OUTPUT_FORMAT",
        r"{severity}|{name}|{message}|{function_name}|{time}|{time_as_nanoseconds}\t100%{nothing}{",
    )
    logging.clear_config()
    logger().error("m")

    assert capsys.readouterr().err == (
        "ERROR|talker|m|test_all_tokens_of_the_format_are_filled_in|"
        "1234567890.123456789|1234567890123456789\t100%{nothing}{\n"
    )


def test_file_line_and_date_are_those_of_the_call(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """They are not those of the logger's own code."""
    monkeypatch.setenv(
        "RCUTILS_CONSOLE_OUTPUT_FORMAT", "{file_name}|{line_number}|{date_time_with_ms}"
    )
    logging.clear_config()
    logger().info("m")
    here = sys._getframe().f_lineno - 1

    file, line, date = capsys.readouterr().err.strip().split("|")
    assert (file, int(line)) == (__file__, here)
    assert date.startswith("2009-02-1")  # the day depends on where the machine stands
    assert date.endswith(".123")


def test_a_time_of_zero_has_ten_digits() -> None:
    """As rcutils pads it."""
    record = standard.LogRecord("a", 20, "f", 1, "m", (), None)
    record.created = 0.0

    line = LineFormatter("{time} {time_as_nanoseconds}").format(record)

    assert line == "0000000000.000000000 0000000000000000000"


@pytest.mark.parametrize(
    ("severity", "colour"), [(10, "\033[32m"), (20, "\033[0m"), (30, "\033[33m"), (50, "\033[31m")]
)
def test_colours_are_rcutils_colours_when_asked_for(
    severity: int,
    colour: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """Green, plain, yellow, red."""
    monkeypatch.setenv("RCUTILS_COLORIZED_OUTPUT", "1")
    logging.clear_config()
    log = logger()
    log.set_level(10)
    log.log("m", severity)

    line = capsys.readouterr().err
    assert line.startswith(f"{colour}[")
    assert line.endswith("]: m\033[0m\n")


class Terminal(io.StringIO):
    """A stream that claims to be a terminal."""

    def isatty(self) -> bool:
        """Return True."""
        return True


@pytest.mark.parametrize(("variable", "coloured"), [(None, True), ("0", False)])
def test_a_terminal_is_coloured_unless_forbidden(
    variable: str | None, *, coloured: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By default, only a terminal gets colours."""
    if variable is not None:
        monkeypatch.setenv("RCUTILS_COLORIZED_OUTPUT", variable)
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    logging.clear_config()
    logger().error("m")

    assert ("\033[31m" in terminal.getvalue()) is coloured


def test_lines_go_to_stdout_when_asked_for(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """RCUTILS_LOGGING_USE_STDOUT=1."""
    monkeypatch.setenv("RCUTILS_LOGGING_USE_STDOUT", "1")
    logging.clear_config()
    logger().info("m")

    out, err = capsys.readouterr()
    assert out.endswith("[talker]: m\n")
    assert err == ""


@pytest.mark.parametrize("variable", VARIABLES[1:4])
def test_a_variable_that_is_neither_0_nor_1_is_an_error(
    variable: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A typo does not count as 0."""
    monkeypatch.setenv(variable, "yes")

    with pytest.raises(ConfigurationError, match=f"{variable}.*'yes'.*0 or 1"):
        logging.clear_config()


def test_a_buffered_stream_is_written_out_line_by_line() -> None:
    """Both 0 and 1 request it; without the variable, the stream decides."""
    flushes = [
        ConsoleSettings.from_environment({"RCUTILS_LOGGING_BUFFERED_STREAM": value}).flush
        for value in ("", "0", "1")
    ]

    assert flushes == [None, True, True]


def test_a_closed_stream_does_not_fail_the_caller(monkeypatch: pytest.MonkeyPatch) -> None:
    """At the exit of a process, or before `| head`, the stream may have no reader."""
    stream = io.StringIO()
    monkeypatch.setattr(sys, "stderr", stream)
    monkeypatch.setattr(standard, "raiseExceptions", False)
    stream.close()

    assert logger().info("m") is True


def test_a_missing_stream_does_not_fail_the_caller(monkeypatch: pytest.MonkeyPatch) -> None:
    """Python has no stderr if its descriptor was closed at the start, as some daemons do."""
    monkeypatch.setattr(sys, "stderr", None)

    assert logger().info("m") is True


# Levels


def test_info_is_the_level_to_begin_with() -> None:
    """Debug messages have to be enabled."""
    assert logger().debug("m") is False
    assert logger().get_effective_level() is LoggingSeverity.INFO


def test_a_child_has_its_parents_level_until_it_has_its_own() -> None:
    """Names form a tree, separated by dots."""
    parent = logger("parent")
    child = parent.get_child("child")
    parent.set_level(LoggingSeverity.ERROR)

    assert child.name == "parent.child"
    assert child.get_effective_level() is LoggingSeverity.ERROR
    child.set_level(LoggingSeverity.DEBUG)
    assert child.get_effective_level() is LoggingSeverity.DEBUG
    child.set_level(LoggingSeverity.UNSET)
    assert child.get_effective_level() is LoggingSeverity.ERROR


@pytest.mark.parametrize("severity", LoggingSeverity)
def test_the_root_may_have_any_level(severity: LoggingSeverity) -> None:
    """UNSET passes everything."""
    logging.set_logger_level("", severity)

    assert logging.get_logger_effective_level("anything") is severity
    assert logger().is_enabled_for(LoggingSeverity.DEBUG) is (severity <= LoggingSeverity.DEBUG)


def test_a_level_can_be_set_before_the_logger_exists() -> None:
    """`--log-level later:=error`."""
    logging.set_logger_level("later", LoggingSeverity.ERROR)

    assert logging.get_logger_level("later") is LoggingSeverity.ERROR
    assert logging.get_logger_level("later.child") is LoggingSeverity.UNSET
    assert logger("later").warning("m") is False


def test_clearing_forgets_all_levels() -> None:
    """Afterwards all levels are as at the start."""
    log = logger()
    log.set_level(LoggingSeverity.WARN)
    logging.clear_config()

    assert log.get_effective_level() is LoggingSeverity.INFO


@pytest.mark.parametrize("word", ["warn", "WARN", "Warn"])
def test_a_severity_is_found_by_name(word: str) -> None:
    """In upper or lower case."""
    assert logging.get_logging_severity_from_string(word) is LoggingSeverity.WARN


@pytest.mark.parametrize("kind", [RuntimeError, ValueError, AionodeError])
def test_an_unknown_severity_says_which_there_are(kind: type[Exception]) -> None:
    """It is a RuntimeError, as in rclpy."""
    with pytest.raises(kind, match=r"'loud'; valid levels are UNSET, DEBUG, INFO, WARN"):
        logging.get_logging_severity_from_string("loud")


def test_names_must_not_be_empty() -> None:
    """The root is reached by set_logger_level("", …)."""
    with pytest.raises(ValueError, match="Logger name must not be empty"):
        logging.get_logger("")
    with pytest.raises(ValueError, match="Child logger name must not be empty"):
        logger().get_child("")


# Filters


def results(log: Callable[[int], bool], count: int = 5) -> list[bool]:
    """Return which of some calls of one place were logged."""
    return [log(i) for i in range(count)]


class Clock:
    """A source of time that advances 0.4 s per reading of the throttle."""

    def __init__(self) -> None:
        self.now_ns = STAMP_NS


def test_once_lets_the_first_message_through() -> None:
    """`once=False` lets all through."""
    log = logger()

    assert results(lambda i: log.info(f"{i}", once=True)) == [True, *[False] * 4]
    assert results(lambda i: log.info(f"{i}", once=False)) == [True] * 5


def test_skip_first_stops_the_first_message() -> None:
    """All later ones pass."""
    log = logger()

    assert results(lambda i: log.info(f"{i}", skip_first=True)) == [False, *[True] * 4]


def throttled(**options: object) -> list[bool]:
    """Return which of five calls, 0.4 s apart, were logged."""
    clock = Clock()
    log = logging.get_logger("talker", now_ns=lambda: clock.now_ns)

    def call(i: int) -> bool:
        logged = log.info(f"{i}", throttle_duration_sec=1, **options)  # type: ignore[arg-type]
        clock.now_ns += 400_000_000
        return logged

    return results(call)


def test_throttle_lets_one_message_through_per_period() -> None:
    """At 0 s and 1.2 s."""
    assert throttled() == [True, False, False, True, False]


def test_throttle_comes_before_skip_first() -> None:
    """A message that skip_first stops still starts a period."""
    assert throttled(skip_first=True) == [False, False, False, True, False]


def test_skip_first_comes_before_once() -> None:
    """The second message is the one that passes."""
    log = logger()

    logged = results(lambda i: log.info(f"{i}", skip_first=True, once=True))

    assert logged == [False, True, False, False, False]


def test_throttle_follows_a_ros_clock() -> None:
    """In a simulation the period is measured in simulated time."""
    clock = ROSClock()
    clock.set_ros_time_active(True)
    log = logger()

    def call(i: int) -> bool:
        logged = log.info(f"{i}", throttle_duration_sec=2, throttle_time_source_type=clock)
        clock.set_ros_time_override(Time(seconds=i + 1, clock_type=clock.clock_type))
        return logged

    assert results(call) == [False, False, True, False, True]


def test_throttle_survives_a_clock_that_was_set_back() -> None:
    """After a simulation has restarted, its log must not stay silent for as long as it had run."""
    site = CallSite(test_names_must_not_be_empty.__code__, "a", {"throttle_duration_sec": 1.0})
    times = [100 * SECOND, 5 * SECOND, 5 * SECOND + 1, 6 * SECOND]

    assert [site.lets_through(lambda now=now: now) for now in times] == [True, True, False, True]  # type: ignore[misc]


def test_each_place_in_the_code_has_its_own_state() -> None:
    """Even two calls on one line."""
    log = logger()

    logged = [(log.info("a", once=True), log.info("b", once=True)) for _ in range(2)]

    assert logged == [(True, True), (False, False)]


def test_each_logger_has_its_own_state() -> None:
    """A message `once` per node."""
    logged = [logger(name).info("m", once=True) for name in ("a", "b")]

    assert logged == [True, True]


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda log, i: log.info("m", name=f"n{i}"), "name cannot be changed"),
        (lambda log, i: log.info("m", once=bool(i)), "filters cannot be changed"),
        (lambda log, i: log.info("m", throttle_duration_sec=i + 1), "parameters cannot be changed"),
    ],
)
def test_a_place_in_the_code_must_not_change_its_options(
    change: Callable[[logging.RcutilsLogger, int], bool], says: str
) -> None:
    """Its state would be meaningless."""
    log = logger()
    change(log, 0)

    with pytest.raises(ValueError, match=says):
        change(log, 1)


@pytest.mark.parametrize("method", ["info", "warn", "error", "fatal"])
def test_one_place_in_the_code_may_log_with_several_severities(method: str) -> None:
    """A line such as ``(log.info if ok else log.error)(text)`` would fail only on an error."""
    log = logger()

    logged = [getattr(log, each)("m", once=True) for each in ("debug", method, "debug", method)]

    assert logged == [False, True, False, False]


def test_an_unknown_option_is_a_type_error_that_names_the_known() -> None:
    """A misspelled filter must not be ignored silently."""
    with pytest.raises(TypeError, match="parameter 'onec' is not one of the recognized"):
        logger().info("m", onec=True)  # type: ignore[call-arg]


def test_a_clock_alone_does_not_throttle() -> None:
    """The period is missing."""
    with pytest.raises(TypeError, match="required parameter 'throttle_duration_sec' not specified"):
        logger().info("m", throttle_time_source_type=ROSClock())


def test_a_clock_that_is_none_is_a_value_error() -> None:
    """As in rclpy."""
    with pytest.raises(ValueError, match="is not a clock instance"):
        logger().info("m", throttle_duration_sec=1, throttle_time_source_type="steady")  # type: ignore[arg-type]


def test_another_name_can_be_logged_under(capsys: pytest.CaptureFixture[str]) -> None:
    """`name=` is for one call."""
    logger().info("m", name="other")

    assert "[other]: m" in capsys.readouterr().err


booleans = st.sampled_from([{}, {"once": True}, {"skip_first": True}, {"throttle_duration_sec": 1}])


@given(st.lists(booleans, max_size=3), st.lists(st.integers(0, 5 * SECOND), max_size=20))
def test_no_filter_lets_more_through_than_without_it(
    chosen: list[LogOptions], waits: list[int]
) -> None:
    """Filters only remove messages, whatever the clock does."""
    options: LogOptions = {}
    for each in chosen:
        options.update(each)
    site = CallSite(test_names_must_not_be_empty.__code__, "a", options)
    now = STAMP_NS
    passed = 0
    for wait in waits:
        now += wait
        passed += site.lets_through(lambda now=now: now)  # type: ignore[misc]

    assert passed <= (1 if options.get("once") else len(waits))


# The standard library underneath


def test_a_message_reaches_handlers_of_the_standard_library(
    caplog: pytest.LogCaptureFixture,
) -> None:
    """caplog, structlog and Sentry see it, with its location and time."""
    logger("ns.talker").warning("m")

    (record,) = caplog.records
    assert (record.name, record.levelname, record.message) == ("ros.ns.talker", "WARNING", "m")
    assert record.pathname == __file__
    assert record.created == STAMP_NS / SECOND


def test_loggers_of_aionode_itself_write_in_the_same_format(
    capsys: pytest.CaptureFixture[str],
) -> None:
    """They are ordinary loggers of the standard library."""
    standard.getLogger("aionode.transport").warning("%s lost", "sample")

    assert capsys.readouterr().err.endswith("[aionode.transport]: sample lost\n")


def test_a_traceback_follows_its_message(capsys: pytest.CaptureFixture[str]) -> None:
    """`logging.exception` of library code keeps its value."""
    try:
        raise KeyError("x")  # noqa: TRY301
    except KeyError:
        standard.getLogger("aionode.transport").exception("failed")

    assert "[aionode.transport]: failed\nTraceback" in capsys.readouterr().err


RUN_ALONE = """
import logging, sys
import aionode.logging
assert not logging.getLogger().handlers and logging.getLogger().level == logging.WARNING
assert not logging.getLogger("ros").handlers and not logging.getLogger("aionode").handlers
{body}
"""


def run_alone(body: str) -> str:
    """Run a program in a fresh process, where pytest has no handlers, and return its stderr."""
    program = RUN_ALONE.format(body=body)
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=30, check=True
    )
    return done.stderr


def test_importing_installs_nothing_and_run_may_show_all_loggers_once() -> None:
    """`aionode.run` asks for whole_process; a user's own loggers then have the same format."""
    err = run_alone(
        "aionode.logging.configure(whole_process=True)\n"
        "logging.getLogger('mine').info('hello')\n"
        "aionode.logging.get_logger('talker').info('once')\n"
        "aionode.logging.shutdown()\n"
        "logging.getLogger('mine').info('quiet again')\n"
    )

    lines = err.splitlines()
    assert len(lines) == 2
    assert lines[0].endswith("[mine]: hello")
    assert lines[1].endswith("[talker]: once")


def test_an_application_that_configures_logging_keeps_its_own_format() -> None:
    """Its handlers are kept."""
    err = run_alone(
        "logging.basicConfig(format='mine: %(message)s', level=logging.INFO)\n"
        "aionode.logging.configure(console=False, whole_process=True)\n"
        "aionode.logging.get_logger('talker').info('m')\n"
    )

    assert err == "mine: m\n"


@pytest.mark.processes
@pytest.mark.parametrize("before", [True, False])
def test_a_line_comes_once_after_basic_config(before: bool) -> None:
    """The application's handler writes it, in its own format, whichever was installed first."""
    config = "logging.basicConfig(format='mine: %(message)s')\n"
    first = "aionode.logging.get_logger('talker').info('first')\n"
    log = "aionode.logging.get_logger('talker').info('m')\n"
    err = run_alone(config + log if before else first + config + log)

    assert [line for line in err.splitlines() if "first" not in line] == ["mine: m"]


@pytest.mark.processes
@pytest.mark.parametrize(
    "handler", ["logging.FileHandler('/dev/null')", "logging.NullHandler()", "high"]
)
def test_a_handler_that_shows_nothing_leaves_the_console_to_this_package(handler: str) -> None:
    """A handler for a file, or for errors only, does not hide what nodes log."""
    make = "logging.StreamHandler(); h.setLevel(40)" if handler == "high" else handler
    err = run_alone(
        f"h = {make}\nlogging.getLogger().addHandler(h)\n"
        "aionode.logging.get_logger('talker').info('m')\n"
    )

    assert len(err.splitlines()) == 1
    assert err.endswith("[talker]: m\n")


# Sinks


def sink_on(log: logging.RcutilsLogger) -> tuple[list[LogEvent], Callable[[], None]]:
    """Collect what a logger logs."""
    events: list[LogEvent] = []
    SINKS.append(log.add_sink(events.append))
    return events, SINKS[-1]


def test_a_sink_gets_what_a_log_message_of_ros_holds() -> None:
    """`/rosout` is made from it."""
    log = logger()
    events, _ = sink_on(log)
    log.error("m")

    (event,) = events
    assert event == LogEvent(
        40,
        "talker",
        "m",
        __file__,
        "test_a_sink_gets_what_a_log_message_of_ros_holds",
        event.line,
        STAMP_NS,
    )


def test_a_sink_gets_what_children_log_until_it_is_removed() -> None:
    """A node's sub-loggers are on `/rosout` too."""
    log = logger()
    events, remove = sink_on(log)
    log.get_child("arm").info("a")
    remove()
    log.info("b")

    assert [(event.name, event.msg) for event in events] == [("talker.arm", "a")]


def test_a_message_goes_to_the_nearest_sink_only() -> None:
    """Node /a does not publish what node /a/b logs, although a.b is below a."""
    above, _ = sink_on(logger("a"))
    below, _ = sink_on(logger("a.b"))
    logger("a.b").info("m")

    assert len(below) == 1
    assert above == []


def test_a_sink_that_logs_does_not_hear_itself() -> None:
    """Publishing a log message may itself have to warn."""
    log = logger()
    seen: list[str] = []

    def sink(event: LogEvent) -> None:
        seen.append(event.msg)
        log.warning("while publishing")

    SINKS.append(log.add_sink(sink))
    log.info("m")

    assert seen == ["m"]


def test_a_sink_gets_nothing_below_the_level() -> None:
    """Levels are applied first."""
    log = logger()
    events, _ = sink_on(log)
    log.debug("m")

    assert events == []


# Configuration and files


def test_levels_and_console_can_be_configured(capsys: pytest.CaptureFixture[str]) -> None:
    """As `--log-level` and `--disable-stdout-logs` do."""
    logging.configure(level=LoggingSeverity.ERROR, levels={"talker": 10}, console=False)

    assert logger("other").warning("m") is False
    assert logger("talker").debug("m") is True
    assert capsys.readouterr().err == ""


def test_no_file_is_written_unless_asked(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A log must not fill a robot's disk unnoticed."""
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path))
    logging.clear_config()
    logger().info("m")

    assert list(tmp_path.iterdir()) == []


def test_a_log_file_has_the_same_lines_without_colours(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """`--log-file-name robot` makes robot_<pid>_<ms>.log in the logging directory."""
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path / "new"))
    monkeypatch.setenv("RCUTILS_COLORIZED_OUTPUT", "1")
    logging.configure(file_name="robot")
    logger().info("m")
    logging.shutdown()

    (file,) = (tmp_path / "new").glob("robot_*_*.log")
    assert file.read_text() == "[INFO] [1234567890.123456789] [talker]: m\n"


@pytest.mark.parametrize(
    ("variables", "directory"),
    [
        ({}, "~/.ros/log"),
        ({"ROS_HOME": "/home/robot/ros"}, "/home/robot/ros/log"),
        ({"ROS_LOG_DIR": "/var/log/ros", "ROS_HOME": "/other"}, "/var/log/ros"),
        ({"ROS_LOG_DIR": "~/logs"}, "~/logs"),
    ],
)
def test_the_logging_directory_is_rcls(
    variables: dict[str, str], directory: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """ROS_LOG_DIR before ROS_HOME before the home directory."""
    for variable, value in variables.items():
        monkeypatch.setenv(variable, value)

    assert logging.get_logging_directory() == Path(directory).expanduser()
