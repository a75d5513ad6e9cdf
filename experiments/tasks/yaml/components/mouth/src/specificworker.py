"""What MouthComp does."""

from __future__ import annotations

from generated.genericworker import GenericWorker


class SpecificWorker(GenericWorker):
    def initialize(self) -> None:
        self.width = 0.0

    def compute(self) -> None:
        pass

    def Mouth_open(self, width: float) -> None:
        self.width = width

    def Mouth_opening(self) -> float:
        return self.width
