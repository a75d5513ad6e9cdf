"""The experiment (`experiments/tasks/`): each task is done and checked over Ice, and the page has its figures."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import pytest

from conftest import ROOT

TASKS = ROOT / "experiments" / "tasks"
MODULES = ("run", "by_hand", "measure", "scripted", "wishes", "with_rcyaml", "with_robocompdsl")
COUNTED = ("lines", "files", "commands")

pytestmark = pytest.mark.slow


@pytest.fixture
def experiment(monkeypatch: pytest.MonkeyPatch) -> Iterator[ModuleType]:
    pytest.importorskip("Ice", reason="apt install python3-zeroc-ice")
    monkeypatch.syspath_prepend(str(TASKS))
    yield importlib.import_module("run")
    for name in MODULES:
        sys.modules.pop(name, None)


@pytest.mark.parametrize("way", ["rcyaml", "robocompdsl", "by hand"])
def test_a_way_does_all_tasks_at_the_cost_on_the_page(way: str, experiment: ModuleType, tmp_path: Path) -> None:
    (cls,) = (one for one in experiment.WAYS if one.name == way)
    gone = cls(tmp_path)
    if why := gone.why_not():
        pytest.skip(why)
    costs = experiment.figures({way: experiment.go(gone)})[way]
    shown = experiment.on_page((ROOT / "docs" / "experiment.md").read_text(encoding="utf-8"))[way]
    assert list(costs) == list(experiment.TASKS)
    for task in experiment.TASKS:
        assert {name: costs[task][name] for name in COUNTED} == {name: shown[task][name] for name in COUNTED}, task


def test_what_is_not_done_is_noticed(experiment: ModuleType, tmp_path: Path) -> None:
    """The worker of the first task forgets the mouth."""
    way = experiment.ByHand(tmp_path)
    way.prepare()
    way.do_proxy()
    way.edit("speech/worker.py", ("        self.mouth.open(len(text))\n", ""))
    way.do_proxy = lambda: None
    with pytest.raises(sys.modules["measure"].Failed, match="'proxy' is not done"):
        way.do("proxy")


def test_the_tables_are_read_as_they_are_written(experiment: ModuleType) -> None:
    text = (ROOT / "docs" / "experiment.md").read_text(encoding="utf-8")
    inside = text.partition("<!-- tables -->\n")[2].partition("<!-- end -->")[0]
    assert experiment.tables(experiment.on_page(inside)).strip() == inside.strip()
