"""MouthComp: a mouth that moves as far as its lips can."""

from __future__ import annotations

from generated.genericworker import GenericWorker
from generated.interfaces import RoboCompMouth

WIDEST_OPENING = 10.0  # millimetres


class SpecificWorker(GenericWorker):
    def initialize(self) -> None:
        self.pose = RoboCompMouth.Pose(opening=0.0, width=50.0)

    def compute(self) -> None:
        """Nothing to do by itself: it moves when it is asked to."""

    def Mouth_move(self, target: RoboCompMouth.Pose) -> RoboCompMouth.Pose:
        self.pose = RoboCompMouth.Pose(opening=min(target.opening, WIDEST_OPENING), width=target.width)
        self.log.info("moves to %.0f mm", self.pose.opening)
        return self.pose

    def Mouth_close(self) -> None:
        self.pose.opening = 0.0
        self.log.info("closes")
