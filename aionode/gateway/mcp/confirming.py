"""Asking a person: how a policy rule with ``ask`` works for clients of MCP.

Clients of older revisions receive a request of its own. Those of 2026-07-28 receive the question as
the result of the call, and repeat the call with the answer.
"""

from __future__ import annotations

import asyncio
import json
import secrets
from typing import TYPE_CHECKING, Any, Final

import mcp_types as types
from mcp.shared.exceptions import MCPError
from mcp_types.version import MODERN_PROTOCOL_VERSIONS

from aionode._process.recent import Recent
from aionode.errors import escaped
from aionode.gateway.session.audit import shortened

if TYPE_CHECKING:
    from aionode.gateway.policy.identity import Identity
    from aionode.gateway.policy.policy import Verb
    from aionode.gateway.session.robot import Ask

__all__ = ["Asker", "Question", "Questions"]

ASK_SEC: Final = 120.0
"""How long to wait for a person's answer, in seconds."""

MAX_QUESTIONS: Final = 1000
"""Questions that may wait for an answer."""

KEY: Final = "confirm"
"""The key of the question in a result."""

SCHEMA: Final[dict[str, Any]] = {"type": "object", "properties": {}}
"""The form of the question: no fields, only yes or no."""


class Question(Exception):  # noqa: N818  # no error: it ends a call, which comes again
    """A question for a person, which has to be answered before the call is repeated.

    Attributes:
        text: The question.
        subject: The client, the action and its arguments, to which the answer applies.
    """

    def __init__(self, text: str, subject: str) -> None:
        self.text = text
        self.subject = subject
        super().__init__(text)


class Questions:
    """The questions whose answers arrive with the repeated call; each may be answered once."""

    def __init__(self) -> None:
        self._open: Recent[str, str] = Recent(MAX_QUESTIONS)

    def result(self, question: Question) -> types.InputRequiredResult:
        """Return the result that makes the client repeat the call with the answer."""
        state = secrets.token_urlsafe(16)
        self._open.put(state, question.subject)
        params = types.ElicitRequestFormParams(message=question.text, requested_schema=SCHEMA)
        request = types.ElicitRequest(params=params)
        return types.InputRequiredResult(input_requests={KEY: request}, request_state=state)

    def answer(self, params: types.CallToolRequestParams, subject: str) -> bool | None:
        """Return the answer that a repeated call contains for a question; None if it has none.

        An answer to another question, such as one about different arguments, does not count.
        """
        if params.request_state is None or not params.input_responses:
            return None
        if self._open.pop(params.request_state, None) != subject:
            return None
        given = params.input_responses.get(KEY)
        return isinstance(given, types.ElicitResult) and given.action == "accept"


class Asker:
    """Asks a person about one call; a yes is valid for the rest of that call.

    Args:
        context: The SDK's context of the request.
        params: The parameters of the request, which may contain the answer.
        questions: The questions that wait for an answer.
        ask: The program's own way to ask; None if the client should ask its user.
    """

    def __init__(
        self,
        context: Any,
        params: types.CallToolRequestParams,
        questions: Questions,
        ask: Ask | None,
    ) -> None:
        self._ask = ask
        self._context = context
        self._params = params
        self._questions = questions
        self._allowed: set[tuple[str, str]] = set()

    @staticmethod
    def can_ask(context: Any) -> bool:
        """Return whether the client of a request can ask a person."""
        capabilities = context.session.client_capabilities
        asking = None if capabilities is None else capabilities.elicitation
        return asking is not None and (asking.form is not None or asking.url is None)

    async def __call__(self, identity: Identity, verb: Verb, name: str, message: Any) -> bool:
        """Return whether a person says yes.

        Raises:
            Question: the call has to be repeated with the answer.
        """
        if (verb, name) in self._allowed:
            return True
        if self._ask is not None:
            said = await self._ask(identity, verb, name, message)
        else:
            said = await self._asked(identity, verb, name, message)
        if said:
            self._allowed.add((verb, name))
        return said

    async def _asked(self, identity: Identity, verb: Verb, name: str, message: Any) -> bool:
        """Make the client ask its user.

        Raises:
            Question: the call has to be repeated with the answer.
        """
        text = question(identity, verb, name, message)
        if self._context.protocol_version in MODERN_PROTOCOL_VERSIONS:
            # The arguments as the client wrote them; the message may already have been stamped.
            asked = [identity.name, verb, name, self._params.name, self._params.arguments]
            subject = json.dumps(asked, sort_keys=True)
            said = self._questions.answer(self._params, subject)
            if said is None:
                raise Question(text, subject)
            return said
        return await self._elicited(text)

    async def _elicited(self, text: str) -> bool:
        """Ask by a request to the client; an error in answer does not count as yes."""
        try:
            async with asyncio.timeout(ASK_SEC):
                answered = await self._context.session.elicit_form(
                    text, SCHEMA, related_request_id=self._context.request_id
                )
        except (MCPError, TimeoutError):
            return False
        return bool(answered.action == "accept")


def question(identity: Identity, verb: Verb, name: str, message: Any) -> str:
    """Return the question for a person: who wants to do what, with which values."""
    given = "" if message is None else f" with {shortened(message)}"
    return escaped(f"Allow {identity.name} to {verb} {name}{given}?")
