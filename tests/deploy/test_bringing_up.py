"""Up and down of a network: order, and what changes."""

from __future__ import annotations

from msgspec.structs import replace

from processes import Ports
from robocomp_yaml.deploy.carry_out import GONE, READY, STARTING, STOPPING
from robocomp_yaml.deploy.engine import RUNNING
from robocomp_yaml.deploy.operations import KEEP_GOING
from robocomp_yaml.deploy.plan import CHANGE, KEEP, RESTART, START, STOP
from robocomp_yaml.network.network import EnvironmentVariable, Process, Readiness, RestartRule
from small_networks import Place, config_of, listener, readable_by_others, shell, sleeper


def actions(result: object) -> dict[str, str]:
    return {step.name: step.action for step in result.plan.steps.values()}  # type: ignore[attr-defined]


def test_each_process_starts_when_its_dependences_are_ready(place: Place, free_port: Ports) -> None:
    processes = (listener("a", free_port()), listener("b", free_port(), "a"), sleeper("c", "a"), sleeper("d", "b", "c"))
    result = place.up(*processes)
    assert not result.diagnostics
    happened = [(event.name, event.kind) for event in place.events]
    for process in processes:
        for before in process.after:
            assert happened.index((before, READY)) < happened.index((process.name, STARTING))


def test_independent_processes_start_in_parallel(place: Place) -> None:
    # Each waits for the other: started one after the other, neither would become ready.
    meet = "touch {0}; while [ ! -e {1} ]; do sleep 0.01; done; echo met; exec sleep 600"
    paths = (f"{place.root}/left", f"{place.root}/right")
    left, right = shell("left", meet.format(*paths)), shell("right", meet.format(*reversed(paths)))
    met = Readiness(log="^met$", within=20)
    assert not place.up(replace(left, ready=met), replace(right, ready=met)).diagnostics


def test_down_has_the_reverse_order(place: Place) -> None:
    place.up(sleeper("a"), sleeper("b", "a"), sleeper("c", "b"), sleeper("d"))
    assert set(place.down()) == {"a", "b", "c", "d"}
    happened = [(event.name, event.kind) for event in place.events]
    assert happened.index(("c", GONE)) < happened.index(("b", STOPPING))
    assert happened.index(("b", GONE)) < happened.index(("a", STOPPING))
    place.wait_gone()
    assert place.down() == []


def test_a_second_up_changes_nothing(place: Place) -> None:
    processes = (sleeper("a", config=config_of("a", "x=1\n")), sleeper("b", "a"))
    place.up(*processes)
    pids = place.pids()
    again = place.up(*processes)
    assert again.plan.is_empty and place.events == []
    assert place.pids() == pids


def test_a_changed_configuration_restarts_its_process(place: Place) -> None:
    def network(value: str) -> tuple[Process, ...]:
        echo = 'cat "$0"; exec sleep 600'
        return (sleeper("a"), shell("b", echo, "a", config=config_of("b", f"motors.vel={value}\n")), sleeper("c"))

    place.up(*network("1"))
    before = place.pids()
    result = place.up(*network("2"))
    assert actions(result) == {"a": KEEP, "b": RESTART, "c": KEEP}
    assert result.plan.steps["b"].reason == "config motors.vel: 1 → 2"
    after = place.pids()
    assert before["b"] != after["b"] and before["a"] == after["a"] and before["c"] == after["c"]
    assert place.log("b")[-1] == "motors.vel=2"


def test_a_program_without_ice_restarts_with_its_dependences(place: Place) -> None:
    def network(value: str) -> tuple[Process, ...]:
        return (
            sleeper("a", env=(EnvironmentVariable("X", value),)), sleeper("plain", "a"), replace(sleeper("ice", "a"), is_ice=True)
        )  # fmt: skip

    place.up(*network("1"))
    result = place.up(*network("2"))
    assert actions(result) == {"a": RESTART, "plain": RESTART, "ice": KEEP}
    assert result.plan.steps["plain"].reason == "it is after a, which restarts"


def test_a_change_without_restart_is_applied_in_place(place: Place) -> None:
    place.up(sleeper("a"))
    pids = place.pids()
    result = place.up(sleeper("a", restart=RestartRule(tries=9)))
    assert actions(result) == {"a": CHANGE}
    assert place.pids() == pids
    assert place.up(sleeper("a", restart=RestartRule(tries=9))).plan.is_empty


def test_a_changed_file_restarts(place: Place) -> None:
    program = place.root / "program"
    program.write_text("1", encoding="utf-8")
    place.up(sleeper("a", watched=(str(program),)))
    program.write_text("2", encoding="utf-8")
    result = place.up(sleeper("a", watched=(str(program),)))
    assert actions(result) == {"a": RESTART}
    assert result.plan.steps["a"].reason.endswith("program changed")


def test_a_removed_process_stops(place: Place) -> None:
    place.up(sleeper("a"), sleeper("b", config=config_of("b", "x=1\n")), sleeper("c"))
    result = place.up(sleeper("a"), sleeper("c", enabled=False))
    assert actions(result) == {"a": KEEP, "b": STOP, "c": STOP}
    assert set(place.pids()) == {"a"}
    assert not (place.root / ".rcyaml/deployments/Robot/config/b").exists()


def test_names_limit_up_to_processes_and_their_dependences(place: Place) -> None:
    network = (sleeper("a"), sleeper("b", "a"), sleeper("c"))
    assert actions(place.up(*network, names=["b"])) == {"a": START, "b": START}
    assert actions(place.up(*network)) == {"a": KEEP, "b": KEEP, "c": START}
    assert set(place.down("a")) == {"a", "b"}
    assert set(place.pids()) == {"c"}


def test_an_obstacle_of_one_process_stops_only_its_users(place: Place) -> None:
    """With `keep`; else no process is started."""
    missing = Process("b", "localhost", ("/no/such/program",), "/tmp", kind="program", is_ice=False)
    network = (sleeper("a"), missing, sleeper("c", "b"))
    assert place.up(*network).diagnostics and place.pids() == {}
    result = place.up(*network, on_failure=KEEP_GOING)
    assert [found.code for found in result.diagnostics] == ["RC7002"]
    assert result.outcome.failed.keys() == {"b"} and result.outcome.skipped == ["c"]
    assert place.observe()["a"].state == RUNNING


def test_a_forced_process_restarts_without_a_change(place: Place) -> None:
    place.up(sleeper("a"), sleeper("b"))
    before = place.pids()
    place.up(sleeper("a"), sleeper("b"), names=["b"], forced=["b"])
    after = place.pids()
    assert before["a"] == after["a"] and before["b"] != after["b"]


def test_processes_in_a_circle_start(place: Place) -> None:
    assert not place.up(sleeper("a", "b"), sleeper("b", "a"), sleeper("c", "a")).diagnostics
    assert len(place.down()) == 3


def test_only_the_owner_can_read_the_folder(place: Place) -> None:
    place.up(sleeper("a", config=config_of("a", "password=hunter2\n")))
    assert readable_by_others(place.folder) == []


def test_a_folder_with_a_path_too_long_for_a_socket(place: Place) -> None:
    place.root = place.root / "a-long-name-of-a-folder" / ("deep-" * 20) / ("deeper-" * 20)
    place.root.mkdir(parents=True)
    assert not place.up(sleeper("a")).diagnostics
    assert set(place.pids()) == {"a"}
    assert place.down() == ["a"]


def test_a_process_that_has_ended_is_not_restarted(place: Place) -> None:
    network = (shell("once", "echo done"), sleeper("b", "once"))
    assert not place.up(*network).diagnostics
    place.wait_for_state("once", "ended")
    assert place.up(*network).plan.is_empty
