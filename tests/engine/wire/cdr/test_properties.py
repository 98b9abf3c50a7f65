"""Properties of every message of every type, and of truncated and damaged ones."""

from __future__ import annotations

import tracemalloc
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from aionode.engine.wire import cdr
from aionode.engine.wire.cdr import _encoder as encoder
from aionode.engine.wire.cdr._decoder import generate_decoder
from aionode.engine.wire.cdr._encoder import JOIN, generate_encoder, views
from aionode.engine.wire.cdr._fallback_decoder import decode_slowly
from aionode.errors import DecodeError
from aionode.message import Message, check
from tests.support.strategies import message_classes, messages, packages_of, various_classes

CLASSES = message_classes()

EXAMPLES = settings().max_examples
"""The number of examples in hypothesis's profile."""

few = settings(
    max_examples=max(3, EXAMPLES * 3 // 100),
    deadline=None,
    database=None,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
)
"""Few examples, for tests that run for each class."""

many = settings(few, max_examples=EXAMPLES * 3)
"""More examples, for tests that choose one of the classes for each."""

any_class = st.sampled_from(list(CLASSES.values()))


@many
@given(cls=any_class, data=st.data())
def test_decode_undoes_encode(cls: type[Message], data: st.DataObject) -> None:
    """Every value survives the wire, from whatever memory it is read and by either decoder."""
    check_round_trip(data.draw(messages(cls)))


@pytest.mark.stress
@pytest.mark.parametrize("package", packages_of(CLASSES))
def test_decode_undoes_encode_for_every_class(package: str) -> None:
    """No class depends on being chosen by chance."""

    def check_both(message: Message, with_nan: Message) -> None:
        check_round_trip(message)
        check_pieces(with_nan, encoder.LARGE)

    for name, cls in CLASSES.items():
        if name.startswith(f"{package}/"):
            few(given(messages(cls), messages(cls, nan=True))(check_both))()


def check_round_trip(message: Message) -> None:
    """Encode a message, and decode it in each way."""
    cls = type(message)
    encoded = cdr.encode(message)

    assert cdr.decode(cls, encoded) == message
    assert cdr.decode(cls, memoryview(encoded)) == message
    assert decode_slowly(cls, memoryview(encoded)) == message
    check(cdr.decode(cls, encoded))


@pytest.mark.slow
def test_classes_of_every_kind_survive_the_wire_with_their_defaults() -> None:
    """Every run covers each kind of field."""
    for cls in various_classes().values():
        check_round_trip(cdr.decode(cls, cdr.encode(cls())))  # 0.3 of a float32 is rounded
        check_pieces(cls(), 1)


@many
@given(cls=any_class, data=st.data(), least=st.sampled_from([1, 2, 8, encoder.LARGE]))
def test_the_pieces_of_a_message_are_its_bytes(
    cls: type[Message], data: st.DataObject, least: int
) -> None:
    """Joined they are what `encode` returns, whatever size makes a value a piece of its own."""
    check_pieces(data.draw(messages(cls, nan=True)), least)


def check_pieces(message: Message, least: int) -> None:
    """Encode a message in pieces, each array of `least` bytes or more being one."""
    cls = type(message)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(encoder, "LARGE", least)
        pieces = cdr.parts_encoder(cls)(message)

    assert b"".join(pieces) == cdr.encode(message)
    assert all(isinstance(one, bytes) or one.readonly for one in pieces)
    assert sum(map(len, pieces)) == len(cdr.encode(message))
    assert cdr.has_views(cls) or all(isinstance(one, bytes) for one in pieces)


@pytest.mark.slow
def test_usual_messages_take_the_fast_way() -> None:
    """Generated functions encode and decode them: with the fallback the codec would be slow."""

    def slow(_: Any) -> Any:
        raise AssertionError

    for cls in various_classes().values():
        encoded = generate_encoder(cls, slow, JOIN)(cls())
        message = cdr.decode(cls, encoded)  # with the default 0.3 of a float32 as the wire has it

        assert b"".join(generate_encoder(cls, slow, views)(message)) == encoded
        assert generate_decoder(cls, slow, slow)(encoded) == message
        assert generate_decoder(cls, slow)(memoryview(encoded)) == message


@given(cls=any_class, data=st.data())
@many
def test_what_was_decoded_is_encoded_the_same(cls: type[Message], data: st.DataObject) -> None:
    """The bytes are the same again: NaN and -0.0, which compare badly, survive too."""
    encoded = cdr.encode(data.draw(messages(cls, nan=True)))

    assert cdr.encode(cdr.decode(cls, encoded)) == encoded


@given(cls=any_class, data=st.data())
@many
def test_any_truncation_is_a_decode_error(cls: type[Message], data: st.DataObject) -> None:
    """A short read raises DecodeError and nothing else: the last byte is always needed."""
    whole = cdr.encode(data.draw(messages(cls)))
    cut = whole[: data.draw(st.integers(0, len(whole) - 1))]

    with pytest.raises(DecodeError) as caught:
        cdr.decode(cls, cut)
    assert caught.value.type_name == cls.__ros_type__
    assert caught.value.offset <= len(cut) + 7  # the place may lie behind a gap
    with pytest.raises(DecodeError):
        cdr.decode(cls, memoryview(cut))


@pytest.mark.slow
def test_a_message_cut_anywhere_is_a_decode_error() -> None:
    """At each of the first places, for fields of every kind."""
    for cls in various_classes().values():
        whole = cdr.encode(cls())
        for size in range(min(len(whole), 80)):
            with pytest.raises(DecodeError):
                cdr.decode(cls, whole[:size])


@given(cls=any_class, data=st.data())
@many
def test_corrupted_data_is_decoded_as_it_stands_or_refused(
    cls: type[Message], data: st.DataObject
) -> None:
    """Whatever the bytes are, there is a message or a DecodeError, and both decoders agree."""
    damaged = bytearray(cdr.encode(data.draw(messages(cls))))
    for _ in range(data.draw(st.integers(1, 4))):
        place = data.draw(st.integers(0, len(damaged) - 1))
        damaged[place] = data.draw(st.sampled_from([0, 1, 4, 127, 128, 255]))

    expected = outcome(cdr.decode, cls, bytes(damaged))
    assert outcome(decode_slowly, cls, memoryview(damaged)) == expected
    assert outcome(decode_plainly, cls, bytes(damaged)) == expected


@given(cls=any_class, data=st.data())
@many
def test_a_family_without_arrays_decodes_the_same(cls: type[Message], data: st.DataObject) -> None:
    """The numbers are in other objects, which are encoded to the same bytes."""
    encoded = cdr.encode(data.draw(messages(cls, nan=True)))

    assert outcome(decode_plainly, cls, encoded) == encoded


def decode_plainly(cls: type[Message], data: bytes) -> Message:
    """Decode a message with memoryviews in place of arrays."""
    return cdr.decoder(cls, cdr.PLAIN)(data)


def outcome(decode: Any, cls: type[Message], data: Any) -> bytes | str:
    """Return what decoding comes to, in a form that can be compared even with NaN in it."""
    try:
        return cdr.encode(decode(cls, data))
    except DecodeError as error:
        return str(error)


@given(cls=any_class, other=any_class, data=st.data())
@many
def test_bytes_of_another_type_are_no_surprise(
    cls: type[Message], other: type[Message], data: st.DataObject
) -> None:
    """A type that changed under its name gives a message or a DecodeError."""
    encoded = cdr.encode(data.draw(messages(other)))

    outcome(cdr.decode, cls, encoded)


@pytest.mark.slow
def test_no_length_makes_more_memory_than_the_data_could_fill() -> None:
    """Every aligned word is in turn the largest length: it is believed only if bytes follow."""
    for cls in various_classes().values():
        peak, usual = peaks_of_damaged(cls)

        assert peak < 3 * usual + 100_000, cls


def peaks_of_damaged(cls: type[Message]) -> tuple[int, int]:
    """Return the peak of memory in bytes with wrong lengths, and that with the right ones."""
    encoded = cdr.encode(cls())
    words = range(4, min(len(encoded) - 3, 48), 4)
    damaged = [
        encoded[:place] + claimed.to_bytes(4, "little") + encoded[place + 4 :]
        for place in words
        for claimed in (0xFFFFFFFF, 0x00FFFFFF)
    ]
    for each in (encoded, *damaged):  # what is made once for a type, or logged once, does not count
        outcome(cdr.decode, cls, each)

    tracemalloc.start()
    try:
        outcome(cdr.decode, cls, encoded)
        _, usual = tracemalloc.get_traced_memory()
        tracemalloc.reset_peak()
        for each in damaged:
            outcome(cdr.decode, cls, each)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    return peak, usual
