"""A key typed in a large deployment: what is analysed again, and what the editor is told."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from conftest import write_tree
from robocomp_yaml import api
from robocomp_yaml.link.linker import Linker
from robocomp_yaml.lsp import session as lsp
from robocomp_yaml.network import processes

MANY = 30
DOCUMENT = "big.ddsl.yaml"
ENTRIES = "".join(f"  c{n}: {{component: arm, host: left, set: {{speed: 0.5}}}}\n" for n in range(MANY))
HEAD = "# a comment\ndeployment: Big\nhosts: {left: 10.0.0.2, right: 10.0.0.3}\ncomponents:\n"
PLACE = {
    "rcyaml.yaml": "",
    "arm/arm.cdsl.yaml": "component: ArmComp\nlanguage: python\n",
    "arm/arm.pdsl.yaml": "component: arm.cdsl.yaml\nparameters: {speed: {type: float, range: [0, 2]}, arm: {type: int}}\n",
    "arm/etc/config.yaml": "component: ../arm.cdsl.yaml\nparameters: {arm: 1, speed: 1}\n",
    DOCUMENT: HEAD + ENTRIES,
}


@pytest.fixture
def living(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> api.LivingWorkspace:
    monkeypatch.chdir(write_tree(tmp_path / "ws", PLACE))
    monkeypatch.setattr("robocomp_yaml.source.parts.LONG", 0)  # as if the document were long
    made = api.follow()
    made.load()
    return made


@pytest.fixture
def counted(living: api.LivingWorkspace, monkeypatch: pytest.MonkeyPatch) -> Callable[[], dict[str, int]]:
    """How often documents other than deployments were linked, and processes made, since the last call."""
    counts = {"linked": 0, "made": 0}
    link, make = Linker.link_named, processes.of_draft

    def linking(*arguments: object) -> None:
        counts["linked"] += 1
        link(*arguments)  # type: ignore[arg-type]

    def making(*arguments: object) -> object:
        counts["made"] += 1
        return make(*arguments)  # type: ignore[arg-type]

    monkeypatch.setattr(Linker, "link_named", linking)
    monkeypatch.setattr(processes, "of_draft", making)

    def of_now() -> dict[str, int]:
        now = dict(counts)
        counts.update(linked=0, made=0)
        return now

    return of_now


@pytest.mark.parametrize(
    ("edit", "linked", "made"),
    [
        (("# a comment", "# another"), 0, 0),
        (("c7: {component: arm, host: left", "c7: {component: arm, host: right"), 0, 1),
        (("c29: {component: arm, host: left, set: {speed: 0.5}", "c29: {component: arm, host: left, set: {speed: 9}"), 0, 1),
        (("c28:", "c-28:"), 0, 1),
        (("  c27:", "\n  c27:"), 0, 4),
        (("c29: {component: arm, host: left, set: {speed: 0.5}}", "c29: {component: arm, host: left, set: {spede: 1}}"), 0, 1),
        (("c6: {component: arm,", "c6: {component: leg,"), 0, 0),
        (("c5: {component: arm,", "c5: [component: arm,"), 1, 0),  # nothing is named any more
    ],
)  # fmt: skip
def test_an_edit_makes_again_what_depends_on_it(
    living: api.LivingWorkspace, counted: Callable[[], dict[str, int]], edit: tuple[str, str], linked: int, made: int
) -> None:  # fmt: skip
    living.edit(DOCUMENT, HEAD + ENTRIES)
    living.look(DOCUMENT)
    counted()
    text = (HEAD + ENTRIES).replace(*edit)
    living.edit(DOCUMENT, text)
    found = living.look(DOCUMENT).check()
    assert counted() == {"linked": linked, "made": made}
    assert found == api.load(DOCUMENT, overlay={DOCUMENT: text}).check()
    counted()
    living.edit(DOCUMENT, HEAD + ENTRIES)
    living.look(DOCUMENT)
    assert counted()["linked"] == 0, "back to what it was"


def test_values_that_a_deployment_completes_are_incomplete_without_it(living: api.LivingWorkspace) -> None:
    Path("arm/etc/part.config.yaml").write_text("component: ../arm.cdsl.yaml\nparameters: {arm: 2}\n")
    entry = "  more: {component: arm, host: left, config: etc/part.config.yaml, set: {speed: 0.5}}\n"
    for more in (entry, entry.replace(", set: {speed: 0.5}", ""), entry, ""):
        living.edit(DOCUMENT, text := HEAD + ENTRIES + more)
        found = living.load().check()
        assert found == api.load(overlay={DOCUMENT: text}).check()
        files = {one.span.file for one in found if one.code == "RC3307"}
        assert ("arm/etc/part.config.yaml" in files) == (more != entry)


def test_a_file_that_changes_counts_after_a_refresh(living: api.LivingWorkspace) -> None:
    living.look(DOCUMENT)
    Path("arm/arm.pdsl.yaml").write_text("component: arm.cdsl.yaml\nparameters: {arm: {type: int}}\n")
    assert "RC3301" not in {one.code for one in living.look(DOCUMENT).check()}
    living.refresh()
    assert "RC3301" in {one.code for one in living.look(DOCUMENT).check()}


def test_an_analysis_that_is_given_up_leaves_nothing_behind(living: api.LivingWorkspace) -> None:
    class GivenUp(Exception):
        pass

    def counting(most: int) -> Iterator[None]:
        yield from range(most)  # type: ignore[misc]
        raise GivenUp

    text = HEAD + ENTRIES.replace("speed: 0.5", "speed: 0.75").replace("c9", "c-9")
    living.edit(DOCUMENT, text)
    for steps in (0, 1, 2, 5, 20):
        count = counting(steps)
        with pytest.raises(GivenUp):
            living.load(on_make=lambda count=count: next(count))  # type: ignore[misc]
    assert living.load().check() == api.load(overlay={DOCUMENT: text}).check()


@pytest.fixture
def session(living: api.LivingWorkspace, monkeypatch: pytest.MonkeyPatch) -> lsp.Session:
    monkeypatch.setattr(lsp, "LONG", -1.0)  # every analysis takes too long for a key
    return lsp.Session([str(Path.cwd())])


def _typed(session: lsp.Session, text: str) -> list[tuple[str, int]]:
    path = str(Path(DOCUMENT).resolve())
    session.edit(lsp.EditedText("", path, text))
    return sorted((one.code, one.span.line) for one in session.of_document(path)[0])


def _at_rest(session: lsp.Session) -> list[tuple[str, int]]:
    root = str(Path.cwd())
    found = session.of_workspace(session.workspace_of_root(root).root)
    return sorted((one.code, one.span.line) for one in found[str(Path(DOCUMENT).resolve())] if one.code != "RC4403")


def test_a_key_in_a_large_deployment_shows_at_once_what_is_wrong_with_the_document(session: lsp.Session) -> None:
    text = HEAD + ENTRIES.replace("c9: {component: arm, host: left", "c9: {component: arm, host: lfet")
    assert ("RC4002", 14) in _typed(session, text)
    assert ("RC4002", 14) in _at_rest(session)
    longer = text.replace("  c3:", "\n  # the third\n  c3:")
    assert ("RC4002", 16) in _typed(session, longer), "it moves with its line"
    broken = longer.replace("c20: {component: arm,", "c20: {component: arm, hots: left,")
    assert {("RC0202", 27), ("RC4002", 16)} <= set(_typed(session, broken))
    unclosed = longer.replace("c20: {component: arm, host: left, set: {speed: 0.5}}", "c20: {component: arm")
    marks = _typed(session, unclosed)
    assert any(code.startswith("RC01") for code, _ in marks) and ("RC4002", 16) in marks
    right = longer.replace("lfet", "left")
    assert ("RC4002", 16) not in _typed(session, right), "its line has changed"
    assert _at_rest(session) == []
    wrong = right.replace("c25: {component: arm,", "c25: {component: arn,")
    assert ("RC4101", 32) not in _typed(session, wrong)
    assert ("RC4101", 32) in _at_rest(session), "the rest follows when typing rests"
    assert ("RC4101", 32) in _typed(session, wrong + "  # end\n")


def test_a_large_deployment_is_opened_with_what_is_wrong_with_it_alone(
    session: lsp.Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    """All that it names is read when typing rests."""
    monkeypatch.setattr(lsp, "MANY", MANY)
    looked: list[str] = []
    monkeypatch.setattr(lsp.Session, "_look", lambda self, workspace, path: looked.append(path))
    text = HEAD + ENTRIES.replace("c9: {component: arm, host: left", "c9: {component: arm, host: lfet")
    assert _typed(session, text + "nonsense: 1\n") == [("RC0202", 35)]
    assert _at_rest(session) == [("RC0202", 35)], "a document with errors of shape is not linked"
    assert _typed(session, text) == []
    assert _at_rest(session) == [("RC4002", 14)]
    assert ("RC4002", 15) in _typed(session, f"# head\n{text}")
    assert looked == []


def test_an_error_that_another_line_repaired_does_not_come_back(session: lsp.Session) -> None:
    """The marks between two rests are those of the last rest, not of the first look."""
    wrong = HEAD.replace("right: 10.0.0.3", "roight: 10.0.0.3") + ENTRIES.replace("c9: {component: arm, host: left", "c9: {component: arm, host: right")  # fmt: skip
    assert ("RC4002", 14) in _typed(session, wrong)
    assert ("RC4002", 14) in _at_rest(session)
    right = wrong.replace("roight", "right")
    _typed(session, right)
    assert "RC4002" not in dict(_at_rest(session))
    assert "RC4002" not in dict(_typed(session, right + "# end\n"))


def test_the_first_completion_uses_the_names_of_the_last_rest(
    session: lsp.Session, monkeypatch: pytest.MonkeyPatch
) -> None:  # fmt: skip
    _typed(session, HEAD + ENTRIES)
    _at_rest(session)
    _typed(session, HEAD + ENTRIES + "  d: {component: a\n")
    path = str(Path(DOCUMENT).resolve())
    monkeypatch.setattr(api.LivingWorkspace, "look", None)  # nothing is analysed
    known = session.names_around(path, may_be_old=True)
    assert {one.name for one in known.names.of_kinds("component")} == {"ArmComp"}
    assert session.names_around(path, may_be_old=True) is known
