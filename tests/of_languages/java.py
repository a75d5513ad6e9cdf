"""Java: built with the JDK."""

from __future__ import annotations

import pytest

from java_accessors import Program
from java_programs import java_build, needs_java
from of_languages import Spoken

PARAMETERS = """\
import generated.GenericWorker;
import generated.Parameters.Mode;
import generated.Parameters.Values;
import generated.runtime.Change;
import generated.runtime.ParameterError;
import java.util.List;
import java.util.Map;
import java.util.TreeSet;
import java.util.stream.Collectors;

public class SpecificWorker extends GenericWorker {
    @Override
    public void initialize() throws Exception {
        if (parameters.device().equals("/dev/race")) {
            race();
        }
        parameters.listen(this::show);
        show(null);
    }

    private void write(double value) {
        parameters.change(Map.of("gains", List.of(value, value, value), "motors[0].vel", (float) value));
    }

    private void race() throws Exception {
        write(1.0);
        Thread writer = new Thread(() -> {
            for (int number = 0; number < 2000; number++) {
                write(number % 2 == 0 ? 1.0 : 0.5);
            }
        });
        writer.start();
        TreeSet<String> seen = new TreeSet<>();
        while (writer.isAlive()) {
            Values now = parameters.now();
            seen.add(now.gains.stream().map(SpecificWorker::said).collect(Collectors.joining(" ")) + " "
                + said(now.motors.get(0).vel));
        }
        System.out.println("seen: | " + String.join(" | ", seen));
    }

    private static String said(double value) {
        return String.format("%.6f", value).replaceAll("\\\\.?0+$", "");
    }

    private void show(Change change) {
        Values now = parameters.now();
        String motors = now.motors.stream().map(m -> m.name + ":" + said(m.vel)).collect(Collectors.joining(" "));
        double sum = now.offsets.values().stream().mapToDouble(Float::doubleValue).sum();
        System.out.println("[" + (change == null ? "-" : String.join(",", change.paths())) + "] "
            + (now.mode == Mode.slow ? "slow" : "fast") + " " + parameters.device() + " " + parameters.basicPeriod() + " "
            + parameters.token().orElse("None") + " " + parameters.gains().size() + " " + motors + " " + said(sum) + " "
            + (parameters.Yolo().useGpu ? 1 : 0) + " " + now.period.compute);
        if (now.device.equals("/dev/safe")) {
            System.out.println("safe: " + now.pin.orElse(0) + " " + String.join(" ", now.locks.orElse(List.of())) + " "
                + now.password.orElse("None") + " " + now.server.orElse("None"));
        }
        if (now.basicPeriod == 7) {
            try {
                parameters.change(Map.of("basicPeriod", 8, "motors[0].vel", 9));
            } catch (ParameterError error) {
                System.out.println("refused: " + error.getMessage());
            }
        }
        if (now.basicPeriod == 9) {
            parameters.setBasicPeriod(10);
        }
    }
}
"""
PAPER = """\
import generated.GenericWorker;
import generated.Parameters.Handler;
import generated.Parameters.Motor;

public class SpecificWorker extends GenericWorker {
    private static String said(float value) {
        return String.format("%.4f", value).replaceAll("\\\\.?0+$", "");
    }

    @Override
    public void initialize() throws Exception {
        System.out.println((parameters.handler() == Handler.Dunkermotoren ? "Dunkermotoren" : "?") + " "
            + parameters.device() + " " + parameters.baudRate() + " " + parameters.basicPeriod() + " "
            + parameters.motors().size());
        for (Motor m : parameters.motors()) {
            System.out.println(m.name + " " + m.id + " " + (m.invertedSign ? 1 : 0) + " " + said(m.min) + " "
                + said(m.max) + " " + said(m.zero) + " " + said(m.vel));
        }
    }
"""


def _stubs(skeleton: str) -> str:
    """The text after compute()."""
    _, brace, stubs = skeleton.partition("public void compute() throws Exception {\n    }\n")
    assert brace
    return stubs


SPOKEN = Spoken(
    "java",
    "src/SpecificWorker.java",
    java_build,
    PARAMETERS,
    PAPER,
    _stubs,
    marks=(pytest.mark.slow, needs_java),
    judge=Program,
)
