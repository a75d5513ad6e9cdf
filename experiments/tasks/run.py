"""The paper's experiment, repeated: five tasks, each done in three ways, counted, and checked over Ice.

`make experiment` runs it, and writes the tables of docs/experiment.md. ROBOCOMPDSL is the command of RoboComp's own
tool; without it, that way is skipped, and the page keeps its figures.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterable, Mapping

from by_hand import ByHand
from measure import HERE, Cost, Failed, Way, fresh
from with_rcyaml import WithRcyaml
from with_robocompdsl import WithRobocompdsl

ROOT = HERE.parent.parent
FOLDER = ROOT / ".experiment"
PAGE = ROOT / "docs" / "experiment.md"
WAYS = (WithRcyaml, WithRobocompdsl, ByHand)
TASKS = {
    "proxy": "a new proxy",
    "interface": "a new provided interface",
    "method": "a new method",
    "class": "a new library and class",
    "network": "deploying a network",
}
FIGURES = {
    "lines": "Lines written or changed",
    "files": "Files touched",
    "commands": "Commands",
    "seconds": "Processor seconds of the commands",
}
Results = dict[str, dict[str, Cost]]  # by way and task


def go(way: Way, tasks: Iterable[str] = TASKS) -> dict[str, Cost]:
    """Does the tasks, one after the other. Raises Failed."""
    way.prepare()
    return {task: way.do(task) for task in tasks}


def figure(cost: Cost, name: str) -> str:
    value = getattr(cost, name)
    return f"{value:.1f}" if name == "seconds" else str(value if isinstance(value, int) else len(value))


def tables(results: Mapping[str, Mapping[str, Mapping[str, str]]]) -> str:
    """The tables of the page, of figures by way, task and name."""
    text = ""
    for name, title in FIGURES.items():
        ways = [cls.name for cls in WAYS]
        text += f"\n| {title} | {' | '.join(ways)} |\n|---|{'---:|' * len(ways)}\n"
        for task, what in TASKS.items():
            cells = (results.get(way, {}).get(task, {}).get(name, "-") for way in ways)
            text += f"| {what} | {' | '.join(cells)} |\n"
    return text


def figures(results: Results) -> dict[str, dict[str, dict[str, str]]]:
    return {
        way: {task: {name: figure(cost, name) for name in FIGURES} for task, cost in costs.items()}
        for way, costs in results.items()
    }


def on_page(text: str) -> dict[str, dict[str, dict[str, str]]]:
    """The figures that the page has."""
    found: dict[str, dict[str, dict[str, str]]] = {}
    titles, tasks = {title: name for name, title in FIGURES.items()}, {what: task for task, what in TASKS.items()}
    name, ways = "", list[str]()
    for line in text.splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if cells[0] in titles:
            name, ways = titles[cells[0]], cells[1:]
        elif cells[0] in tasks and name:
            for way, cell in zip(ways, cells[1:], strict=True):
                if cell != "-":
                    found.setdefault(way, {}).setdefault(tasks[cells[0]], {})[name] = cell
    return found


def main() -> int:
    results: Results = {}
    for cls in WAYS:
        way = cls(fresh(FOLDER / cls.name.replace(" ", "-")))
        if why := way.why_not():
            print(f"{way.name}: skipped: {why}")
            continue
        print(f"{way.name} ...", flush=True)
        results[way.name] = go(way)
    page = PAGE.read_text(encoding="utf-8")
    before, _, rest = page.partition("<!-- tables -->\n")
    inside, _, after = rest.partition("<!-- end -->\n")
    text = tables(on_page(inside) | figures(results))
    PAGE.write_text(f"{before}<!-- tables -->\n{text}\n<!-- end -->\n{after}", encoding="utf-8")
    print(re.sub(r"\n\n+", "\n\n", text))
    print(f"all tasks are done, and checked over Ice; the tables are in {PAGE.relative_to(ROOT)}")
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except Failed as failure:
        sys.exit(f"\n{failure}")
