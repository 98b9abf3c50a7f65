"""Launch files import this as `launch_param_builder`; a workspace's own takes precedence."""

from __future__ import annotations

from launch_param_builder.launch_param_builder import ParameterBuilder
from launch_param_builder.utils import (
    ParameterBuilderFileNotFoundError,
    ParameterValueType,
    get_path,
    load_file,
    load_xacro,
    load_yaml,
    raise_if_file_not_found,
)

__all__ = [
    "ParameterBuilder",
    "ParameterBuilderFileNotFoundError",
    "ParameterValueType",
    "get_path",
    "load_file",
    "load_xacro",
    "load_yaml",
    "raise_if_file_not_found",
]
