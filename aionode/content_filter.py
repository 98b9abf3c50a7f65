"""Filters over the fields of messages, in the language of DDS: ``temperature > %0 AND NOT stale``.

The grammar is that of the DDS specification (OMG DDS 1.4, Annex B.2, "FilterExpression"), which
ROS 2 passes to its middleware::

    condition   predicate | condition AND condition | condition OR condition
                | NOT condition | ( condition )
    predicate   term (= | <> | != | > | >= | < | <=) term
                | field LIKE text | field [NOT] BETWEEN literal AND literal
    term        field | literal
    field       name { . name } [ "[" index "]" ]
    literal     5 | 0x1F | -2.5e3 | 'text' | TRUE | FALSE | %0 … %99

NOT binds more tightly than AND, and AND more tightly than OR. Keywords are not
case-sensitive. In LIKE, ``%`` matches any text and ``_`` one character. A parameter, such as
``%0``, stands for a literal that is passed separately, as text.
"""

from __future__ import annotations

import operator
import re
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from msgspec import Struct, field

from aionode.errors import ContentFilterError
from aionode.message import fields, type_name

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from aionode.message import FieldType, Message

__all__ = ["ContentFilterOptions", "compile_filter"]

MAX_PARAMETERS: Final = 100
"""The number of parameters that the grammar has names for."""

MAX_DIGITS: Final = 400
"""The longest number, in characters; Python itself rejects much longer ones with its own error."""

MAX_DEPTH: Final = 50
"""The deepest nesting of parentheses and NOT."""


class ContentFilterOptions(Struct):
    """Selects the messages that a subscription receives; the attributes have rclpy's names.

    Attributes:
        filter_expression: A condition over the fields of the message; empty for all messages.
        expression_parameters: Literals for ``%0``, ``%1`` and so on, as text: ``"5"``, ``"'on'"``.
    """

    filter_expression: str = ""
    expression_parameters: list[str] = field(default_factory=list)


OPERATORS: Final[dict[str, Callable[[Any, Any], bool]]] = {
    "=": operator.eq,
    "<>": operator.ne,
    "!=": operator.ne,
    ">": operator.gt,
    ">=": operator.ge,
    "<": operator.lt,
    "<=": operator.le,
}

TOKEN: Final = re.compile(
    r"""\s*(?:
        (?P<number>[+-]?(?:0[xX][0-9a-fA-F]+|(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?))
      | (?P<string>'(?:[^'\\]|\\.)*')
      | (?P<parameter>%\d{1,2})
      | (?P<name>[A-Za-z_]\w*(?:\[\d+\])?(?:\.[A-Za-z_]\w*(?:\[\d+\])?)*)
      | (?P<operator><>|!=|>=|<=|=|>|<|\(|\))
    )""",
    re.VERBOSE,
)

WORDS: Final = frozenset({"and", "or", "not", "like", "between", "true", "false"})


class Token(NamedTuple):
    """One token of an expression; `kind` is a group of `TOKEN`, ``word``, or ``end``."""

    kind: str
    text: str
    position: int


class Operand(NamedTuple):
    """One side of a comparison.

    Attributes:
        kind: ``number``, ``text`` or ``truth``; only operands of one kind can be compared.
        get: Returns its value for a message.
        text: Its text in the expression.
        is_field: Whether its value depends on the message.
    """

    kind: str
    get: Callable[[Any], Any]
    text: str
    is_field: bool


def compile_filter(
    msg_type: type[Message],
    filter_expression: str,
    expression_parameters: Sequence[str] = (),
) -> Callable[[Any], bool]:
    """Compile a filter to a predicate that is true for messages which pass.

    Args:
        msg_type: The class of the messages.
        filter_expression: The condition.
        expression_parameters: The literals that ``%0``, ``%1`` and so on stand for.

    Raises:
        ContentFilterError: the expression is malformed, names a field that the message does not
            have, or compares operands of different kinds; the text says what and where.
        TypeError: a parameter is not a str.
    """
    return Parser(msg_type, filter_expression, expression_parameters).parse()


def tokens_of(expression: str) -> list[Token]:
    """Split an expression into tokens, with an end token last.

    Raises:
        ContentFilterError: something is not a token of the grammar.
    """
    tokens = []
    position = 0
    end = len(expression.rstrip())
    while position < end:
        match = TOKEN.match(expression, position)
        if match is None:
            rest = expression[position:].lstrip()
            raise ContentFilterError(
                expression, len(expression) - len(rest), f"{rest[:10]!r} is not understood"
            )
        kind = str(match.lastgroup)
        text = match.group(kind)
        if kind == "name" and text.lower() in WORDS:
            kind, text = "word", text.lower()
        tokens.append(Token(kind, text, match.start(str(match.lastgroup))))
        position = match.end()
    return [*tokens, Token("end", "the end", end)]


class Parser:
    """A recursive-descent parser of one expression, with a method for each rule of the grammar."""

    def __init__(self, msg_type: type[Message], expression: str, parameters: Sequence[str]) -> None:
        if len(parameters) > MAX_PARAMETERS:
            raise ContentFilterError(
                expression, 0, f"{len(parameters)} parameters given; at most {MAX_PARAMETERS} fit"
            )
        for index, parameter in enumerate(parameters):
            if not isinstance(parameter, str):
                raise TypeError(
                    f"filter parameter %{index}: {parameter!r} is not a string; write '5'"
                )
        self._msg_type = msg_type
        self._expression = expression
        self._parameters = parameters
        self._tokens = tokens_of(expression)
        self._next = 0
        self._depth = 0

    # Tokens

    @property
    def _token(self) -> Token:
        return self._tokens[self._next]

    def _take(self) -> Token:
        token = self._token
        self._next += token.kind != "end"
        return token

    def _took(self, kind: str, text: str) -> bool:
        """Consume the next token if it is this one."""
        if (self._token.kind, self._token.text) != (kind, text):
            return False
        self._next += 1
        return True

    def _expect(self, kind: str, text: str) -> None:
        if not self._took(kind, text):
            self._fail(f"expected {text.upper()}, got {self._token.text}")

    def _fail(self, problem: str, token: Token | None = None) -> Any:
        position = (self._token if token is None else token).position
        raise ContentFilterError(self._expression, position, problem)

    # Rules

    def parse(self) -> Callable[[Any], bool]:
        """Return the whole condition."""
        condition = self._or()
        if self._token.kind != "end":
            self._fail(f"expected AND, OR or the end, got {self._token.text}")
        return condition

    def _or(self) -> Callable[[Any], bool]:
        conditions = [self._and()]
        while self._took("word", "or"):
            conditions.append(self._and())
        if len(conditions) == 1:
            return conditions[0]
        return lambda msg: any(condition(msg) for condition in conditions)

    def _and(self) -> Callable[[Any], bool]:
        conditions = [self._not()]
        while self._took("word", "and"):
            conditions.append(self._not())
        if len(conditions) == 1:
            return conditions[0]
        return lambda msg: all(condition(msg) for condition in conditions)

    def _not(self) -> Callable[[Any], bool]:
        self._depth += 1
        if self._depth > MAX_DEPTH:
            self._fail(f"nested more than {MAX_DEPTH} deep")
        try:
            if self._took("word", "not"):
                condition = self._not()
                return lambda msg: not condition(msg)
            if self._took("operator", "("):
                condition = self._or()
                self._expect("operator", ")")
                return condition
            return self._predicate()
        finally:
            self._depth -= 1

    def _predicate(self) -> Callable[[Any], bool]:
        first = self._next
        condition = self._comparing()
        if any("[" in token.text for token in self._tokens[first : self._next]):
            return false_without_elements(condition)
        return condition

    def _comparing(self) -> Callable[[Any], bool]:
        start = self._token
        left = self._operand()
        if self._took("word", "not"):
            between = self._between(left, start)
            return lambda msg: not between(msg)
        if self._token == Token("word", "between", self._token.position):
            return self._between(left, start)
        if self._took("word", "like"):
            return self._like(left, start)
        symbol = self._take()
        if symbol.text not in OPERATORS:
            self._fail(f"expected a comparison such as = or <, got {symbol.text}", symbol)
        right = self._operand()
        if not (left.is_field or right.is_field):
            self._fail(f"{left.text} {symbol.text} {right.text} compares no field", start)
        return self._comparison(left, symbol, right)

    def _comparison(self, left: Operand, symbol: Token, right: Operand) -> Callable[[Any], bool]:
        self._check_kinds(left, right, symbol)
        if left.kind == "truth" and symbol.text not in {"=", "<>", "!="}:
            self._fail(f"{left.text} {symbol.text}: true and false have no order", symbol)
        compare, get_left, get_right = OPERATORS[symbol.text], left.get, right.get
        if right.is_field:
            return lambda msg: compare(get_left(msg), get_right(msg))
        constant = get_right(None)
        return lambda msg: compare(get_left(msg), constant)

    def _between(self, value: Operand, start: Token) -> Callable[[Any], bool]:
        self._expect("word", "between")
        low = self._operand()
        self._expect("word", "and")
        high = self._operand()
        if not value.is_field or low.is_field or high.is_field:
            self._fail("BETWEEN takes a field, and two literals", start)
        for bound in (low, high):
            self._check_kinds(value, bound, start)
        get, least, most = value.get, low.get(None), high.get(None)
        return lambda msg: bool(least <= get(msg) <= most)

    def _like(self, value: Operand, start: Token) -> Callable[[Any], bool]:
        pattern = self._operand()
        if not value.is_field or pattern.is_field or {value.kind, pattern.kind} != {"text"}:
            self._fail("LIKE takes a string field and a pattern such as 'a%'", start)
        like, get = LikePattern(pattern.get(None)), value.get
        return lambda msg: like.matches(get(msg))

    def _check_kinds(self, left: Operand, right: Operand, where: Token) -> None:
        if left.kind != right.kind:
            self._fail(
                f"{left.text} is a {left.kind}, {right.text} a {right.kind}; only values of one "
                "kind can be compared",
                where,
            )

    # Operands

    def _operand(self) -> Operand:
        token = self._take()
        if token.kind == "name":
            return self._field(token)
        if token.kind == "parameter":
            return self._parameter(token)
        operand = literal(token)
        if operand is None:
            self._fail(f"expected a field or a literal, got {token.text}", token)
        return operand  # type: ignore[return-value]  # _fail raises

    def _parameter(self, token: Token) -> Operand:
        index = int(token.text[1:])
        if index >= len(self._parameters):
            self._fail(
                f"{token.text} has no value: {len(self._parameters)} parameters given", token
            )
        text = self._parameters[index]
        try:
            first, *rest = tokens_of(text)
        except ContentFilterError:
            first, rest = Token("end", "", 0), []
        operand = literal(first) if len(rest) == 1 else None
        if operand is None:
            self._fail(
                f"{token.text} is {text!r}, not a literal; write a number, TRUE, FALSE or "
                "\"'text'\"",
                token,
            )
        return operand  # type: ignore[return-value]  # _fail raises

    def _field(self, token: Token) -> Operand:
        cls: type[Message] | None = self._msg_type
        names: list[str | int] = []
        type_: FieldType | None = None
        for part in re.findall(r"\w+|\[\d+\]", token.text):
            if part.startswith("["):
                type_ = self._element(token, type_, part)
                names.append(int(part[1:-1]))
                continue
            if cls is None or (type_ is not None and type_.container != "single"):
                self._fail(f"{token.text}: {names[-1]} has no fields", token)
                break
            type_ = next((field.type for field in fields(cls) if field.name == part), None)
            if type_ is None:
                known = ", ".join(field.name for field in fields(cls))
                self._fail(f"{type_name(cls)} has no field {part!r}; it has: {known}", token)
                break
            names.append(part)
            cls = type_.nested
        assert type_ is not None  # noqa: S101  # a name has at least one part
        if type_.container != "single" or type_.nested is not None:
            self._fail(f"{token.text} is {type_}; name a number, a string or a bool in it", token)
        get = getter(names)
        if type_.kind == "byte" and isinstance(names[-1], str):  # bytes of length 1
            return Operand("number", lambda msg: get(msg)[0], token.text, is_field=True)
        return Operand(kind_of(type_), get, token.text, is_field=True)

    def _element(self, token: Token, type_: FieldType | None, part: str) -> FieldType:
        if type_ is None or type_.container == "single":
            self._fail(f"{token.text}: only arrays and sequences have {part}", token)
        assert type_ is not None  # noqa: S101  # _fail raises
        if type_.container == "array" and int(part[1:-1]) >= type_.size:
            self._fail(f"{token.text}: the array has {type_.size} elements", token)
        return type_.element


def kind_of(type_: FieldType) -> str:
    """Return the kind of values that a field can be compared with."""
    if type_.kind in {"string", "wstring"}:
        return "text"
    return "truth" if type_.kind == "bool" else "number"


def literal(token: Token) -> Operand | None:
    """Return the operand of a literal; None if the token is not a literal."""
    value: object
    if token.kind == "number":
        if len(token.text) > MAX_DIGITS:
            return None
        text = token.text.lower()
        is_int = "x" in text or not set(text) & set(".e")
        value = int(text, 0 if "x" in text else 10) if is_int else float(text)
        kind = "number"
    elif token.kind == "string":
        kind, value = "text", re.sub(r"\\(.)", r"\1", token.text[1:-1])
    elif token.kind == "word" and token.text in {"true", "false"}:
        kind, value = "truth", token.text == "true"
    else:
        return None
    return Operand(kind, lambda _: value, token.text, is_field=False)


def getter(names: list[str | int]) -> Callable[[Any], Any]:
    """Return a function that reads a field of a message, following nested messages and indexes.

    It raises IndexError for an element that the message does not have.
    """
    if all(isinstance(name, str) for name in names):
        return operator.attrgetter(".".join(map(str, names)))

    def get(msg: Any) -> Any:
        value = msg
        for name in names:
            value = getattr(value, name) if isinstance(name, str) else value[name]
        return value.item() if hasattr(value, "item") else value

    return get


def false_without_elements(condition: Callable[[Any], bool]) -> Callable[[Any], bool]:
    """Wrap a predicate so that it is false for messages which lack the elements it names."""

    def holds(msg: Any) -> bool:
        try:
            return condition(msg)
        except IndexError:
            return False

    return holds


class LikePattern:
    """A pattern of LIKE, in which ``%`` stands for any text and ``_`` for one character.

    A piece after a ``%`` is matched at its first occurrence, without backtracking, so the work is
    bounded by the length of the text times the number of pieces.
    """

    def __init__(self, pattern: str) -> None:
        self._first, *self._rest = map(LikePiece, pattern.split("%"))

    def matches(self, text: str) -> bool:
        """Return whether the whole text matches the pattern."""
        if not self._first.fits(text, 0):
            return False
        at = self._first.length
        if not self._rest:
            return at == len(text)
        *middle, last = self._rest
        for piece in middle:
            position = piece.find(text, at)
            if position < 0:
                return False
            at = position + piece.length
        end = len(text) - last.length
        return at <= end and last.fits(text, end)


class LikePiece:
    """The part of a pattern between two ``%``: literal characters and single-character wildcards.

    Attributes:
        length: How many characters it matches.
    """

    def __init__(self, piece: str) -> None:
        self.length = len(piece)
        self._literals = [(match.start(), match[0]) for match in re.finditer("[^_]+", piece)]
        self._longest = max(self._literals, key=lambda literal: len(literal[1]), default=(0, ""))

    def fits(self, text: str, at: int) -> bool:
        """Return whether the piece matches at this position of a text."""
        return at + self.length <= len(text) and all(
            text.startswith(literal, at + offset) for offset, literal in self._literals
        )

    def find(self, text: str, at: int) -> int:
        """Return the first position of the piece at or after `at`, or -1."""
        offset, literal = self._longest
        while at + self.length <= len(text):
            at = text.find(literal, at + offset) - offset
            if at < 0 or self.fits(text, at):
                return max(at, -1)
            at += 1
        return -1
