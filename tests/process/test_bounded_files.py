"""Tests of files whose contents are not what their names suggest."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from aionode import bag
from aionode.arguments import read_parameter_file
from aionode.bag.files.qos import qos_overrides
from aionode.bag.yaml_files import static_topics_in
from aionode.gateway import Policy
from aionode.idl import load_interfaces
from aionode.launch._evaluation import load_description, load_file
from aionode.learn import Contract
from aionode.programs._urdf import Robot
from launch_param_builder.utils import load_yaml

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

POINTER = "version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 5\n"

READERS: dict[str, Callable[[Path], object]] = {
    "a.launch.py": lambda path: load_file(str(path)),
    "a.launch.xml": lambda path: load_description(str(path)),
    "a.launch.yaml": lambda path: load_description(str(path)),
    "params.yaml": read_parameter_file,
    "built.yaml": load_yaml,
    "qos.yaml": qos_overrides,
    "topics.yaml": lambda path: static_topics_in(str(path)),
    "policy.toml": Policy.load,
    "contract.yaml": Contract.load,
    "msg/A.msg": lambda path: load_interfaces(path.parents[1]),
    "srv/A.srv": lambda path: load_interfaces(path.parents[1]),
    "action/A.action": lambda path: load_interfaces(path.parents[1]),
    "a.mcap": bag.open,
    "metadata.yaml": lambda path: bag.open(path.parent),
    "robot.urdf": lambda path: Robot.of(path.read_text()),
}


@pytest.mark.parametrize("name", READERS)
def test_the_pointer_of_git_lfs_is_called_one(name: str, tmp_path: Path) -> None:
    """A clone without LFS has it in place of the file, and a syntax error would mislead."""
    file = tmp_path / "robot" / name
    file.parent.mkdir(parents=True)
    file.write_text(POINTER)
    with pytest.raises((ValueError, OSError), match="`git lfs pull` fetches the file"):
        READERS[name](file)
