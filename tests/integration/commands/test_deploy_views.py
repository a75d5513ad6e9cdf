"""The output of deployments, without any process."""

from __future__ import annotations

import asyncio
import io
import sys
from collections.abc import Callable

import pytest
from click.testing import Result

from networks import speaking
from robocomp_yaml.commands._deploy_views import status_lines
from robocomp_yaml.commands._progress import Progress
from robocomp_yaml.deploy.carry_out import STARTING, ProcessEvent
from robocomp_yaml.deploy.operations import Status


def test_a_table_of_states_fits_its_terminal() -> None:
    network = speaking()
    found = [Status(process.name, process.host, False) for process in network.enabled()]
    whole = status_lines(network, found, False)
    assert any("Laser:10003, DifferentialRobot:10004" in line for line in whole)
    narrow = status_lines(network, found, False, 80)
    assert max(map(len, narrow)) == 80 and any("Laser:10003, Dif" in line and line.endswith("…") for line in narrow)
    assert status_lines(network, found, False, 200) == whole
    least = status_lines(network, found, False, 10)
    assert any(line.endswith("  Laser…") for line in least)  # no narrower than the column's head


def test_hosts_are_shown_if_there_are_several() -> None:
    network = speaking()
    found = [Status(process.name, process.host, False) for process in network.enabled()]
    assert len({one.host for one in found}) > 1 and "HOST" in status_lines(network, found, False)[0]
    here = [one for one in found if one.host == found[0].host]
    assert "HOST" not in status_lines(network, here, False)[0]


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_progress_has_one_line_for_each_process_on_a_narrow_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = Terminal()
    monkeypatch.setattr(sys, "stdout", terminal)
    monkeypatch.setenv("COLUMNS", "12")
    name = "a-process-with-a-long-name"

    async def work() -> None:
        Progress(True, False, [name]).report(ProcessEvent(name, STARTING))

    asyncio.run(work())
    assert terminal.getvalue() == "a-process-…\n"


@pytest.mark.parametrize("option", ["-v", "--quiet", "--color"])
def test_a_global_option_is_written_before_the_command(rcyaml: Callable[..., Result], option: str) -> None:
    result = rcyaml("deploy", "plan", ".", option)
    assert (
        result.exit_code == 2
        and f"'{option}' is an option of rcyaml: write it before the command, rcyaml {option} …" in result.stderr
    )
