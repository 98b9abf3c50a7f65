"""Fuzzes parsers, guided by what of their code is reached: ``python -m tests.fuzz TARGET…``.

Each target has a process of its own, and runs for ``--seconds``. What an earlier run found to reach
further is kept in ``.fuzz/TARGET`` and begun from. An input that makes a parser raise what it
should not, take longer than 5 s or more than 1 GB is written to ``.fuzz/TARGET-crash-…``; give it
to the target again with ``python -m tests.fuzz TARGET --input FILE``.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
from pathlib import Path

FOLDER = Path(".fuzz")
MAX_INPUT = 4096
SLOWEST_S = 5
MAX_MEMORY_MB = 1024


def fuzz(name: str, seconds: int) -> None:
    """Fuzz one target in this process, which ends with it."""
    import atheris

    with atheris.instrument_imports(include=["aionode"]):
        from tests.fuzz.targets import TARGETS

    target = TARGETS[name]
    corpus = FOLDER / name
    corpus.mkdir(parents=True, exist_ok=True)
    for number, seed in enumerate(target.seeds()):
        (corpus / f"seed-{number}").write_bytes(seed)
    options = [
        f"-max_total_time={seconds}",
        f"-max_len={MAX_INPUT}",
        f"-timeout={SLOWEST_S}",
        f"-rss_limit_mb={MAX_MEMORY_MB}",
        f"-artifact_prefix={FOLDER / name}-",
        "-print_final_stats=1",
        "-verbosity=0",
    ]
    if target.words:
        words = FOLDER / f"{name}.dict"
        lines = (f'"{escaped(word)}"\n' for word in target.words)
        words.write_text("".join(lines), encoding="ascii")
        options.append(f"-dict={words}")
    atheris.Setup([sys.argv[0], *options, str(corpus)], target.run)
    atheris.Fuzz()


def escaped(word: str) -> str:
    """Return a word as a dictionary of libFuzzer writes it."""
    return "".join(f"\\x{byte:02x}" for byte in word.encode())


def fuzz_all(names: list[str], seconds: int) -> list[str]:
    """Fuzz several targets, as many at once as there are cores; return those that failed."""
    failed = []
    cores = os.cpu_count() or 1
    for at in range(0, len(names), cores):
        running = {
            name: subprocess.Popen(
                [sys.executable, "-m", "tests.fuzz", name, "--seconds", str(seconds), "--here"],
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
            )
            for name in names[at : at + cores]
        }
        for name, process in running.items():
            output, _ = process.communicate()
            executed = [line for line in output.splitlines() if "executed_units" in line]
            print(f"{name}: {executed[-1].split()[-1] if executed else 0} inputs", flush=True)  # noqa: T201 - a program
            if process.returncode:
                failed.append(name)
                print(output.partition("Using built-in libfuzzer")[2][-6000:], flush=True)  # noqa: T201 - a program
    return failed


def main() -> None:
    """Run as a program."""
    parser = argparse.ArgumentParser(description="Fuzzes parsers, guided by coverage.")
    parser.add_argument("targets", nargs="*", help="which (default: all)")
    parser.add_argument("--seconds", type=int, default=30, help="for each target (30)")
    parser.add_argument("--input", type=Path, help="an input to run one target with, once")
    parser.add_argument("--here", action="store_true", help="fuzz one target in this process")
    options = parser.parse_args()
    if options.here:
        fuzz(options.targets[0], options.seconds)
        return
    from tests.fuzz.targets import TARGETS

    names = options.targets or list(TARGETS)
    if options.input is not None:
        print(TARGETS[names[0]].run(options.input.read_bytes()))  # noqa: T201 - a program
        return
    failed = fuzz_all(names, options.seconds)
    sys.exit(f"failed: {', '.join(failed)}" if failed else 0)


if __name__ == "__main__":
    main()
