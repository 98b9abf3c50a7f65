"""The arguments of a ROS program, and the parameter files that they name."""

from aionode.arguments._parameter_yaml import (
    ParameterRule,
    ParameterValueType,
    matching_parameters,
    parse_parameter_yaml,
    parse_scalar,
    parse_value,
    read_parameter_file,
)
from aionode.arguments._parse import Arguments, parse_arguments, remove_ros_args
from aionode.arguments._usage import Usage

__all__ = [
    "Arguments",
    "ParameterRule",
    "ParameterValueType",
    "Usage",
    "matching_parameters",
    "parse_arguments",
    "parse_parameter_yaml",
    "parse_scalar",
    "parse_value",
    "read_parameter_file",
    "remove_ros_args",
]
