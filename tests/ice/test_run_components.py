"""`rcyaml run` and `rcyaml mock` with generated components: each finds the other, deployed and by itself."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from conftest import write_tree
from processes import Running, Start, kill_left, until
from robocomp_yaml.deploy.local import procfs

RCYAML = [os.path.join(os.path.dirname(sys.executable), "rcyaml")]
DOCUMENTS = {
    "rcyaml.yaml": "interfaces: [interfaces]\n",
    "interfaces/Gripper.idsl.yaml": "module: RoboCompGripper\ninterfaces:\n  Gripper:\n    methods:\n      grip: {in: {force: float}, returns: bool}\ntopics:\n  Gripped:\n    methods:\n      held: {in: {what: string}}\n",
    "components/grippertool/tool.cdsl.yaml": "component: GripperTool\nlanguage: python\nimports: [Gripper]\nimplements: [Gripper]\n",
    "components/graspplanner/planner.cdsl.yaml": "component: GraspPlanner\nlanguage: python\nimports: [Gripper]\nrequires: [Gripper]\n",
    "components/graspplanner/planner.pdsl.yaml": "component: planner.cdsl.yaml\nparameters:\n  force: {type: float, default: 1.5}\n",
    "components/gripwatcher/watcher.cdsl.yaml": "component: GripWatcher\nlanguage: python\nimports: [Gripper]\nsubscribes: [Gripped]\n",
}
HEAD = "from generated.genericworker import GenericWorker\n\nclass SpecificWorker(GenericWorker):\n"
CODE = {
    "components/grippertool/src/specificworker.py": HEAD
    + "    def Gripper_grip(self, force):\n        return force > 1\n",
    "components/graspplanner/src/specificworker.py": HEAD
    + "    def initialize(self):\n        force = self.parameters.force\n        print('grips with', force, self.mouth())\n"
    "    def mouth(self):\n        return self.gripper_proxy.grip(self.parameters.force)\n",
    "components/gripwatcher/src/specificworker.py": HEAD
    + "    def Gripped_held(self, what):\n        print('holds', what)\n",
}
DEPLOYMENT = "deployment: Grasping\ncomponents:\n  planner: {component: components/graspplanner, set: {force: 2.5}}\n  tool: {component: components/grippertool}\n"


@pytest.fixture
def robot(tmp_path: Path, ice: Any) -> Iterator[Path]:
    """A workspace of three components, compiled."""
    write_tree(tmp_path, {**DOCUMENTS, **CODE})
    subprocess.run([*RCYAML, "-q", "compile"], cwd=tmp_path, check=True)
    yield tmp_path
    for folder in (tmp_path / ".rcyaml" / "run").glob("*"):
        kill_left(str(folder))


def nothing_is_left(root: Path) -> None:
    def left() -> list[int]:
        return [pid for folder in (root / ".rcyaml" / "run").glob("*") for pid in procfs.marked(str(folder))]

    until(lambda: not left(), lambda: str(left()), 5)


def stopped(run: Running) -> str:
    assert run.stop(signal.SIGINT, within=10) == 130
    return run.output


def test_by_itself_with_what_it_needs(robot: Path, start: Start) -> None:
    run = start([*RCYAML, "run", "graspplanner", "--with-needed"], cwd=robot)
    run.wait_for("grips with 1.5 True").wait_for("GraspPlanner is running")
    said = stopped(run)
    assert (
        "GraspPlanner: components/graspplanner/bin/GraspPlanner, with its own configuration\nGripperTool: ready\n"
        in said
    )
    assert said.endswith("GripperTool: stopped\n")
    nothing_is_left(robot)


def test_its_values_document_counts_at_once(robot: Path, start: Start) -> None:
    """Without another compile."""
    values = "component: ../planner.cdsl.yaml\nparameters: {force: 0.5}\n"
    write_tree(robot, {"components/graspplanner/etc/config.yaml": values})
    run = start([*RCYAML, "run", "--with-needed"], cwd=robot / "components" / "graspplanner")
    run.wait_for("grips with 0.5 False")
    stopped(run)
    again = start([*RCYAML, "run", "GraspPlanner", "--with-needed", "--", "--force=3"], cwd=robot)
    again.wait_for("grips with 3.0 True")
    stopped(again)


def test_as_in_its_deployment(robot: Path, start: Start) -> None:
    write_tree(robot, {"grasping.ddsl.yaml": DEPLOYMENT})
    run = start([*RCYAML, "run", ".", "--with-needed"], cwd=robot / "components" / "graspplanner")
    run.wait_for("grips with 2.5 True").wait_for("tool: ready")
    stopped(run)
    nothing_is_left(robot)


def test_a_stand_in_is_where_each_of_them_looks(robot: Path, start: Start) -> None:
    write_tree(robot, {"grasping.ddsl.yaml": DEPLOYMENT})
    mock = start([*RCYAML, "mock", "Gripper"], cwd=robot / "interfaces")
    mock.wait_for("for GraspPlanner").wait_for("for planner of ").wait_for("Ctrl-C")
    for words, force in ((["planner", "--with-needed"], 2.5), (["graspplanner", "--alone", "--with-needed"], 1.5)):
        run = start([*RCYAML, "run", *words], cwd=robot)
        run.wait_for(f"grips with {force} False")
        assert "ready" not in stopped(run)
        mock.wait_for(f"Gripper.grip(force: {force}) returns false")


def test_a_stand_in_beside_the_component_itself(robot: Path, start: Start) -> None:
    """Where the component serves, the stand-in cannot; elsewhere it does."""
    write_tree(robot, {"grasping.ddsl.yaml": DEPLOYMENT})
    tool = start([*RCYAML, "run", "tool"], cwd=robot)
    tool.wait_for("GripperTool is running")
    mock = start([*RCYAML, "mock", "Gripper"], cwd=robot)
    mock.wait_for("Ctrl-C")
    lines = {line.split()[0]: line for line in mock.output.splitlines()}
    assert lines["serving"].endswith("for GraspPlanner") and lines["skipped"].endswith("is the component running?")


def test_topics_without_an_icestorm(robot: Path, start: Start) -> None:
    if shutil.which("icebox") is None:
        pytest.skip("icebox is not installed (Debian: zeroc-icebox, libzeroc-icestorm3.7)")
    port = Path(robot / "components/gripwatcher/etc/config")
    free = 19871  # not IceStorm's usual port, at which other tests may have one
    port.write_text(port.read_text().replace("-p 9999", f"-h 127.0.0.1 -p {free}"))
    mock = start([*RCYAML, "mock", "Gripped"], cwd=robot)
    mock.wait_for(f"serving  IceStorm/TopicManager:tcp -h 127.0.0.1 -p {free}")
    run = start([*RCYAML, "run", "GripWatcher", "--with-needed"], cwd=robot)
    run.wait_for("holds what")
    assert "IceStorm" not in stopped(run)
    assert mock.stop(signal.SIGINT, within=10) == 130
    alone = start([*RCYAML, "run", "GripWatcher", "--with-needed"], cwd=robot)
    alone.wait_for(f"IceStorm-{free}: ready").wait_for("GripWatcher is running")
    assert stopped(alone).endswith(f"IceStorm-{free}: stopped\n")
    nothing_is_left(robot)


def test_nobody_serves_what_it_needs(robot: Path, start: Start) -> None:
    shutil.rmtree(robot / "components" / "grippertool")
    run = start([*RCYAML, "run", "GraspPlanner", "--with-needed"], cwd=robot)
    run.wait_for("waiting for Gripper")
    said = run.output
    assert "warning[RC7030]: 'GraspPlanner' requires Gripper, but nothing answers at gripper:tcp" in said
    assert "`rcyaml mock Gripper` serves it" in said
    assert stopped(run).count("RC7030") == 1


def test_a_stale_program_is_not_run(robot: Path) -> None:
    write_tree(robot, {
        "components/arm/arm.cdsl.yaml": "component: ArmComp\nlanguage: java\n",
        "components/arm/bin/ArmComp": "-> /bin/true",
        "components/arm/src/SpecificWorker.java": "class SpecificWorker {}\n",
    })  # fmt: skip
    done = subprocess.run([*RCYAML, "run", "ArmComp"], cwd=robot, capture_output=True, text=True)
    assert done.returncode == 1 and "error[RC7016]: the program of 'ArmComp' is older than its sources" in done.stderr
    assert "`rcyaml build ArmComp`" in done.stderr


@pytest.mark.parametrize("uses", [(), ("--implements", "Sonar"), ("--implements", "Sonar", "--requires", "Lidar")])
def test_what_new_writes_runs_at_once(tmp_path: Path, ice: Any, start: Start, uses: tuple[str, ...]) -> None:
    """Without an edit between `new`, `compile` and `run`."""
    for words in (
        ("new", "interface", "Sonar", "Lidar"), ("new", "component", "LidarMaker", "--implements", "Lidar"),
        ("new", "component", "FreshComp", *uses), ("new", "parameters", "FreshComp"), ("compile",), ("build",),
    ):  # fmt: skip
        subprocess.run([*RCYAML, "-q", *words], cwd=tmp_path, check=True)
    run = start([*RCYAML, "run", "FreshComp", "--with-needed", "--", "--startup-check"], cwd=tmp_path)
    assert run.exit_code() == 0
    assert "FreshComp: the startup check has passed" in run.output
    assert ("LidarMaker: ready" in run.output) == ("Lidar" in uses)
    nothing_is_left(tmp_path)


@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        (["planner", "--set", "force=7.25"], 0, "force=7.25"),
        (["planner", "--set", "force=7.25", "--set", "force=8"], 0, "force=8"),
        (["planner", "--config", "components/graspplanner/etc/weak.config.yaml"], 0, "force=2.5"),  # `set:` comes last
        (["other", "--config", "components/graspplanner/etc/weak.config.yaml"], 0, "force=0.25"),
        (["other", "--config", "components/graspplanner/etc/weak.config.yaml", "--set", "force=9"], 0, "force=9"),
        (["planner", "--set", "forse=7"], 2, "unknown parameter 'forse'; did you mean 'force'?"),
        (["planner", "--set", "force=strong"], 2, "force must be a number"),
        (["planner", "--set", "force"], 2, "'force' is not NAME=VALUE"),
        (["planner", "--alone", "--set", "force=7"], 2, "`-- --force=7` passes it to the program"),
        (["pause", "--set", "force=7"], 2, "'pause' is not a component"),
        (["planner", "--config", "nowhere.yaml"], 2, "'nowhere.yaml' does not exist"),
    ],
)
def test_other_values_for_one_run(robot: Path, words: list[str], code: int, said: str) -> None:
    more = "  other: {component: components/graspplanner, connect: {Gripper: tool}}\n  pause: {program: sleep}\n"
    weak = "component: ../planner.cdsl.yaml\nparameters: {force: 0.25}\n"
    write_tree(robot, {"grasping.ddsl.yaml": DEPLOYMENT + more, "components/graspplanner/etc/weak.config.yaml": weak})
    before = (robot / "grasping.ddsl.yaml").read_bytes()
    done = subprocess.run([*RCYAML, "run", *words, "--dry-run"], cwd=robot, capture_output=True, text=True)
    assert (done.returncode, said in (done.stdout or done.stderr)) == (code, True), done.stdout + done.stderr
    assert (robot / "grasping.ddsl.yaml").read_bytes() == before


def test_other_values_for_one_run_alone(robot: Path) -> None:
    values = "component: ../planner.cdsl.yaml\nparameters: {force: 0.5}\n"
    write_tree(robot, {"components/graspplanner/etc/config.yaml": values})
    words = [*RCYAML, "run", "graspplanner", "--set", "force=6", "--dry-run"]
    assert "\nforce=6\n" in subprocess.run(words, cwd=robot, capture_output=True, text=True).stdout
    assert (robot / "components/graspplanner/etc/config.yaml").read_text() == values
