"""Opening a session without free descriptors panics instead of raising."""

from __future__ import annotations

from tests.zenoh_defects._support import process

OPENS = """
import resource
count = len(os.listdir("/proc/self/fd")) + 4
resource.setrlimit(resource.RLIMIT_NOFILE, (count, count))
print("limited", flush=True)
try:
    zenoh.open(zenoh.Config())
except zenoh.ZError:
    print("an error", flush=True)
except BaseException:
    print("a panic", flush=True)
else:
    print("a session", flush=True)
os._exit(0)
"""


def test_a_session_that_gets_no_descriptor_panics() -> None:
    """With some limits the process is aborted: then it prints nothing."""
    with process(OPENS) as running:
        assert running.stdout is not None

        assert running.stdout.readline() in {"a panic\n", ""}
