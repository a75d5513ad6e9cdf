"""What tells a mistake in legacy files, and when: the steps of rcyaml, robocompdsl, the Slice compiler, the language's
compiler, or a run.

`make experiment` writes the tables of docs/mistakes-in-legacy-files.md. ROBOCOMPDSL is the command of RoboComp's own
tool, and ROBOCOMP a checkout of its core, whose classes the generated C++ needs. Cells whose tool is not here keep what
the page says. Words are parts of the names of mistakes: `compare.py proxy` measures only these.
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Mapping
from functools import cache
from pathlib import Path

from legacy_mistakes import DEPLOYING, MISTAKES, TASKS, Mistake
from legacy_way import ERROR, NO_TOOL, NOTHING, ROOT, TRACEBACK, UNSUITED, Legacy, Report, legacy_of
from measure import Failed
from with_robocompdsl import WithRobocompdsl

from robocomp_yaml.diag.codes import table

PAGE = ROOT / "docs" / "mistakes-in-legacy-files.md"
STEPS = ("migrate", "editor", "check", "compile", "build", "deploy")
TOOLS = ("robocompdsl", "slice2cpp", "compiler", "a run")
BEFORE = "reported before anything runs"
NOT_MEASURED = "not measured"
HEAD = ("mistake", *STEPS, *TOOLS, BEFORE)
Cells = dict[str, str]  # by the name of the column


@cache
def without_mistake(language: str) -> dict[str, list[Report]]:
    with tempfile.TemporaryDirectory() as folder:
        return legacy_of(language, Path(folder)).rcyaml()


@cache
def require_silence(language: str) -> None:
    """Raises Failed if RoboComp's tools report something of the component without a mistake: then what they report of
    one with a mistake would mean nothing."""
    with tempfile.TemporaryDirectory() as folder:
        found = reported(legacy_of(language, Path(folder)))
    loud = {tool: cell for tool, cell in found.items() if cell not in (NOTHING, NO_TOOL)}
    if loud:
        raise Failed(f"the component in {language} has no mistake, and the tools report {loud}")


def of_rcyaml(found: Mapping[str, list[Report]], usual: Mapping[str, list[Report]]) -> Cells:
    """The worst that each step reports because of a mistake. `deploy` is the plan, or else the start and one call."""
    cells = {}
    for step in STEPS:
        here = [*found[step], *(found["running"] if step == "deploy" else [])]
        worst = next((one for one in here if one not in usual[step]), None)
        cells[step] = shown(worst) if worst else NOTHING
    return cells


def shown(report: Report) -> str:
    severity, code, _ = report
    if row := table().get(code):
        return f"{severity} [{code}](diagnostics/{row.page}.md#{code.lower()})"
    return code


def of_tools(mistake: Mistake, folder: Path) -> Cells:
    """What RoboComp's own tools report, each as long as those before it did not fail."""
    if mistake.task == DEPLOYING:
        return dict.fromkeys(TOOLS, NO_TOOL) | {"robocompdsl": UNSUITED}
    require_silence(mistake.language)
    return reported(broken(mistake, folder))


def reported(legacy: Legacy) -> Cells:
    cells = dict.fromkeys(TOOLS, NO_TOOL)
    cells["robocompdsl"] = legacy.generate()
    if cells["robocompdsl"] not in (ERROR, TRACEBACK):
        cells |= {"slice2cpp": legacy.slice(), "compiler": legacy.compiler(), "a run": legacy.start()}
    return cells


def broken(mistake: Mistake, folder: Path) -> Legacy:
    legacy = legacy_of(mistake.language, folder)
    for path, old, new in mistake.edits:
        legacy.edit(path, (old, new))
    return legacy


def before(cells: Mapping[str, str]) -> str:
    """Which tools report a mistake before anything runs."""
    ours = any("RC" in cells[step] and "RC7" not in cells[step] for step in STEPS)
    theirs = any(cells[tool] not in (NOTHING, NO_TOOL, UNSUITED) for tool in TOOLS[:-1])
    return {(True, True): "by both", (True, False): "by rcyaml", (False, True): "by the others"}.get(
        (ours, theirs), "-"
    )


def row(mistake: Mistake, cells: Mapping[str, str]) -> str:
    return f"| {' | '.join((mistake.what, *(cells.get(name, NO_TOOL) for name in HEAD[1:])))} |\n"


def on_page(text: str) -> dict[tuple[str, str], Cells]:
    """The rows that a page has, by task and mistake."""
    rows, task, head = dict[tuple[str, str], Cells](), "", list[str]()
    for line in text.splitlines():
        task = line[3:] if line.startswith("## ") else task
        cells = [cell.strip() for cell in line.strip("|").split(" | ")]
        if not line.startswith("| "):
            continue
        if cells[0] == HEAD[0]:
            head = cells
        else:
            rows[task, cells[0]] = dict(zip(head[1:], cells[1:], strict=True))
    return rows


def tables(rows: Mapping[tuple[str, str], Mapping[str, str]]) -> str:
    text = ""
    for task in TASKS:
        text += f"\n## {task}\n\n| {' | '.join(HEAD)} |\n{'|---' * len(HEAD)}|\n"
        text += "".join(row(one, rows.get((task, one.what), {})) for one in MISTAKES if one.task == task)
    return text


def main(*words: str) -> int:
    rows = on_page(PAGE.read_text(encoding="utf-8"))
    with tempfile.TemporaryDirectory() as folder:
        why = WithRobocompdsl(Path(folder)).why_not()
    if why:
        print(f"robocompdsl: skipped: {why}")
    for mistake in MISTAKES:
        if words and not any(word in f"{mistake.task} {mistake.what}" for word in words):
            continue
        cells = rows.setdefault((mistake.task, mistake.what), {})
        if not why:
            with tempfile.TemporaryDirectory() as folder:
                found = of_tools(mistake, Path(folder))
            kept = {name for name, cell in cells.items() if cell != NOT_MEASURED}
            cells |= {name: cell for name, cell in found.items() if cell != NO_TOOL or name not in kept}
        with tempfile.TemporaryDirectory() as folder:
            cells |= of_rcyaml(broken(mistake, Path(folder)).rcyaml(), without_mistake(mistake.language))
        cells[BEFORE] = before(dict.fromkeys(HEAD[1:], NO_TOOL) | cells)
        print(row(mistake, cells), end="", flush=True)
        write(rows)  # so that what was measured stays if the rest is interrupted
    return 0


def write(rows: Mapping[tuple[str, str], Mapping[str, str]]) -> None:
    start, _, rest = PAGE.read_text(encoding="utf-8").partition("<!-- tables -->\n")
    end = rest.partition("<!-- end -->\n")[2]
    PAGE.write_text(f"{start}<!-- tables -->\n{tables(rows)}\n<!-- end -->\n{end}", encoding="utf-8")


if __name__ == "__main__":
    try:
        sys.exit(main(*sys.argv[1:]))
    except Failed as failure:
        sys.exit(f"\n{failure}")
