"""Plans with names, disabled processes and processes that follow a restart; and their reasons."""

from __future__ import annotations

import os

import pytest
from msgspec.structs import replace

from engine_in_memory import network, process, running
from robocomp_yaml.deploy.engine import ENDED, GIVEN_UP, LOST, RUNNING, STOPPED, WAITING, Running
from robocomp_yaml.deploy.plan import (
    CHANGE,
    KEEP,
    RESTART,
    START,
    STOP,
    Plan,
    disabled,
    in_order,
    plan,
    with_dependences,
    with_dependents,
)
from robocomp_yaml.network.network import PROGRAM, RestartRule

MOTORS, BASE, ARM = process("motors"), process("base", "motors"), process("arm", "base")
CAMERA = process("camera")
SPARE = process("spare", enabled=False)
ROBOT = network(MOTORS, BASE, ARM, CAMERA, SPARE)


def test_a_process_is_found_by_each_of_its_names() -> None:
    named = network(replace(MOTORS, aliases=("wheels", "m")), CAMERA)
    names = ("motors", "wheels", "m", "camera", "x")
    assert [one and one.name for one in map(named.find, names)] == ["motors", "motors", "motors", "camera", None]


def test_who_names_a_disabled_process_is_told() -> None:
    named = network(replace(SPARE, aliases=("extra",)), CAMERA)
    told = {names: [one.code for one in disabled(named, names)] for names in ((), ("camera", "x"), ("spare", "extra"))}
    assert told == {(): [], ("camera", "x"): [], ("spare", "extra"): ["RC7043", "RC7043"]}


def actions(made: Plan) -> dict[str, str]:
    return {step.name: step.action for step in made.steps.values()}


@pytest.mark.parametrize(
    ("names", "taken"),
    [
        ((), "motors camera base arm"),
        (("motors",), "motors"),
        (("base",), "motors base"),
        (("arm",), "motors base arm"),
        (("arm", "camera"), "motors camera base arm"),
        (("spare",), ""),
        (("nothing",), ""),
    ],
)
def test_up_with_names_includes_dependences(names: tuple[str, ...], taken: str) -> None:
    assert list(plan(ROBOT, {}, names).steps) == taken.split()


def test_up_with_names_ignores_disabled_processes() -> None:
    wanted = network(replace(MOTORS, enabled=False), BASE, ARM)
    assert actions(plan(wanted, {}, ["arm"])) == {"base": START, "arm": START}
    assert with_dependences(wanted, ["motors", "arm"]) == {"base", "arm"}
    assert actions(plan(wanted, {"motors": running(MOTORS)}, ["motors"])) == {}, "it is not stopped either"


@pytest.mark.parametrize(
    ("wanted", "reason"),
    [
        (network(MOTORS), "it is no longer part of the deployment"),
        (network(MOTORS, replace(CAMERA, enabled=False)), "it is disabled"),
    ],
)
def test_processes_that_are_not_desired_stop_first(wanted: object, reason: str) -> None:
    now = {"camera": running(CAMERA), "motors": running(MOTORS)}
    made = plan(wanted, now)  # type: ignore[arg-type]
    assert actions(made) == {"camera": STOP, "motors": KEEP} and next(iter(made.steps)) == "camera"
    stopping = made.steps["camera"]
    assert (stopping.reason, stopping.spec, stopping.before) == (reason, None, now["camera"].spec)


def test_with_names_no_other_process_stops() -> None:
    assert actions(plan(network(MOTORS), {"camera": running(CAMERA)}, ["motors"])) == {"motors": START}


@pytest.mark.parametrize(
    ("state", "last_exit", "action", "reason"),
    [
        (RUNNING, "", KEEP, "nothing changed"),
        (ENDED, "exit code 0", START, "it ended by itself: exit code 0"),
        (WAITING, "exit code 3", START, "it ended by itself: exit code 3"),
        (WAITING, "", START, "it ended by itself"),
        (GIVEN_UP, "SIGSEGV", START, "it was given up: SIGSEGV"),
        (LOST, "", START, "its host did not answer"),
        (STOPPED, "SIGTERM", START, "it was stopped"),
    ],
)
def test_the_action_for_each_state(state: str, last_exit: str, action: str, reason: str) -> None:
    now = {"motors": running(MOTORS, state, last_exit=last_exit)}
    step = plan(network(MOTORS), now).steps["motors"]
    assert (step.action, step.reason, step.running) == (action, reason, now["motors"])
    assert step.spec is not None and step.spec.process == MOTORS


def test_a_process_that_never_ran_starts() -> None:
    step = plan(network(MOTORS), {}).steps["motors"]
    assert (step.action, step.reason, step.before) == (START, "it does not run yet", None)
    assert step.spec and step.spec.process == MOTORS


def test_a_forced_restart_has_its_reason_and_the_changes() -> None:
    changed = replace(MOTORS, cwd="/tmp")
    step = plan(network(changed), {"motors": running(MOTORS)}, forced=["motors"]).steps["motors"]
    assert (step.action, step.reason, [str(one) for one in step.changes]) == (
        RESTART, "its restart was requested", ["cwd: / → /tmp"],
    )  # fmt: skip
    assert actions(plan(network(MOTORS), {"motors": running(MOTORS, STOPPED)}, forced=["motors"])) == {"motors": START}


def test_the_reason_is_the_change_that_needs_a_restart_and_the_number_of_others() -> None:
    changed = replace(MOTORS, restart=RestartRule(tries=9), aliases=("m",), cwd="/tmp")
    step = plan(network(changed), {"motors": running(MOTORS)}).steps["motors"]
    assert (step.action, step.reason) == (RESTART, "cwd: / → /tmp, and 2 more")
    step = plan(network(replace(MOTORS, aliases=("m",))), {"motors": running(MOTORS)}).steps["motors"]
    assert (step.action, step.reason) == (CHANGE, "aliases: m (new)")


PLAIN = replace(BASE, is_ice=False, kind=PROGRAM)


@pytest.mark.parametrize(
    ("follower", "state", "action"),
    [(PLAIN, RUNNING, RESTART), (PLAIN, ENDED, KEEP), (PLAIN, STOPPED, START), (BASE, RUNNING, KEEP)],
)
def test_a_program_without_ice_restarts_with_those_that_it_is_after(follower: object, state: str, action: str) -> None:
    now = {"motors": running(MOTORS), "base": running(follower, state)}  # type: ignore[arg-type]
    wanted = network(replace(MOTORS, cwd="/tmp"), follower)  # type: ignore[arg-type]
    assert actions(plan(wanted, now)) == {"motors": RESTART, "base": action}
    assert "base" in plan(wanted, now, ["motors"]).steps or follower is BASE


def test_a_stopped_process_does_not_follow_a_restart() -> None:
    made = plan(network(replace(MOTORS, cwd="/tmp"), PLAIN), {"motors": running(MOTORS)}, ["motors"])
    assert actions(made) == {"motors": RESTART}


def test_only_a_restart_is_followed_and_is_the_reason() -> None:
    now = {"motors": running(MOTORS), "base": running(PLAIN), "camera": running(CAMERA)}
    several = replace(PLAIN, after=("camera", "motors"))
    now["base"] = running(several)
    made = plan(network(replace(MOTORS, cwd="/tmp"), replace(CAMERA, aliases=("c",)), several), now)
    assert actions(made) == {"motors": RESTART, "camera": CHANGE, "base": RESTART}
    assert made.steps["base"].reason == "it is after motors, which restarts"
    stopped = now | {"motors": running(MOTORS, STOPPED)}
    assert plan(network(MOTORS, CAMERA, several), stopped).steps["base"].action == KEEP


def test_removed_and_added_names_are_listed() -> None:
    before = replace(MOTORS, aliases=("a", "b", "c"), groups=("g",))
    after = replace(MOTORS, aliases=("c", "d", "e"), groups=("g",))
    step = plan(network(after), {"motors": running(before)}).steps["motors"]
    assert [str(one) for one in step.changes] == ["aliases: a, b → d, e"]
    turned = replace(MOTORS, aliases=("b", "a", "c"), groups=("g",))
    step = plan(network(turned), {"motors": running(before)}).steps["motors"]
    assert (step.action, step.reason) == (CHANGE, "aliases changed")


def test_a_plan_that_changes_nothing_is_empty() -> None:
    now = {"motors": running(MOTORS)}
    assert plan(network(MOTORS), now).is_empty
    assert not plan(network(replace(MOTORS, aliases=("m",))), now).is_empty
    assert not plan(network(MOTORS, CAMERA), now).is_empty
    made = plan(network(MOTORS, CAMERA), now)
    assert [step.name for step in made.of(START, STOP)] == ["camera"]


def test_dependents_direct_or_not() -> None:
    after = {"motors": (), "base": ("motors",), "arm": ("base",), "camera": ()}
    assert with_dependents(after, ["base"]) == {"base", "arm"}
    assert with_dependents(after, ["arm", "camera"]) == {"arm", "camera"}


@pytest.mark.parametrize(
    ("after", "order"),
    [
        ({"arm": ["base"], "base": ["motors"], "motors": []}, "motors base arm"),
        ({"a": [], "b": []}, "a b"),
        ({"a": ["elsewhere"], "b": ["a"]}, "a b"),
        ({"a": ["b", "c"], "c": [], "b": ["c"]}, "c b a"),
        ({"a": ["b"], "b": ["a"], "c": ["a"]}, "b a c"),
    ],
)
def test_each_name_is_ordered_after_those_before_it(after: dict[str, list[str]], order: str) -> None:
    assert in_order(after) == order.split()


def test_a_process_of_another_version_is_not_compared() -> None:
    step = plan(network(MOTORS), {"motors": Running("motors", None, "", RUNNING)}).steps["motors"]
    assert (step.action, step.changes, step.before) == (RESTART, (), None)
    assert step.spec is not None


@pytest.mark.parametrize(
    ("before", "now", "action", "reason"),
    [
        ("1", "2", RESTART, "bin/motors changed"),
        ("1", "", RESTART, "bin/motors (gone) changed"),
        ("", "1", RESTART, "bin/motors changed"),
        ("1", "1", KEEP, "nothing changed"),
    ],
)
def test_a_watched_file_that_changes_is_a_reason_to_restart(before: str, now: str, action: str, reason: str) -> None:
    path = os.path.abspath("bin/motors")
    watching = replace(MOTORS, watched=(path,))
    ran = running(watching)
    assert ran.spec is not None
    ran = replace(ran, spec=replace(ran.spec, digests=((path, before),)))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("robocomp_yaml.deploy.spec._digest_of", lambda path: now)
        step = plan(network(watching), {"motors": ran}).steps["motors"]
    assert (step.action, step.reason) == (action, reason)


def test_a_newly_watched_file_is_no_reason() -> None:
    watching = replace(MOTORS, watched=("/no/such/file",))
    assert actions(plan(network(watching), {"motors": running(MOTORS)})) == {"motors": KEEP}
    assert actions(plan(network(MOTORS), {"motors": running(watching)})) == {"motors": KEEP}
