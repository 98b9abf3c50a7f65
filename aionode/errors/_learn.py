"""Errors of contracts, and of the observations and data sets made with them."""

from __future__ import annotations

from aionode.errors._base import AionodeError

__all__ = ["ContractError", "DatasetError", "EpisodeError"]


class ContractError(AionodeError, ValueError):
    """A contract cannot be read, is not valid, or a message does not fit it.

    Attributes:
        path: The file of the contract.
        where: The place in it, such as ``line 7: observations[0].max_age``; empty for the whole.
        problem: What was given, and what is valid.
    """

    def __init__(self, path: str, where: str, problem: str) -> None:
        self.path = path
        self.where = where
        self.problem = problem
        super().__init__(": ".join(filter(None, (f"contract {path}", where, problem))))


class DatasetError(AionodeError, ValueError):
    """A data set cannot be made from a recording, or is not what its format demands.

    Attributes:
        path: The bag, the data set or the file in it.
        problem: What was found.
        remedy: What to do next; empty if unknown.
    """

    def __init__(self, path: str, problem: str, remedy: str = "") -> None:
        self.path = path
        self.problem = problem
        self.remedy = remedy
        super().__init__(f"data set {path}: {problem}" + (f"; {remedy}" if remedy else ""))


class EpisodeError(AionodeError, RuntimeError):
    """An episode cannot be begun or ended now.

    Attributes:
        problem: Why, and what to do.
    """

    def __init__(self, problem: str) -> None:
        self.problem = problem
        super().__init__(f"episodes: {problem}")
