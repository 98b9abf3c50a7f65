"""The ends of cyclonedds-python, which is imported with this module."""

# No postponed annotations: cyclonedds reads them.

import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass

from cyclonedds.core import Listener, Policy, Qos  # type: ignore[import-not-found]
from cyclonedds.domain import DomainParticipant  # type: ignore[import-not-found]
from cyclonedds.idl import IdlStruct  # type: ignore[import-not-found]
from cyclonedds.idl.types import sequence, uint8  # type: ignore[import-not-found]
from cyclonedds.pub import DataWriter  # type: ignore[import-not-found]
from cyclonedds.sub import DataReader  # type: ignore[import-not-found]
from cyclonedds.topic import Topic  # type: ignore[import-not-found]

__all__ = ["Ends"]


@dataclass
class Word(IdlStruct, typename="Word"):  # type: ignore[misc, call-arg]  # without types here
    """A small message."""

    data: str


@dataclass
class Block(IdlStruct, typename="Block"):  # type: ignore[misc, call-arg]  # without types here
    """A large message."""

    data: sequence[uint8]


class Ends:
    """Two writers and two readers; `arrived` is called in a thread of DDS."""

    def __init__(
        self, port: int, says: str, hears: str, arrived: Callable[[], None], depth: int
    ) -> None:
        os.environ.setdefault(
            "CYCLONEDDS_URI",
            "<General><Interfaces><NetworkInterface name='lo'/></Interfaces>"
            "<AllowMulticast>false</AllowMulticast></General>"
            "<Discovery><ParticipantIndex>auto</ParticipantIndex>"
            "<Peers><Peer address='127.0.0.1'/></Peers></Discovery>",
        )
        participant = DomainParticipant(port % 100 + 101)
        qos = Qos(Policy.Reliability.Reliable(10**10), Policy.History.KeepLast(depth))

        class OnData(Listener):  # type: ignore[misc]  # without types here
            def on_data_available(self, _: object) -> None:
                arrived()

        self._kept = (participant, OnData())
        words = [Topic(participant, name, Word) for name in (says, hears)]
        blocks = [Topic(participant, f"{name}_block", Block) for name in (says, hears)]
        self._words = DataWriter(participant, words[0], qos=qos)
        self._blocks = DataWriter(participant, blocks[0], qos=qos)
        self._word_reader = DataReader(participant, words[1], qos=qos, listener=self._kept[1])
        self._block_reader = DataReader(participant, blocks[1], qos=qos, listener=self._kept[1])

    @property
    def matched(self) -> bool:
        """Whether the other end is matched."""
        writers = (self._words, self._blocks)
        readers = (self._word_reader,)
        return all(writer.get_matched_subscriptions() for writer in writers) and all(
            reader.get_matched_publications() for reader in readers
        )

    def say(self, word: str) -> None:
        """Write a word."""
        self._words.write(Word(data=word))

    def say_block(self, block: bytes) -> None:
        """Write a block."""
        self._blocks.write(Block(data=block))

    def take(self) -> Iterator[str]:
        """Yield the words that have arrived, and "" for each block."""
        for sample in self._word_reader.take(1000):
            yield sample.data
        for _ in self._block_reader.take(10):
            yield ""
