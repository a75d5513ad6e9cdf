"""Texts as sounds: by espeak-ng where it is installed, else by a tone for each letter."""

from __future__ import annotations

import array
import math
import shutil
import subprocess
import sys
import wave
from collections.abc import Iterator
from pathlib import Path

RATE = 22050  # samples a second
LETTER = 0.08  # seconds of a letter's tone
LOUD = {"a": 1.0, "o": 0.9, "e": 0.8, "u": 0.7, "i": 0.6}  # how loud vowels are; other letters are 0.3


def speak(text: str, voice: str, file: Path) -> str:
    """Writes the text, spoken, to a sound file (mono, 16 bits). Returns what spoke it."""
    file.parent.mkdir(parents=True, exist_ok=True)
    program = shutil.which("espeak-ng")
    if program:
        subprocess.run([program, "-v", voice, "-w", file, "--", text], check=True, capture_output=True, timeout=30)
        return "espeak-ng"
    _write(file, (sample for letter in text.lower() for sample in _tone(letter)))
    return "tones"


def loudness(file: Path, step: float) -> list[float]:
    """How loud the sound is in each step of so many seconds, from 0 to 1: 1 is its loudest step."""
    with wave.open(str(file), "rb") as sound:
        samples = array.array("h", sound.readframes(sound.getnframes()))
        length = max(1, round(sound.getframerate() * step))
    if sys.byteorder == "big":
        samples.byteswap()
    parts = (samples[start : start + length] for start in range(0, len(samples), length))
    means = [math.sqrt(sum(sample * sample for sample in part) / len(part)) for part in parts]
    loudest = max(means, default=0.0)
    return [mean / loudest if loudest else 0.0 for mean in means]


def _tone(letter: str) -> Iterator[int]:
    strength = LOUD.get(letter, 0.3 if letter.isalnum() else 0.0)
    pitch = 150 + 10 * (ord(letter) % 16)
    for at in range(round(RATE * LETTER)):
        swell = math.sin(math.pi * at / (RATE * LETTER))
        yield round(20000 * strength * swell * math.sin(2 * math.pi * pitch * at / RATE))


def _write(file: Path, samples: Iterator[int]) -> None:
    data = array.array("h", samples)
    if sys.byteorder == "big":
        data.byteswap()
    with wave.open(str(file), "wb") as sound:
        sound.setnchannels(1)
        sound.setsampwidth(2)
        sound.setframerate(RATE)
        sound.writeframes(data.tobytes())
