"""BaseComp: a simulated base on wheels."""

from __future__ import annotations

from generated.genericworker import GenericWorker
from generated.interfaces import RoboCompBase

FASTEST = 1.0


class SpecificWorker(GenericWorker):
    def initialize(self) -> None:
        self.speed = self.place = 0.0

    def compute(self) -> None:
        """Called every 100 ms."""
        with self.mutex:
            self.place += self.speed * self.getPeriod() / 1000

    # Base: other components call these, in other threads.

    def Base_drive(self, speed: float) -> None:
        if abs(speed) > FASTEST:
            raise RoboCompBase.TooFast(FASTEST)
        with self.mutex:
            self.speed = speed

    def Base_position(self) -> float:
        with self.mutex:
            return self.place
