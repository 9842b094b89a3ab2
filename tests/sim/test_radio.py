"""The radio: tuner and speaker."""

from __future__ import annotations

import wave
from pathlib import Path

import pytest

from sim.radio import CHUNK, RATE, STATIONS, Speaker, StationError, Tuner
from sim.signals import Audio


def test_a_chunk_is_a_tenth_of_a_second_of_16_bit_sound() -> None:
    chunk = Tuner("94.3").chunk(0)
    assert len(chunk["samples"]) == CHUNK == RATE // 10 == chunk["rate"] / 10
    assert all(-32768 <= sample <= 32767 for sample in chunk["samples"])


def test_two_tuners_on_one_station_play_the_same_and_on_two_stations_not() -> None:
    first, second = (Tuner(station) for station in STATIONS)
    assert first.chunk(7) == Tuner(next(iter(STATIONS))).chunk(7)
    assert first.chunk(7) != second.chunk(7)


def test_the_melody_is_heard_and_its_rests_are_silent() -> None:
    tuner, speaker = Tuner("94.3"), Speaker()
    levels = []
    for number in range(64):
        speaker.render(tuner.chunk(number))
        levels.append(speaker.level)
    assert max(levels) > 0.1
    assert levels[60:] == [0.0] * 4


def test_half_the_volume_is_half_the_level() -> None:
    loud, soft = Speaker(1.0), Speaker(0.5)
    for speaker in (loud, soft):
        speaker.render(Tuner("94.3").chunk(0))
    assert soft.level == pytest.approx(loud.level / 2, rel=1e-3)


def test_what_was_rendered_can_be_written_to_a_file(tmp_path: Path) -> None:
    speaker = Speaker()
    for number in range(5):
        speaker.render(Tuner("101.9").chunk(number))
    speaker.write(tmp_path / "radio.wav")
    with wave.open(str(tmp_path / "radio.wav")) as file:
        assert (file.getframerate(), file.getnchannels(), file.getsampwidth()) == (RATE, 1, 2)
        assert file.getnframes() == 5 * CHUNK
    assert speaker.seconds == pytest.approx(0.5)


def test_too_loud_a_chunk_is_cut_to_16_bits() -> None:
    speaker = Speaker()
    speaker.render(Audio(rate=8000.0, samples=[100000, -100000]))
    assert speaker.level == pytest.approx(1.0)


def test_a_station_that_nobody_broadcasts_is_refused() -> None:
    with pytest.raises(StationError, match=r"no station at '12\.0': try 94\.3 or 101\.9"):
        Tuner("12.0")


def test_a_volume_beyond_one_is_refused() -> None:
    with pytest.raises(ValueError, match="between 0 and 1"):
        Speaker(2.0)
