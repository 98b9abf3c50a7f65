"""Who may do what with the robot: rules, as a person reviews them in a file.

A rule names who it is about, what they may do with which names, and within which limits. What no
rule allows is refused, and ``[[refuse]]`` has precedence over ``[[allow]]``.
"""

from __future__ import annotations

import hashlib
import hmac
import math
import re
from collections.abc import Iterable
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Literal, TypeAlias

import msgspec

from aionode.errors import PolicyFileError, RefusedError
from aionode.gateway._field_limits import FieldLimit, OutOfLimitsError, limited
from aionode.gateway._identity import Credentials, Identity, check_browser

if TYPE_CHECKING:
    from os import PathLike


__all__ = ["Decision", "FieldLimit", "LeaseRule", "Limits", "Policy", "Rule", "Tls", "Verb", "Who"]

Verb: TypeAlias = Literal["see", "subscribe", "publish", "call", "goal", "parameter", "advertise"]
"""What a client does with a name; ``parameter`` sets one, and to read one is to ``see`` it."""

Names: TypeAlias = str | list[str]

VERBS: Final[tuple[Verb, ...]] = (
    "see",
    "subscribe",
    "publish",
    "call",
    "goal",
    "parameter",
    "advertise",
)
WRITING: Final[tuple[Verb, ...]] = ("publish", "call", "goal", "parameter", "advertise")

UNTYPED: Final[tuple[Verb, ...]] = ("see", "parameter")
"""The verbs about nodes and parameters, which have no type."""

LIMITED: Final[dict[str, tuple[Verb, ...]]] = {
    "type": ("see", "subscribe", "publish", "call", "goal", "advertise"),
    "rate_hz": ("subscribe", "publish", "call", "goal", "parameter", "advertise"),
    "max_bytes": ("publish", "call", "goal"),
    "fields": ("publish", "call", "goal", "parameter"),
    "ask": ("subscribe", "publish", "call", "goal", "parameter", "advertise"),
    "lease": ("publish",),
}
"""The keys of a rule that limit what it allows, and the verbs that each of them can limit."""

COMMANDS: Final = ["geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped"]
"""Types whose default message stops a robot: without a policy file they are published by lease."""

MOST_REMEMBERED: Final = 4096
"""How many answers to who may do what are kept."""

MOST_CHARACTERS: Final = 1000
"""The longest name that is looked for in rules, in characters."""


ORIGIN: Final = re.compile(
    r"file://|[a-z][a-z0-9+.-]*://(\[[0-9a-f:.]+\]|[a-z0-9_.-]+)(:[0-9]{1,5})?"
)
"""The origin of a page, as browsers write it."""


class Part(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A part of a policy file: a key that nobody knows is an error, not a rule without effect."""


class LeaseRule(Part, frozen=True):
    """How commands of a topic are published: one holder at a time, and a stop when it ends.

    Attributes:
        ttl_sec: For how long the holder may publish nothing, in seconds.
        priority: A client takes the topic from a holder of lower priority.
        max_age_sec: How old a command may be by its stamp, or since it arrived, in seconds.
        stop: The message that stops what the commands move; its other fields have their defaults.
    """

    ttl_sec: float = 0.3
    priority: int = 0
    max_age_sec: float = 0.5
    stop: dict[str, Any] = {}

    def __post_init__(self) -> None:
        if not 0 < self.ttl_sec < math.inf or not self.max_age_sec > 0:
            raise ValueError("ttl_sec and max_age_sec are numbers of seconds above 0")


class Rule(Part, frozen=True):
    """One ``[[allow]]`` or ``[[refuse]]``.

    Names are full and may have ``*`` for a part without a slash, and ``**`` for anything.

    Attributes:
        who: Names and groups that it is about; everyone if empty.
        see: What they see: names of topics, services, actions and nodes, and ``/node:parameter``.
        subscribe: Topics that they may subscribe to.
        publish: Topics that they may publish to.
        call: Services that they may call.
        goal: Actions that they may send goals to.
        parameter: Parameters that they may set, as ``/node:parameter``; ``/node`` for all of it.
        advertise: Services and actions that they may offer themselves.
        type: The types that it is about; all if empty.
        rate_hz: How often, for each of the names; a second's worth may come at once.
        max_bytes: The largest message, in bytes of CDR.
        fields: Limits of fields, by their paths such as ``linear.x``.
        ask: Whether a person has to say yes each time.
        lease: How commands are published.
        because: What a refused client is told.
    """

    who: Names = []
    see: Names = []
    subscribe: Names = []
    publish: Names = []
    call: Names = []
    goal: Names = []
    parameter: Names = []
    advertise: Names = []
    type: Names = []
    rate_hz: float = math.inf
    max_bytes: int | None = None
    fields: dict[str, FieldLimit] = {}
    ask: bool = False
    lease: LeaseRule | None = None
    because: str = ""

    def __post_init__(self) -> None:
        for verb in VERBS:
            for name in listed(getattr(self, verb)):
                if not name.startswith(("/", "**")):
                    raise ValueError(f"{verb}: {name!r} is no full name; begin it with a slash")
        if not self.rate_hz > 0:
            raise ValueError("rate_hz is a number of messages a second, above 0")
        for key, verbs in LIMITED.items():
            without = [verb for verb in VERBS if getattr(self, verb) and verb not in verbs]
            if without and self.has(key):
                raise ValueError(
                    f"{key}: it limits {', '.join(verbs)}, and not {without[0]}; write a rule of "
                    f"its own for {without[0]}"
                )

    def has(self, key: str) -> bool:
        """Return whether a key of `LIMITED` is given."""
        value = getattr(self, key)
        return value != math.inf if key == "rate_hz" else value not in (None, False, "", [], {})

    def is_about(self, identity: Identity) -> bool:
        """Return whether the rule names a client, or nobody and so everyone."""
        who = listed(self.who)
        return not who or identity.name in who or not identity.groups.isdisjoint(who)

    def covers(self, verb: Verb, name: str, type_name: str) -> bool:
        """Return whether the rule is about doing this with that name."""
        if type_name and not matches_type(self.type, type_name):
            return False
        return matches(getattr(self, verb), name)


class Who(Part, frozen=True):
    """A client that the policy knows: all that is given here has to be true of it.

    Attributes:
        name: Its name.
        groups: Groups of clients, for rules about several.
        token: A secret that the client shows.
        token_sha256: The SHA-256 of that secret in hexadecimal, in place of it.
        certificate: The common name of its TLS certificate.
        origin: The origin of the page; on its own it counts on loopback only, as programs may
            claim any.
        loopback: Whether the client runs on this host, where every user of the host may connect.
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
            raise ValueError(f"who {self.name!r}: token_sha256 has 64 hexadecimal digits")

    @property
    def has_secret(self) -> bool:
        """Whether something that nobody else has tells the client from others."""
        return bool(self.token or self.token_sha256 or self.certificate)

    def has_token(self, token: str) -> bool:
        """Return whether a token is the client's, in the same time for all that are not."""
        wanted = self.token_sha256.lower() or hashlib.sha256(self.token.encode()).hexdigest()
        given = hashlib.sha256(token.encode("utf-8", "replace")).hexdigest()
        return bool(self.token or self.token_sha256) and hmac.compare_digest(wanted, given)

    def fits(self, credentials: Credentials) -> bool:
        """Return whether all that is given here is true of a client."""
        if (self.token or self.token_sha256) and not self.has_token(credentials.token):
            return False
        if self.certificate and self.certificate != credentials.certificate:
            return False
        if self.origin and self.origin != credentials.origin:
            return False
        return credentials.is_loopback or (self.has_secret and not self.loopback)


class Limits(Part, frozen=True):
    """How much there may be of what clients cause.

    Attributes:
        clients: Connections at once.
        frame_bytes: The largest frame or request of a client.
        frames_per_sec: How many frames a client may send a second.
        queued_bytes: How much may wait for one client; beyond it the oldest is dropped.
        subscriptions: For each client.
        advertised: Topics, services and actions that one client offers.
        calls: Calls and goals of one client at once.
        handshake_sec: How long a request may take to arrive, and for how long the client may read
            nothing of the answer, in seconds.
        client_lost_sec: After how long without a sign a client with goals or commands is lost, in
            seconds.
    """

    clients: int = 64
    frame_bytes: int = 1_000_000
    frames_per_sec: float = 2_000.0
    queued_bytes: int = 64 << 20
    subscriptions: int = 256
    advertised: int = 64
    calls: int = 64
    handshake_sec: float = 10.0
    client_lost_sec: float = 3.0


class Tls(Part, frozen=True):
    """The files of TLS, in PEM.

    Attributes:
        certificate: The certificate of the gateway, with those of its authorities.
        key: Its private key.
        clients: The authorities of clients' certificates; empty to ask for none.
    """

    certificate: str
    key: str
    clients: str = ""


class Decision(msgspec.Struct, frozen=True):
    """What the policy says about one thing that a client wants to do.

    Attributes:
        allowed: Whether it may.
        reason: Why not; empty if it may.
        code: The reason as a word for programs, as in `RefusedError`.
        message: The message that was given, with its fields within their limits.
        rule: The rule that allows it.
    """

    allowed: bool
    reason: str = ""
    code: str = "not_allowed"
    message: Any = None
    rule: Rule | None = None

    @property
    def ask(self) -> bool:
        """Whether a person has to say yes."""
        return self.rule is not None and self.rule.ask

    @property
    def lease(self) -> LeaseRule | None:
        """How commands are published, if the rule says so."""
        return None if self.rule is None else self.rule.lease


class Policy(Part, frozen=True):
    """Who may do what. Made by `load` or `default`, and asked by sessions.

    Attributes:
        who: The clients that it knows.
        allow: What they may do; of several rules the first that covers it counts.
        refuse: What they may not do, whatever `allow` says.
        hosts: Names of this machine, beside addresses and ``localhost``.
        origins: Origins of pages that may connect, beside the gateway's own page.
        limits: How much there may be.
        tls: The certificate of the gateway; None for connections without TLS.
        audit_file: The file of the audit log; empty for none.
        path: The file that it was read from; empty if it was not.
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
                raise ValueError(f"hosts: {host!r} is no name alone; leave out scheme and port")

    # A frozen struct has no place for what it remembers: see `first_rule`.
    def __hash__(self) -> int:
        return id(self)

    def __eq__(self, other: object) -> bool:
        return self is other

    @classmethod
    def load(cls, path: str | PathLike[str]) -> Policy:
        """Return the policy of a TOML file.

        Raises:
            PolicyFileError: the file cannot be read, or is not a policy (a ValueError).
        """
        try:
            return cls.parse(Path(path).read_bytes(), str(path))
        except OSError as error:
            raise PolicyFileError(str(path), f"cannot be read: {error.strerror}") from error

    @classmethod
    def parse(cls, text: str | bytes, path: str = "") -> Policy:
        """Return the policy of a TOML text; `path` is named in errors.

        Raises:
            PolicyFileError: the text is not a policy (a ValueError).
        """
        try:
            found = msgspec.toml.decode(text, type=cls)
        except (msgspec.DecodeError, ValueError) as error:
            raise PolicyFileError(path, str(error)) from error
        if found.path:
            raise PolicyFileError(path, "`path` is no key of a policy")
        known = {each.name for each in found.who}
        known |= {group for each in found.who for group in each.groups}
        for rule in found.refuse:
            for key in LIMITED:
                if key != "type" and rule.has(key):
                    raise PolicyFileError(
                        path, f"{key}: a [[refuse]] has no limits, an [[allow]] has"
                    )
        for rule in (*found.allow, *found.refuse):
            unknown = sorted(set(listed(rule.who)) - known)
            if unknown:
                raise PolicyFileError(path, f"a rule is about {unknown[0]!r}, which no [[who]] is")
        return msgspec.structs.replace(found, path=path)

    @classmethod
    def default(cls, *, allow_write: bool = False) -> Policy:
        """Return the policy without a file: this host only, which reads all and writes nothing.

        Args:
            allow_write: Whether it may also publish, call, send goals, set parameters and offer
                services; velocities are published by lease.
        """
        everything = "/**"
        allow = [Rule(see=everything, subscribe=everything)]
        if allow_write:
            allow.append(Rule(publish=everything, type=COMMANDS, lease=LeaseRule(ttl_sec=0.5)))
            allow.append(Rule(**dict.fromkeys(WRITING, everything)))  # type: ignore[arg-type]
        return cls(who=[Who("local", loopback=True)], allow=allow)

    @property
    def knows_secrets(self) -> bool:
        """Whether a client of another host can be known, by a token or certificate."""
        return any(who.has_secret for who in self.who)

    @property
    def page_origins(self) -> frozenset[str]:
        """The origins of pages that may connect."""
        return frozenset([*self.origins, *(who.origin for who in self.who if who.origin)])

    def identify(self, credentials: Credentials) -> Identity:
        """Return who a client is.

        Raises:
            RefusedError: it shows nothing that the policy knows, a wrong token, or it is a page of
                another origin; its code is ``unauthorized``.
        """
        check_browser(credentials, self.hosts, self.page_origins)
        fitting = [who for who in self.who if who.fits(credentials)]
        # A token or certificate says more about a client than that it runs on this host.
        fitting.sort(key=lambda who: not who.has_secret)
        if credentials.token and not any(who.has_token(credentials.token) for who in fitting):
            fitting = []
        if not fitting:
            what = "its token is not known" if credentials.token else "it shows no token that fits"
            raise RefusedError(
                f"client of {credentials.address or 'an unknown address'}",
                f"{what}; send `Authorization: Bearer TOKEN` with one of the policy",
                "unauthorized",
            )
        found = fitting[0]
        return Identity(found.name, frozenset(found.groups), credentials.address)

    def decide(
        self, identity: Identity, verb: Verb, name: str, type_name: str, message: Any = None
    ) -> Decision:
        """Return whether a client may do something, and within which limits.

        Args:
            identity: The client.
            verb: What it wants to do.
            name: With what: a full name.
            type_name: The name of its type; empty for nodes and parameters.
            message: What it sends: a message or a mapping; None to ask before there is one.
        """
        if len(name) > MOST_CHARACTERS:
            return Decision(allowed=False, reason="the name is too long", code="too_large")
        rule = first_rule(self, identity, verb, name, type_name)
        if rule is None or rule in self.refuse:
            because = rule.because if rule is not None else ""
            reason = because or f"the policy does not allow {identity.name} to do this"
            return Decision(allowed=False, reason=reason)
        if message is None or not rule.fields:
            return Decision(allowed=True, message=message, rule=rule)
        try:
            return Decision(allowed=True, message=limited(message, rule.fields), rule=rule)
        except OutOfLimitsError as error:
            return Decision(allowed=False, reason=str(error), code="out_of_limits", rule=rule)


@lru_cache(maxsize=MOST_REMEMBERED)
def first_rule(
    policy: Policy, identity: Identity, verb: Verb, name: str, type_name: str
) -> Rule | None:
    """Return the rule that decides: the first that refuses, else the first that allows.

    A client sees what it may use, and may not use what it may not see. A node is seen by who may
    see it, or set its parameters: a rule about topics of the same name says nothing about it.
    """
    refusing: tuple[Verb, ...] = (verb,) if verb == "see" else (verb, "see")
    for rule in policy.refuse:
        if rule.type and not type_name:  # not yet known: the question comes again with it
            continue
        if rule.is_about(identity) and any(rule.covers(v, name, type_name) for v in refusing):
            return rule
    allowing: tuple[Verb, ...] = (verb,)
    if verb == "see":
        allowing = VERBS if type_name else UNTYPED
    for rule in policy.allow:
        if verb == "see" and rule.type and not type_name:
            continue
        if rule.is_about(identity) and any(rule.covers(v, name, type_name) for v in allowing):
            return rule
    return None


def check_origins(origins: Iterable[str]) -> None:
    """Refuse an origin that no page has which may be told from others.

    Raises:
        ValueError: an origin is not written as browsers do, or is that of any page in a sandbox.
    """
    for origin in origins:
        if origin == "null":
            raise ValueError("origin 'null': every page in a sandbox has it; name a real one")
        is_default = re.fullmatch("http://.*:80|https://.*:443", origin)
        if is_default or not ORIGIN.fullmatch(origin):
            raise ValueError(
                f"origin {origin!r}: write it as browsers do, such as https://dash.example or "
                "http://dash.example:3000: in small letters, without a path or the usual port"
            )


# Names


def listed(names: Names) -> list[str]:
    """Return one name or several as a list."""
    return [names] if isinstance(names, str) else names


def matches(globs: Names, name: str) -> bool:
    """Return whether a name fits one of several; one without a colon stands for all parameters."""
    node = name.partition(":")[0]
    return any(
        pattern_of(glob).fullmatch(name if ":" in glob else node) is not None
        for glob in listed(globs)
    )


def matches_type(globs: Names, type_name: str) -> bool:
    """Return whether a type fits; no names fit all."""
    return not globs or any(pattern_of(glob).fullmatch(type_name) for glob in listed(globs))


@lru_cache(maxsize=MOST_REMEMBERED)
def pattern_of(glob: str) -> re.Pattern[str]:
    """Return the expression for a name with ``*`` and ``**``."""
    parts = {"**": ".*", "*": "[^/]*", "?": "[^/]"}
    tokens = re.split(r"(\*\*|\*|\?)", glob)
    return re.compile("".join(parts.get(token, re.escape(token)) for token in tokens), re.DOTALL)
