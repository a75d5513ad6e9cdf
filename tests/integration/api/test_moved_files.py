"""Files and folders that an editor renames: all paths that name them follow, and mean the same."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from conftest import write_tree
from robocomp_yaml import api
from robocomp_yaml.diag.span import Span
from robocomp_yaml.naming.analysis import names_of
from robocomp_yaml.naming.of_files import edits_of_moves, file_after
from robocomp_yaml.source.spelled import DocumentText

MACHINE = (
    '<scxml xmlns="http://www.w3.org/2005/07/scxml" version="1.0" initial="on" name="m"><state id="on"/></scxml>\n'
)
PLACE = {
    "rcyaml.yaml": "interfaces: [interfaces, ./more/interfaces/]\n",
    "interfaces/Speech.idsl.yaml": "module: RoboCompTalk\ntypes: {Voice: {enum: [low, high]}}\ninterfaces: {Speech: {methods: {say: {in: {text: string}}}}}\n",
    "interfaces/Choir.idsl.yaml": "module: RoboCompChoir\nimports: [Speech]  # voices\ninterfaces: {Choir: {methods: {sing: {in: {with: Speech.Voice}}}}}\n",
    "more/interfaces/Ear.idsl.yaml": "module: RoboCompEar\nimports: ['../../interfaces/Speech.idsl.yaml']\ninterfaces: {Ear: {methods: {hear: {in: {of: Speech.Voice}}}}}\n",
    "head/mouth/mouth.cdsl.yaml": "component: MouthComp\nlanguage: python\nimports: [Speech, ../../interfaces/Choir]\nimplements: [Speech, Choir]\nparameters: ./mouth.pdsl.yaml\nstatemachine: \"machine.scxml\"\n",
    "head/mouth/machine.scxml": MACHINE,
    "head/mouth/mouth.pdsl.yaml": "component: mouth.cdsl.yaml\nparameters: {volume: {type: int, default: 3}}\n",
    "head/mouth/etc/config.yaml": "component: ../mouth.cdsl.yaml\nextends: [../../loud.config.yaml]\nparameters: {}\n",
    "head/loud.config.yaml": "component: mouth/mouth.cdsl.yaml\nparameters: {volume: 9}\n",
    "head/ear/ear.cdsl.yaml": "component: EarComp\nlanguage: python\nimports: [Ear, Speech]\nimplements: [Ear]\nrequires: [Speech]\n",
    "deployments/head.ddsl.yaml": "deployment: Head\ncomponents:\n  mouth: {component: ../head/mouth, config: ../loud.config.yaml}\n  ear: {component: ../head/ear/ear.cdsl.yaml, after: [mouth]}\n",
    "deployments/robot.ddsl.yaml": "deployment: Robot\ninclude: {front: head.ddsl.yaml}\ncomponents:\n  second: {component: ../head/ear/, connect: {Speech: front.mouth}}\n",
}  # fmt: skip


def _meaning(root: Path) -> tuple[list[str], list[str], list[str]]:
    """What the documents mean, without their paths."""
    analysis = api.load(str(root)).analysis
    networks = sorted(
        f"{process.name} {one.source} {one.target}"
        for network in analysis.networks.values() for process in network.processes.values()
        for one in network.connections
    )  # fmt: skip
    values = sorted(
        f"{linked.parameters.component.component.name if linked.parameters and linked.parameters.component else None}: {found.data if found else None}"
        for linked in analysis.program.values.values() for found in [analysis.program.effective(linked)[0]]
    )  # fmt: skip
    return sorted(one.code for one in analysis.diagnostics), networks, values


def _move(root: Path, moves: dict[str, str]) -> dict[str, str]:
    """What an editor does. Returns the documents that were edited."""
    analysis = api.load(str(root)).analysis
    real = {str(root / old): str(root / new) for old, new in moves.items()}
    found = edits_of_moves(analysis, names_of(analysis), real)
    made = {}
    for path in {one.span.file for one in found}:
        text = DocumentText(path, Path(path).read_text())
        new = text.text
        for one in sorted((one for one in found if one.span.file == path), key=lambda one: one.span, reverse=True):
            new = new[: _start(text, one.span)] + one.text + new[text.index(one.span.end_line, one.span.end_column) :]
        made[str(Path(path).relative_to(root))] = new
        Path(path).write_text(new)
    for old, new in real.items():
        Path(new).parent.mkdir(parents=True, exist_ok=True)
        shutil.move(old, new)
    return made


def _start(text: DocumentText, span: Span) -> int:
    return text.index(span.line, span.column)


@pytest.mark.parametrize(
    "moves",
    [
        {"interfaces/Speech.idsl.yaml": "interfaces/Talk.idsl.yaml"},
        {"interfaces/Speech.idsl.yaml": "more/interfaces/Speech.idsl.yaml"},
        {"interfaces/Speech.idsl.yaml": "head/mouth/Words-and-more.idsl.yaml"},
        {"interfaces": "slices"},
        {"interfaces": "more/slices", "head": "body"},
        {"more/interfaces/Ear.idsl.yaml": "head/ear/Ear.idsl.yaml"},
        {"head/mouth/mouth.cdsl.yaml": "head/mouth/voice.cdsl.yaml"},
        {"head/mouth/mouth.cdsl.yaml": "head/mouth/a mouth.cdsl.yaml"},
        {"head/mouth/mouth.pdsl.yaml": "head/mouth/voice.pdsl.yaml"},
        {"head/mouth/machine.scxml": "head/mouth/states/machine.scxml"},
        {"head/mouth": "tail"},
        {"head": "body/upper/head"},
        {"head/loud.config.yaml": "loud.config.yaml"},
        {"head/loud.config.yaml": "head/mouth/etc/quiet.config.yaml"},
        {"head/ear/ear.cdsl.yaml": "head/ears/ear.cdsl.yaml"},
        {"deployments/head.ddsl.yaml": "head.ddsl.yaml"},
        {"deployments/robot.ddsl.yaml": "deployments/deep/robot.ddsl.yaml"},
        {"deployments": "launch", "head/mouth/mouth.cdsl.yaml": "head/mouth/m.cdsl.yaml", "interfaces/Choir.idsl.yaml": "interfaces/All.idsl.yaml"},
    ],
    ids=lambda moves: ", ".join(f"{old} → {new}" for old, new in moves.items()),
)  # fmt: skip
def test_documents_mean_the_same_after_a_move(tmp_path: Path, moves: dict[str, str]) -> None:
    root = write_tree(tmp_path / "ws", PLACE)
    before = _meaning(root)
    assert not [code for code in before[0] if code.startswith(("RC2", "RC3", "RC41"))], before
    _move(root, moves)
    assert _meaning(root) == before


def test_a_path_is_written_as_it_was(tmp_path: Path) -> None:
    root = write_tree(tmp_path / "ws", PLACE)
    made = _move(root, {"interfaces/Speech.idsl.yaml": "interfaces/Talk.idsl.yaml", "head/mouth/machine.scxml": "head/mouth/m.scxml",
                        "head/mouth/mouth.pdsl.yaml": "head/mouth/p.pdsl.yaml", "more/interfaces": "even more"})  # fmt: skip
    assert made["interfaces/Choir.idsl.yaml"].splitlines()[1:] == [
        "imports: [Talk]  # voices", "interfaces: {Choir: {methods: {sing: {in: {with: Talk.Voice}}}}}",
    ]  # fmt: skip
    assert made["more/interfaces/Ear.idsl.yaml"].splitlines()[1] == "imports: ['../interfaces/Talk.idsl.yaml']"
    assert 'parameters: ./p.pdsl.yaml\nstatemachine: "m.scxml"\n' in made["head/mouth/mouth.cdsl.yaml"]
    assert made["rcyaml.yaml"] == "interfaces: [interfaces, ./even more/]\n"
    assert set(made) == {"interfaces/Choir.idsl.yaml", "more/interfaces/Ear.idsl.yaml", "head/mouth/mouth.cdsl.yaml",
                         "head/ear/ear.cdsl.yaml", "rcyaml.yaml"}  # fmt: skip


def test_what_still_means_the_same_is_not_touched(tmp_path: Path) -> None:
    root = write_tree(tmp_path / "ws", PLACE)
    assert _move(root, {"head/ear/ear.cdsl.yaml": "head/ear/hearing.cdsl.yaml"}).keys() == {
        "deployments/head.ddsl.yaml"
    }
    assert _move(root, {"deployments/robot.ddsl.yaml": "deployments/all.ddsl.yaml"}) == {}
    Path(root / "head/notes.txt").write_text("x")
    assert _move(root, {"head/notes.txt": "notes.txt"}) == {}


@pytest.mark.parametrize(
    ("path", "kind", "old", "new", "expected"),
    [
        ("speech/speech.cdsl.yaml", "component", "SpeechComp", "VoiceComp", "speech/voice.cdsl.yaml"),
        ("speech/speechcomp.cdsl.yaml", "component", "SpeechComp", "Voice", "speech/voice.cdsl.yaml"),
        ("speech/SpeechComp.cdsl.yaml", "component", "SpeechComp", "VoiceComp", "speech/VoiceComp.cdsl.yaml"),
        ("speech/other.cdsl.yaml", "component", "SpeechComp", "VoiceComp", None),
        ("speech/cdsl.yaml", "component", "SpeechComp", "VoiceComp", None),
        ("Speech.idsl.yaml", "interface", "Speech", "Talk", "Talk.idsl.yaml"),
        ("Speech.idsl.yaml", "module", "RoboCompSpeech", "RoboCompTalk", "Talk.idsl.yaml"),
        ("Speech.idsl.yaml", "method", "Speech", "Talk", None),
        ("head.ddsl.yaml", "deployment", "Head", "Tail", "tail.ddsl.yaml"),
        ("headOne.ddsl.yaml", "deployment", "HeadOne", "HeadTwo", "headTwo.ddsl.yaml"),
    ],
)  # fmt: skip
def test_the_file_of_a_name(path: str, kind: str, old: str, new: str, expected: str | None) -> None:
    assert file_after(path, kind, old, new) == expected
