"""The rights of clients on the robot: rules in a file that people can review.

A rule states which clients it applies to, what they may do with which names, and within which
limits. The policy refuses a request that no rule allows, and a ``[[refuse]]`` takes precedence over
every ``[[allow]]``.
"""

from __future__ import annotations

import hashlib
import hmac
import math
import re
from collections.abc import Iterable
from functools import lru_cache
from typing import TYPE_CHECKING, Any, Final, Literal, TypeAlias

import msgspec

from aionode._process.bounded_files import read_file
from aionode.errors import PolicyFileError, RefusedError
from aionode.gateway.policy.field_limits import FieldLimit, OutOfLimitsError, check_finite, limited
from aionode.gateway.policy.identity import Credentials, Identity
from aionode.gateway.policy.origin import check_browser

if TYPE_CHECKING:
    from os import PathLike


__all__ = ["Decision", "FieldLimit", "LeaseRule", "Limits", "Policy", "Rule", "Tls", "Verb", "Who"]

Verb: TypeAlias = Literal[
    "see", "subscribe", "publish", "call", "goal", "parameter", "advertise", "stop", "asset"
]
"""The uses of a name by a client. ``parameter`` is for setting one; reading one needs ``see``."""

Names: TypeAlias = str | list[str]

VERBS: Final[tuple[Verb, ...]] = (
    "see",
    "subscribe",
    "publish",
    "call",
    "goal",
    "parameter",
    "advertise",
    "stop",
    "asset",
)
NAMING: Final = VERBS[:-1]
"""The verbs about names of the graph: who may use one of these sees it."""

WRITING: Final[tuple[Verb, ...]] = ("publish", "call", "goal", "parameter", "advertise", "stop")

UNTYPED: Final[tuple[Verb, ...]] = ("see", "parameter")
"""The verbs for nodes and parameters, which have no type."""

LIMITED: Final[dict[str, tuple[Verb, ...]]] = {
    "type": ("see", "subscribe", "publish", "call", "goal", "advertise", "stop"),
    "rate_hz": ("subscribe", "publish", "call", "goal", "parameter", "advertise", "asset"),
    "max_bytes": ("publish", "call", "goal", "asset"),
    "fields": ("publish", "call", "goal", "parameter"),
    "finite": ("publish", "call", "goal", "parameter"),
    "ask": ("subscribe", "publish", "call", "goal", "parameter", "advertise", "asset"),
    "lease": ("publish",),
}
"""The keys of a rule that limit what it allows, and the verbs that each of them can limit."""

COMMANDS: Final = ["geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped"]
"""Types whose default message stops a robot; without a policy file they are published by lease."""

MEASUREMENTS: Final = frozenset(
    f"sensor_msgs/msg/{name}"
    for name in (
        "BatteryState",
        "FluidPressure",
        "Illuminance",
        "Imu",
        "LaserScan",
        "MagneticField",
        "MultiEchoLaserScan",
        "NavSatFix",
        "PointCloud",
        "Range",
        "RelativeHumidity",
        "Temperature",
    )
)
"""Types that only report measurements. NaN and infinities have a meaning in them, defined by their
definitions or REP 117; in any other type they would spread through a controller's arithmetic."""

MAX_REMEMBERED: Final = 16_384
"""Number of decisions and of name patterns that are cached."""

MAX_CHARACTERS: Final = 1000
"""The longest name that is matched against rules, in characters."""

READ_ONLY: Final = (
    "without a policy, clients only read; start the gateway with --allow-write, or write a policy"
)
"""The reason why a client may not write if there is no policy file."""

NO_ASSETS: Final = (
    "without a policy, clients read no files of packages; start the gateway with --assets PACKAGE, "
    "or write a policy"
)
"""The reason why a client may not read a file if there is no policy file."""


ORIGIN: Final = re.compile(
    r"file://|[a-z][a-z0-9+.-]*://(\[[0-9a-f:.]+\]|[a-z0-9_.-]+)(:[0-9]{1,5})?"
)
"""The origin of a page, as browsers write it."""


class Part(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A part of a policy file. An unknown key is an error, as it would have no effect."""


class LeaseRule(Part, frozen=True):
    """Rules for commands on a topic: one client at a time publishes them, with a stop at the end.

    Attributes:
        ttl_sec: The longest time between two commands of the holder, in seconds. After that time,
            the gateway publishes the stop.
        priority: A client takes the topic over from a holder of lower priority.
        max_age_sec: The greatest age of a command, in seconds: by its stamp, and since its arrival.
        stop: The values of the message that stops the robot; other fields have their defaults.
            Required for a type whose default message is not all zeros.
    """

    ttl_sec: float = 0.3
    priority: int = 0
    max_age_sec: float = 0.5
    stop: dict[str, Any] = {}

    def __post_init__(self) -> None:
        if not 0 < self.ttl_sec < math.inf or not self.max_age_sec > 0:
            raise ValueError("ttl_sec and max_age_sec have to be numbers of seconds above 0")


class Rule(Part, frozen=True):
    """One ``[[allow]]`` or ``[[refuse]]``.

    Names are full names, or patterns: ``*`` stands for any characters but a slash, ``?`` for one
    character but a slash, and ``**`` for any characters. Each key takes a name or a list of names.

    Attributes:
        who: The names and groups of the clients that the rule applies to; all clients if empty.
        see: The topics, services, actions and nodes that these clients see, and the parameters that
            they may read, as ``/node:parameter``. ``/node`` stands for the node and all its
            parameters.
        subscribe: The topics to which clients may subscribe.
        publish: The topics to which clients may publish.
        call: The services that they may call.
        goal: The actions to which clients may send goals.
        parameter: The parameters that they may set, as ``/node:parameter``. ``/node`` stands for
            all parameters of the node.
        advertise: The services and actions that they may offer themselves.
        stop: The topics and actions on which an assistant of theirs may end what others move. It
            may always end its own motion.
        asset: The files of packages that they may read, such as the meshes of a model, as
            ``/package/path``; ``/package/**`` stands for all files of a package.
        type: The types that the rule applies to; all types if empty.
        rate_hz: How often they may do so with each name, in hertz. One second's worth may come in a
            burst.
        max_bytes: The largest message, request or goal, in bytes of CDR, or the largest file. By
            default, messages may have any size, and files 16 MiB.
        fields: The limits of fields, by paths such as ``linear.x``; a parameter has the one field
            ``value``.
        finite: Whether NaN and infinity are refused anywhere in a message, request, goal or
            parameter. By default they are, except in measurements such as a LaserScan published
            without a lease.
        ask: Whether a person has to approve each time.
        lease: How commands are published; None for messages that are not commands.
        because: The reason given to a refused client.
    """

    who: Names = []
    see: Names = []
    subscribe: Names = []
    publish: Names = []
    call: Names = []
    goal: Names = []
    parameter: Names = []
    advertise: Names = []
    stop: Names = []
    asset: Names = []
    type: Names = []
    rate_hz: float = math.inf
    max_bytes: int | None = None
    fields: dict[str, FieldLimit] = {}
    finite: bool | None = None
    ask: bool = False
    lease: LeaseRule | None = None
    because: str = ""

    def __post_init__(self) -> None:
        for verb in VERBS:
            for name in listed(getattr(self, verb)):
                if not name.startswith(("/", "**")):
                    raise ValueError(f"{verb}: {name!r} is not a full name; begin it with a slash")
        if not self.rate_hz > 0:
            raise ValueError("rate_hz has to be a number of messages a second, above 0")
        for key, verbs in LIMITED.items():
            without = [verb for verb in VERBS if getattr(self, verb) and verb not in verbs]
            if without and has_key(self, key):
                raise ValueError(
                    f"{key}: it limits {', '.join(verbs)}, but not {without[0]}; write a "
                    f"separate rule for {without[0]}"
                )

    def is_about(self, identity: Identity) -> bool:
        """Return whether the rule applies to a client: it names the client, or names nobody."""
        who = listed(self.who)
        return not who or identity.name in who or not identity.groups.isdisjoint(who)

    def covers(self, verb: Verb, name: str, type_name: str) -> bool:
        """Return whether the rule applies to a use of a name with a type."""
        if type_name and not matches_type(self.type, type_name):
            return False
        return matches(getattr(self, verb), name)

    def needs_finite(self, type_name: str) -> bool:
        """Return whether a message of a type must contain only finite numbers."""
        if self.finite is not None:
            return self.finite
        return self.lease is not None or type_name not in MEASUREMENTS


def has_key(rule: Rule, key: str) -> bool:
    """Return whether a rule sets a key of `LIMITED`."""
    value = getattr(rule, key)
    if key == "finite":
        return value is not None
    return value != math.inf if key == "rate_hz" else value not in (None, False, "", [], {})


class Who(Part, frozen=True):
    """A client known to the policy. It has to match all keys that are given.

    Attributes:
        name: The name of the client, for rules and for the audit log.
        groups: The groups of the client, for rules about several clients.
        token: A secret that the client presents.
        token_sha256: The SHA-256 of the secret, in hexadecimal, instead of ``token``.
        certificate: The common name of the client's TLS certificate.
        origin: The origin of the page. Without a token or certificate it is accepted on loopback
            only, since a program may claim any origin.
        loopback: Whether the client has to run on this host, where any user may connect.
    """

    name: str
    groups: list[str] = []
    token: str = ""
    token_sha256: str = ""
    certificate: str = ""
    origin: str = ""
    loopback: bool = False

    def __post_init__(self) -> None:
        check_origins([self.origin] if self.origin else [])
        if not (self.has_secret or self.origin or self.loopback):
            raise ValueError(
                f"who {self.name!r}: give token, token_sha256, certificate, origin or loopback"
            )
        if self.token_sha256 and not re.fullmatch(r"[0-9a-fA-F]{64}", self.token_sha256):
            raise ValueError(f"who {self.name!r}: token_sha256 must have 64 hexadecimal digits")

    @property
    def has_secret(self) -> bool:
        """Whether the client presents a token or certificate, which no other client has."""
        return bool(self.token or self.token_sha256 or self.certificate)

    def has_token(self, token: str) -> bool:
        """Return whether a token is the client's. All wrong tokens take the same time to check."""
        wanted = self.token_sha256.lower() or hashlib.sha256(self.token.encode()).hexdigest()
        given = hashlib.sha256(token.encode("utf-8", "replace")).hexdigest()
        return bool(self.token or self.token_sha256) and hmac.compare_digest(wanted, given)

    def fits(self, credentials: Credentials) -> bool:
        """Return whether a client matches all keys that are given."""
        if (self.token or self.token_sha256) and not self.has_token(credentials.token):
            return False
        if self.certificate and self.certificate != credentials.certificate:
            return False
        if self.origin and self.origin != credentials.origin:
            return False
        return credentials.is_loopback or (self.has_secret and not self.loopback)


class Limits(Part, frozen=True):
    """The limits for all clients, so that no client exhausts the robot's memory or processor.

    Attributes:
        clients: The most simultaneous connections.
        frame_bytes: The largest frame or request of a client, and the largest message of many
            values created from one, in bytes.
        frame_parts: The most objects and lists in the JSON of a frame or request, which may have
            ten times as many values.
        frames_per_sec: The most frames per second that the gateway reads from a client.
        queued_bytes: The most bytes that wait for one client; beyond that, the oldest messages are
            dropped.
        subscriptions: The most subscriptions of one client.
        advertised: The most topics to which one client publishes, and the most services and actions
            that it offers.
        call_sec: How long a service call waits for its response if the client names no time, in
            seconds.
        longest_call_sec: The longest time that a call waits, whatever the client requests, in
            seconds.
        move_sec: The longest motion by one call of an assistant, in seconds, since a frozen client
            goes unnoticed.
        goal_sec: The longest time that a goal of an assistant runs, in seconds.
        calls: The most simultaneous calls, goals and parameter requests of one client.
        handshake_sec: The longest time for a request to arrive, and the longest time that its
            client may read nothing of the answer, in seconds.
        client_lost_sec: The longest silence of a client that has goals or commands, in seconds;
            after that, the client counts as lost.
    """

    clients: int = 64
    frame_bytes: int = 10_000_000
    frame_parts: int = 100_000
    frames_per_sec: float = 2_000.0
    queued_bytes: int = 64 << 20
    subscriptions: int = 256
    advertised: int = 64
    calls: int = 64
    call_sec: float = 30.0
    longest_call_sec: float = 3600.0
    move_sec: float = 10.0
    goal_sec: float = 120.0
    handshake_sec: float = 10.0
    client_lost_sec: float = 3.0

    def __post_init__(self) -> None:
        for name in self.__struct_fields__:
            if not getattr(self, name) > 0:
                raise ValueError(f"{name}: {getattr(self, name)}, use a number above 0")

    def with_given(self, given: Iterable[str]) -> Limits:
        """Return limits with some values replaced.

        Args:
            given: The values as text, such as ``frame_bytes=20_000_000``.

        Raises:
            ValueError: there is no such limit, or its value is invalid.
        """
        values = msgspec.structs.asdict(self)
        for text in given:
            name, equals, value = text.partition("=")
            if name not in values or not equals:
                raise ValueError(f"{text!r} is not a limit; use one of {', '.join(values)}")
            try:
                values[name] = type(values[name])(value)
            except ValueError:
                raise ValueError(f"{text!r}: the value is not a valid number") from None
        return Limits(**values)


class Tls(Part, frozen=True):
    """The files for TLS, in PEM format.

    Attributes:
        certificate: The certificate of the gateway, with the certificates of its authorities.
        key: The private key of the gateway.
        clients: The authorities of the clients' certificates; empty to ask for no certificate.
    """

    certificate: str
    key: str
    clients: str = ""


class Decision(msgspec.Struct, frozen=True):
    """The decision of the policy about a client's request.

    Attributes:
        allowed: Whether the request is allowed.
        reason: Why the request is refused; empty if it is allowed.
        code: The kind of refusal, as in `RefusedError`.
        message: The message of the request, with its fields clamped to their limits.
        rule: The rule that allows the request.
    """

    allowed: bool
    reason: str = ""
    code: str = "not_allowed"
    message: Any = None
    rule: Rule | None = None

    @property
    def ask(self) -> bool:
        """Whether a person has to approve."""
        return self.rule is not None and self.rule.ask

    @property
    def lease(self) -> LeaseRule | None:
        """How commands are published; None if the message is not a command."""
        return None if self.rule is None else self.rule.lease


class Policy(Part, frozen=True):
    """The rights of clients on the robot: the content of a policy file, or `default`.

    Attributes:
        who: The clients that the policy knows.
        allow: The rules that allow. The first rule that covers a request applies.
        refuse: The rules that refuse, whatever `allow` contains.
        hosts: The names of this machine, beside addresses and ``localhost``.
        origins: The origins of pages that may connect, beside the gateway's own page.
        limits: The limits for all clients.
        tls: The certificate of the gateway; None for connections without TLS.
        audit_file: The file of the audit log; empty for no file.
        path: The file of the policy; empty for a policy without a file.
    """

    who: list[Who] = []
    allow: list[Rule] = []
    refuse: list[Rule] = []
    hosts: list[str] = []
    origins: list[str] = []
    limits: Limits = Limits()
    tls: Tls | None = None
    audit_file: str = ""
    path: str = ""

    def __post_init__(self) -> None:
        check_origins(self.origins)
        for host in self.hosts:
            if not re.fullmatch(r"[\w.-]+", host, re.ASCII):
                raise ValueError(f"hosts: {host!r} is not just a name; omit scheme and port")

    # A frozen struct has no room for this cache; see `first_rule`.
    def __hash__(self) -> int:
        return id(self)

    def __eq__(self, other: object) -> bool:
        return self is other

    @classmethod
    def load(cls, path: str | PathLike[str]) -> Policy:
        """Load the policy from a TOML file.

        Raises:
            PolicyFileError: the file cannot be read, or is not a policy (a ValueError).
        """
        try:
            return cls.parse(read_file(path), str(path))
        except OSError as error:
            raise PolicyFileError(str(path), f"cannot be read: {error.strerror}") from error

    @classmethod
    def parse(cls, text: str | bytes, path: str = "") -> Policy:
        """Parse the policy in a TOML text; `path` is named in errors.

        Raises:
            PolicyFileError: the text is not a policy (a ValueError).
        """
        try:
            policy = msgspec.toml.decode(text, type=cls)
        except (msgspec.DecodeError, ValueError, RecursionError) as error:
            raise PolicyFileError(path, str(error)) from error
        if policy.path:
            raise PolicyFileError(path, "`path` is not a key of a policy")
        known = {client.name for client in policy.who}
        known |= {group for client in policy.who for group in client.groups}
        for rule in policy.refuse:
            for key in LIMITED:
                if key != "type" and has_key(rule, key):
                    raise PolicyFileError(
                        path, f"{key}: a [[refuse]] has no limits; only an [[allow]] does"
                    )
        for rule in (*policy.allow, *policy.refuse):
            unknown = sorted(set(listed(rule.who)) - known)
            if unknown:
                raise PolicyFileError(
                    path, f"a rule names {unknown[0]!r}, but there is no such [[who]]"
                )
        return msgspec.structs.replace(policy, path=path)

    @classmethod
    def default(
        cls,
        *,
        allow_write: bool = False,
        limits: Limits = Limits(),  # noqa: B008  # frozen
        assets: Iterable[str] = (),
    ) -> Policy:
        """Return the policy of a gateway without a policy file.

        Only programs on this host may connect. They may read everything and write nothing.

        Args:
            allow_write: Whether these programs may also publish, call, send goals, set parameters
                and offer services. Velocities are then published by lease.
            limits: The limits for all clients.
            assets: The packages whose files they read.
        """
        everything = "/**"
        writing: dict[str, Any] = dict.fromkeys(WRITING, everything)
        allow, refuse = [Rule(see=everything, subscribe=everything)], []
        files = [f"/{package}/**" for package in assets]
        if files:
            allow.append(Rule(asset=files))
        else:
            refuse.append(Rule(asset=everything, because=NO_ASSETS))
        if allow_write:
            allow.append(Rule(publish=everything, type=COMMANDS, lease=LeaseRule(ttl_sec=0.5)))
            allow.append(Rule(**writing))
        else:
            refuse.append(Rule(**writing, because=READ_ONLY))
        who = [Who("local", loopback=True)]
        return cls(who=who, allow=allow, refuse=refuse, limits=limits)

    @property
    def knows_secrets(self) -> bool:
        """Whether clients on other hosts can be identified, by a token or certificate."""
        return any(who.has_secret for who in self.who)

    @property
    def page_origins(self) -> frozenset[str]:
        """The origins of pages that may connect."""
        return frozenset([*self.origins, *(who.origin for who in self.who if who.origin)])

    def identify(self, credentials: Credentials) -> Identity:
        """Return the identity of a client.

        Raises:
            RefusedError: it presents nothing that the policy knows, or a wrong token, or it is a
                page of another origin; the code is ``unauthorized``.
        """
        check_browser(credentials, self.hosts, self.page_origins)
        fitting = [who for who in self.who if who.fits(credentials)]
        # A token or certificate says more about a client than the fact that it runs on this host.
        fitting.sort(key=lambda who: not who.has_secret)
        if credentials.token and not any(who.has_token(credentials.token) for who in fitting):
            fitting = []
        if not fitting:
            what = "its token is unknown" if credentials.token else "it presents no valid token"
            raise RefusedError(
                f"client of {credentials.address or 'an unknown address'}",
                f"{what}; send `Authorization: Bearer TOKEN` with one of the policy",
                "unauthorized",
            )
        client = fitting[0]
        return Identity(client.name, frozenset(client.groups), credentials.address)

    def named(self, name: str, address: str = "") -> Identity | None:
        """Return the client of a name, with its groups; None if no ``[[who]]`` has the name."""
        for who in self.who:
            if who.name == name:
                return Identity(name, frozenset(who.groups), address)
        return None

    def decide(
        self,
        identity: Identity,
        verb: Verb,
        name: str,
        type_name: str,
        message: Any = None,
        *,
        private: bool = False,
    ) -> Decision:
        """Decide whether a client's request is allowed, and within which limits.

        Args:
            identity: The client.
            verb: What the client wants to do.
            name: The full name of the topic, service, action, node or parameter.
            type_name: The name of its type; empty for nodes and parameters, and while it is not
                known.
            message: The message or mapping that the client sends; None before there is one.
            private: Whether only rules with the exact name, and no pattern, can allow it.
        """
        if len(name) > MAX_CHARACTERS:
            return Decision(allowed=False, reason="the name is too long", code="too_large")
        rule = first_rule(self, identity, verb, name, type_name, private=private)
        if rule is None or rule in self.refuse:
            because = rule.because if rule is not None else ""
            reason = because or f"the policy does not allow {identity.name} to do this"
            return Decision(allowed=False, reason=reason)
        if message is None:
            return Decision(allowed=True, rule=rule)
        try:
            if rule.needs_finite(type_name):
                check_finite(message)
            return Decision(allowed=True, message=limited(message, rule.fields), rule=rule)
        except OutOfLimitsError as error:
            return Decision(allowed=False, reason=str(error), code="out_of_limits", rule=rule)


@lru_cache(maxsize=MAX_REMEMBERED)
def first_rule(
    policy: Policy,
    identity: Identity,
    verb: Verb,
    name: str,
    type_name: str,
    *,
    private: bool = False,
) -> Rule | None:
    """Return the rule that decides: the first matching refusal, otherwise the first that allows.

    A client sees what it may use, and may not use what it may not see. A node is visible to those
    who may see it or set its parameters; a rule about topics or files of the same name does not
    matter.
    """
    refusing: tuple[Verb, ...] = (verb,) if verb in {"see", "asset"} else (verb, "see")
    for rule in policy.refuse:
        if rule.type and not type_name:  # not known yet: the request is checked again when it is
            continue
        if rule.is_about(identity) and any(rule.covers(v, name, type_name) for v in refusing):
            return rule
    allowing: tuple[Verb, ...] = (verb,)
    if verb == "see":
        allowing = NAMING if type_name else UNTYPED
    for rule in policy.allow:
        if verb == "see" and rule.type and not type_name:
            continue
        if private and not any(name in listed(getattr(rule, v)) for v in allowing):
            continue
        if rule.is_about(identity) and any(rule.covers(v, name, type_name) for v in allowing):
            return rule
    return None


def check_origins(origins: Iterable[str]) -> None:
    """Refuse an origin that cannot identify a page.

    Raises:
        ValueError: an origin is not written as browsers do, or is ``null``, the origin of any
            sandboxed page.
    """
    for origin in origins:
        if origin == "null":
            raise ValueError("origin 'null': every sandboxed page has it; name a real one")
        is_default = re.fullmatch("http://.*:80|https://.*:443", origin)
        if is_default or not ORIGIN.fullmatch(origin):
            raise ValueError(
                f"origin {origin!r}: write it as browsers do, such as https://dash.example or "
                "http://dash.example:3000: in lower case, without a path or the default port"
            )


# Names


def listed(names: Names) -> list[str]:
    """Return one name, or several, as a list."""
    return [names] if isinstance(names, str) else names


def matches(globs: Names, name: str) -> bool:
    """Return whether a name matches one of several; one without a colon matches all parameters."""
    node = name.partition(":")[0]
    return any(
        pattern_of(glob).fullmatch(name if ":" in glob else node) is not None
        for glob in listed(globs)
    )


def matches_type(globs: Names, type_name: str) -> bool:
    """Return whether a type matches; an empty list matches all types."""
    return not globs or any(pattern_of(glob).fullmatch(type_name) for glob in listed(globs))


@lru_cache(maxsize=MAX_REMEMBERED)
def pattern_of(glob: str) -> re.Pattern[str]:
    """Return the regular expression for a name with ``*`` and ``**``."""
    parts = {"**": ".*", "*": "[^/]*", "?": "[^/]"}
    tokens = re.split(r"(\*\*|\*|\?)", glob)
    return re.compile("".join(parts.get(token, re.escape(token)) for token in tokens), re.DOTALL)
