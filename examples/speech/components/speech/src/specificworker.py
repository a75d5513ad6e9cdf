"""SpeechComp: speaks texts one after the other, each into a sound file, as long as the sound takes."""

from __future__ import annotations

from collections import deque
from pathlib import Path

import voice
from generated.genericworker import GenericWorker

COMPONENT = Path(__file__).resolve().parent.parent


class SpecificWorker(GenericWorker):
    def initialize(self) -> None:
        self.waiting: deque[list[float]] = deque()  # the sounds, as loudness by period
        self.sound: deque[float] = deque()  # what is left of the one that is heard now
        self.count = 0

    def compute(self) -> None:
        with self.mutex:
            if not self.sound and self.waiting:
                self.sound.extend(self.waiting.popleft())
            if self.sound:
                self.sound.popleft()

    # Speech: other components call these.

    def Speech_say(self, text: str) -> float:
        with self.mutex:
            self.count += 1
            file = COMPONENT / self.parameters.sounds / f"{self.count}.wav"
        step = self.getPeriod() / 1000
        by = voice.speak(text, self.parameters.voice, file)
        sound = voice.loudness(file, step)
        with self.mutex:
            self.waiting.append(sound)
        self.log.info("'%s' is %.1f s, by %s: %s", text, len(sound) * step, by, file.name)
        return len(sound) * step

    def Speech_isSpeaking(self) -> bool:
        return bool(self.sound or self.waiting)
