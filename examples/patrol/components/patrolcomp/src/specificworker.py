"""PatrolComp: drives the base to and fro."""

from __future__ import annotations

from generated.genericworker import GenericWorker

WAY = 0.2  # metres


class SpecificWorker(GenericWorker):
    def initialize(self) -> None:
        self.base_proxy.drive(0.5)

    def compute(self) -> None:
        position = self.base_proxy.position()
        if position >= WAY:
            self.log.info("back")
            self.base_proxy.drive(-0.5)
        elif position <= 0:
            self.log.info("forth")
            self.base_proxy.drive(0.5)
