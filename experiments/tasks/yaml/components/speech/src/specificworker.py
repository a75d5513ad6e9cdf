"""What SpeechComp does."""

from __future__ import annotations

from generated.genericworker import GenericWorker


class SpecificWorker(GenericWorker):
    def initialize(self) -> None:
        pass

    def compute(self) -> None:
        pass

    def Speech_say(self, text: str) -> int:
        return len(text)
