"""JointMotorComp: moves simulated motors, at most at their maximum speed, and within their limits."""

from __future__ import annotations

from generated.genericworker import GenericWorker
from generated.interfaces import RoboCompJointMotor


class SpecificWorker(GenericWorker):
    def initialize(self) -> None:
        parameters = self.parameters
        self.motors = {motor.name: motor for motor in parameters.motors}
        self.positions = {name: motor.zero for name, motor in self.motors.items()}
        self.goals: dict[str, tuple[float, float]] = {}
        self.log.info("%d motors at %s: %s", len(self.motors), parameters.device, ", ".join(self.motors))

    def compute(self) -> None:
        with self.mutex:
            for name, (goal, speed) in list(self.goals.items()):
                step = speed * self.getPeriod() / 1000
                away = goal - self.positions[name]
                self.positions[name] += max(-step, min(step, away))
                if abs(away) <= step:
                    del self.goals[name]
                    self.log.info("%s is at %.2f rad", name, self.positions[name])

    def JointMotor_setPosition(self, goal: RoboCompJointMotor.Position) -> None:
        motor = self._motor(goal.name)
        position = max(motor.min, min(motor.max, goal.position))
        with self.mutex:
            self.goals[goal.name] = position, min(goal.maxSpeed or motor.vel, motor.vel)

    def JointMotor_getPosition(self, motor: str) -> float:
        self._motor(motor)
        return self.positions[motor]

    def JointMotor_stopAll(self) -> None:
        with self.mutex:
            self.goals.clear()

    def _motor(self, name: str):
        if name not in self.motors:
            raise RoboCompJointMotor.UnknownMotor(f"there is no motor '{name}'")
        return self.motors[name]
