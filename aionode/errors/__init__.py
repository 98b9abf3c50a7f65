"""All exceptions that aionode raises on purpose.

Each derives from `AionodeError` and from the builtin exception that a caller would expect, so
`except AionodeError` and `except TimeoutError` both work. Exceptions that also exist in rclpy keep
rclpy's name; new ones end in `Error`. They carry plain values, never live objects.

::

    AionodeError
    ├── BagError (ValueError)
    ├── BagWriteError (OSError)
    ├── CallbackCancelledError (RuntimeError)
    ├── CallbackSignatureError (TypeError, RuntimeError)
    ├── CommandError (RuntimeError)
    ├── ConfigurationError (ValueError)
    ├── ContentFilterError (ValueError)
    ├── ContractError (ValueError)
    ├── DatasetError (ValueError)
    ├── DecodeError (ValueError)
    ├── EntityDestroyedError (RuntimeError)
    ├── EntityInactiveError (RuntimeError)
    ├── EpisodeError (RuntimeError)
    ├── ExecutableNotFoundError (LookupError)
    ├── ForkedProcessError (RuntimeError)
    ├── GoalError (RuntimeError)
    │   ├── GoalAbortedError
    │   ├── GoalCanceledError
    │   ├── GoalLostError
    │   └── GoalRejectedError
    ├── GoalRejected (RuntimeError)
    ├── GoalTransitionError (RuntimeError)
    ├── IdlError (ValueError)
    ├── InterfaceNotFoundError (LookupError)
    ├── InvalidLogLevelError (ValueError, RuntimeError)
    ├── InvalidQoSProfileException (ValueError)
    ├── InvalidQosOverridesError (ValueError, RuntimeError)
    ├── InvalidROSArgsError (ValueError)
    │   └── UnknownROSArgsError
    ├── InvalidRemapRuleError (ValueError)
    ├── MemberNotFoundError (LookupError)
    ├── LaunchFileError (ValueError)
    ├── MessageError (ValueError)
    ├── LeaseExpiredError (TimeoutError)
    ├── LeaseHeldError (RuntimeError)
    ├── NameValidationException (ValueError)
    │   ├── InvalidNamespaceException
    │   ├── InvalidNodeNameException
    │   ├── InvalidServiceNameException
    │   └── InvalidTopicNameException
    ├── PackageNotFoundError (LookupError)
    ├── PolicyFileError (ValueError)
    ├── PolicyTooSlowError (TimeoutError)
    ├── ParameterException
    │   ├── InvalidParameterException (ValueError)
    │   ├── InvalidParameterTypeException (TypeError)
    │   ├── InvalidParameterValueException (ValueError)
    │   ├── ParameterAlreadyDeclaredException (ValueError)
    │   ├── ParameterImmutableException (RuntimeError)
    │   ├── ParameterNotDeclaredException (KeyError)
    │   └── ParameterUninitializedException (RuntimeError)
    ├── ParameterFileError (ValueError, RuntimeError)
    ├── NodeNameNonExistentError (LookupError, RuntimeError)
    ├── NodeNotRunningError (RuntimeError)
    ├── NotReadyError (TimeoutError)
    ├── ProgramStartError (OSError)
    ├── QueueFullError (RuntimeError)
    ├── RefusedError (PermissionError)
    ├── StaleError (TimeoutError)
    ├── ServiceError (RuntimeError)
    │   └── ServiceUnavailableError (TimeoutError)
    ├── RequestRefusedError (ValueError)
    ├── RequestTimeoutError (TimeoutError)
    ├── TimeSourceChangedError (RuntimeError)
    ├── ToolError (RuntimeError)
    ├── TransformException (RuntimeError)
    │   ├── ConnectivityException
    │   ├── ExtrapolationException
    │   │   ├── BackwardExtrapolationException
    │   │   ├── ForwardExtrapolationException
    │   │   └── NoDataForExtrapolationException
    │   ├── InvalidArgumentException (ValueError)
    │   ├── LookupException (LookupError)
    │   └── TimeoutException (TimeoutError)
    ├── TransitionError (RuntimeError)
    ├── TransportError (ConnectionError)
    │   └── FrameError
    └── TypeDescriptionError (ValueError)
"""

from __future__ import annotations

from aionode.errors import _base, _calls
from aionode.errors._bag import BagError, BagWriteError
from aionode.errors._base import AionodeError
from aionode.errors._calls import (
    GoalAbortedError,
    GoalCanceledError,
    GoalError,
    GoalLostError,
    GoalRejected,
    GoalRejectedError,
    GoalTransitionError,
    RequestRefusedError,
    RequestTimeoutError,
    ServiceError,
    ServiceUnavailableError,
)
from aionode.errors._commands import CommandError, LaunchFileError
from aionode.errors._gateway import PolicyFileError, RefusedError, ToolError
from aionode.errors._interfaces import (
    DecodeError,
    IdlError,
    InterfaceNotFoundError,
    MessageError,
    TypeDescriptionError,
)
from aionode.errors._learn import ContractError, DatasetError, EpisodeError
from aionode.errors._names import (
    InvalidLogLevelError,
    InvalidNamespaceException,
    InvalidNodeNameException,
    InvalidRemapRuleError,
    InvalidROSArgsError,
    InvalidServiceNameException,
    InvalidTopicNameException,
    NameValidationException,
    UnknownROSArgsError,
)
from aionode.errors._nodes import (
    CallbackCancelledError,
    CallbackSignatureError,
    EntityDestroyedError,
    EntityInactiveError,
    ForkedProcessError,
    NodeNameNonExistentError,
    NodeNotRunningError,
    TimeSourceChangedError,
    TransitionError,
)
from aionode.errors._parameters import (
    InvalidParameterException,
    InvalidParameterTypeException,
    InvalidParameterValueException,
    ParameterAlreadyDeclaredException,
    ParameterException,
    ParameterFileError,
    ParameterImmutableException,
    ParameterNotDeclaredException,
    ParameterUninitializedException,
)
from aionode.errors._policies import PolicyTooSlowError, StaleError
from aionode.errors._programs import (
    ExecutableNotFoundError,
    MemberNotFoundError,
    NotReadyError,
    PackageNotFoundError,
    ProgramStartError,
)
from aionode.errors._topics import (
    ContentFilterError,
    InvalidQosOverridesError,
    InvalidQoSProfileException,
    LeaseExpiredError,
    LeaseHeldError,
    QueueFullError,
)
from aionode.errors._transforms import (
    BackwardExtrapolationException,
    ConnectivityException,
    ExtrapolationException,
    ForwardExtrapolationException,
    InvalidArgumentException,
    LookupException,
    NoDataForExtrapolationException,
    TimeoutException,
    TransformException,
)
from aionode.errors._transport import ConfigurationError, FrameError, TransportError

__all__ = [
    "AionodeError",
    "BackwardExtrapolationException",
    "BagError",
    "BagWriteError",
    "CallbackCancelledError",
    "CallbackSignatureError",
    "CommandError",
    "ConfigurationError",
    "ConnectivityException",
    "ContentFilterError",
    "ContractError",
    "DatasetError",
    "DecodeError",
    "EntityDestroyedError",
    "EntityInactiveError",
    "EpisodeError",
    "ExecutableNotFoundError",
    "ExtrapolationException",
    "ForkedProcessError",
    "ForwardExtrapolationException",
    "FrameError",
    "GoalAbortedError",
    "GoalCanceledError",
    "GoalError",
    "GoalLostError",
    "GoalRejected",
    "GoalRejectedError",
    "GoalTransitionError",
    "IdlError",
    "InterfaceNotFoundError",
    "InvalidArgumentException",
    "InvalidLogLevelError",
    "InvalidNamespaceException",
    "InvalidNodeNameException",
    "InvalidParameterException",
    "InvalidParameterTypeException",
    "InvalidParameterValueException",
    "InvalidQoSProfileException",
    "InvalidQosOverridesError",
    "InvalidROSArgsError",
    "InvalidRemapRuleError",
    "InvalidServiceNameException",
    "InvalidTopicNameException",
    "LaunchFileError",
    "LeaseExpiredError",
    "LeaseHeldError",
    "LookupException",
    "MemberNotFoundError",
    "MessageError",
    "NameValidationException",
    "NoDataForExtrapolationException",
    "NodeNameNonExistentError",
    "NodeNotRunningError",
    "NotReadyError",
    "PackageNotFoundError",
    "ParameterAlreadyDeclaredException",
    "ParameterException",
    "ParameterFileError",
    "ParameterImmutableException",
    "ParameterNotDeclaredException",
    "ParameterUninitializedException",
    "PolicyFileError",
    "PolicyTooSlowError",
    "ProgramStartError",
    "QueueFullError",
    "RefusedError",
    "RequestRefusedError",
    "RequestTimeoutError",
    "ServiceError",
    "ServiceUnavailableError",
    "StaleError",
    "TimeSourceChangedError",
    "TimeoutException",
    "ToolError",
    "TransformException",
    "TransitionError",
    "TransportError",
    "TypeDescriptionError",
    "UnknownROSArgsError",
]

# For error texts in other modules of aionode; not public.
brief, escaped, shortened = _base.brief, _base.escaped, _base.shortened
silence = _calls.silence
FAST_DDS_REMEDY, FAST_DDS_SILENCE = _calls.FAST_DDS_REMEDY, _calls.FAST_DDS_SILENCE

for _name in __all__:
    globals()[_name].__module__ = __name__  # users see aionode.errors.X, no private module
