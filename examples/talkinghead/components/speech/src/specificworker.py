"""SpeechComp: says the texts of its queue, one word each period, and moves the mouth with it."""

from __future__ import annotations

from collections import deque

from generated.genericworker import GenericWorker
from generated.interfaces import RoboCompMouth, RoboCompSpeech

LONGEST_QUEUE = 8
VOWELS = {"a": 12.0, "e": 8.0, "i": 4.0, "o": 10.0, "u": 6.0}  # millimetres that the lips open


class SpecificWorker(GenericWorker):
    def initialize(self) -> None:
        self.queue: deque[RoboCompSpeech.Utterance] = deque()
        self.words: deque[str] = deque()
        self.Speech_say("Hello, I am Shelly", False)

    def compute(self) -> None:
        with self.mutex:
            if not self.words and self.queue:
                self.words.extend(self.queue.popleft().text.split())
            if not self.words:
                return
            word = self.words.popleft()
        opening = max((VOWELS.get(letter, 0.0) for letter in word.lower()), default=0.0)
        reached = self.mouth_proxy.move(RoboCompMouth.Pose(opening=opening, width=50.0 - opening))
        self.log.info("says '%s' with the mouth %.0f mm open", word, reached.opening)
        if not self.words and not self.queue:
            self.mouth_proxy.close()

    def Speech_say(self, text: str, overwrite: bool) -> bool:
        with self.mutex:
            if overwrite:
                self.queue.clear()
            if len(self.queue) >= LONGEST_QUEUE:
                return False
            self.queue.append(RoboCompSpeech.Utterance(text=text, lang=RoboCompSpeech.Language.english))
        return True

    def Speech_isBusy(self) -> bool:
        return bool(self.words or self.queue)

    def Speech_status(self) -> tuple[int, list[RoboCompSpeech.Utterance]]:
        return 100, list(self.queue)

    def Speech_mouthPose(self) -> RoboCompMouth.Pose:
        return RoboCompMouth.Pose(opening=VOWELS["a"], width=38.0)
