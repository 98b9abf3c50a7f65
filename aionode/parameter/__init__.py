"""Parameters: values, descriptors, a node's store, and declaration from a class."""

from aionode.parameter._callbacks import (
    OnSetCallback,
    ParameterCallbacks,
    PostSetCallback,
    PreSetCallback,
)
from aionode.parameter._declaration import validate_parameter_name
from aionode.parameter._qos_overrides import QoSOverridingOptions, declare_qos_overrides
from aionode.parameter._services import ParameterService, parameter_services
from aionode.parameter._store import ParameterStore
from aionode.parameter._struct import ParameterOwner, declare_struct
from aionode.parameter._value import (
    PARAMETER_SEPARATOR_STRING,
    AllowableParameterValue,
    Parameter,
    ParameterType,
    get_parameter_value,
    parameter_dict_from_yaml_file,
    parameter_value_to_python,
)

__all__ = [
    "PARAMETER_SEPARATOR_STRING",
    "AllowableParameterValue",
    "OnSetCallback",
    "Parameter",
    "ParameterCallbacks",
    "ParameterOwner",
    "ParameterService",
    "ParameterStore",
    "ParameterType",
    "PostSetCallback",
    "PreSetCallback",
    "QoSOverridingOptions",
    "declare_qos_overrides",
    "declare_struct",
    "get_parameter_value",
    "parameter_dict_from_yaml_file",
    "parameter_services",
    "parameter_value_to_python",
    "validate_parameter_name",
]
