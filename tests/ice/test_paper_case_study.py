"""The paper's case study (`examples/case_study.py`): four changes, each compiled, built, deployed, and looked at from
outside over Ice."""

from __future__ import annotations

import os
import resource
import shutil
import subprocess
import sys
import wave
from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

import pytest

from conftest import ROOT
from cpp_programs import needs_cpp
from processes import Ports, kill_left

pytestmark = [pytest.mark.slow, needs_cpp]

CPU = 180.0  # seconds, of all commands
SPEECH, MOTORS = "components/speech", "components/jointmotor"


@pytest.fixture
def case_study(tmp_path: Path, free_port: Ports, monkeypatch: pytest.MonkeyPatch) -> Iterator[object]:
    """The module's CaseStudy in a folder of the test, with ports of its own."""
    pytest.importorskip("Ice", reason="Ice for Python is not installed (Debian: python3-zeroc-ice)")
    monkeypatch.syspath_prepend(str(ROOT / "examples"))
    import case_study as module

    study = module.CaseStudy(tmp_path / "study")
    study.copy()
    first = free_port()
    settings = study.session.folder / "rcyaml.yaml"
    settings.write_text(f"{settings.read_text()}ports: {{from: {first}, to: {first + 40}}}\n")
    yield study
    study.session.answer("deploy", "down")
    kill_left(str(study.session.folder / ".rcyaml" / "deployments" / "Head"))
    for name in ("case_study", "session"):
        sys.modules.pop(name, None)


def test_the_mouth_moves_with_the_voice(case_study, capfd) -> None:  # type: ignore[no-untyped-def]
    from case_study import DEPLOYMENT, METHOD, PARAMETER, PROXY, walk

    assert not [path for edits in (PROXY, PARAMETER, DEPLOYMENT) for path in edits if "/src/" in path]
    assert any("/src/" in path for path in METHOD)
    session, folder, reached = case_study.session, case_study.session.folder, []

    def look(step: str) -> None:
        reached.append(step)
        status = session.answer("deploy", "status")["processes"]
        assert {one["name"] for one in status} == (
            {"speech", "mouth", "motors"} if step in ("deployment", "method") else {"speech"}
        )
        known = session.answer("param", "list", "speech")["parameters"]
        names = {one["path"] for one in known}
        assert ("MouthProxy" in names) == (step != "speech")
        assert ("mouthSynchronization" in names) == (step not in ("speech", "proxy"))
        if step == "deployment":
            assert set(session.answer("call", "motors.JointMotor.getPositions")["returns"]) == {"upper", "lower"}
            session.run("rcyaml", "call", "mouth.Mouth.setLoudness", "loudness=1")
            widths = session.answers("call", "mouth.Mouth.getOpening", "--repeat", "8", "--every", "0.1 s")
            assert widths[-1]["returns"] == 0.0, widths  # it closes by itself

    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    widths: list[list[float]] = []
    openings = case_study.openings

    def kept() -> list[float]:
        widths.append(openings())
        return widths[-1]

    case_study.openings = kept
    walk(case_study, look)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    assert reached == ["speech", "proxy", "parameter", "deployment", "method"]
    moving, still = widths
    assert max(moving) > 5 and len(set(moving)) > 3, moving
    assert set(still) == {0.0}
    assert "without a mouth" in capfd.readouterr().out

    sounds = sorted((folder / SPEECH / "sounds").glob("*.wav"))
    with wave.open(str(sounds[-1]), "rb") as sound:
        assert sound.getnframes() > sound.getframerate() / 2
    ways = ElementTree.parse(folder / MOTORS / "ways.svg").getroot()
    lines = [one for one in ways.iter() if one.tag.endswith("polyline")]
    assert len(lines) == 2 and all(len(one.get("points", "").split()) > 10 for one in lines)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    assert cpu < CPU, f"{cpu:.1f} s"


def test_without_espeak(tmp_path: Path) -> None:
    """Each letter is a tone then."""
    voice = ROOT / "examples" / "speech" / SPEECH / "src" / "voice.py"
    shutil.copy(voice, tmp_path)
    program = (
        "import voice, pathlib\nfile = pathlib.Path('sounds/1.wav')\n"
        "print(voice.speak('Hi, you', 'en', file), *(round(one, 2) for one in voice.loudness(file, 0.08)))\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=tmp_path, env={**os.environ, "PATH": ""}, capture_output=True, text=True,
    )  # fmt: skip
    assert done.stderr == ""
    by, *loud = done.stdout.split()
    assert by == "tones" and len(loud) == len("Hi, you")
    assert loud[2] == loud[3] == "0.0" and max(map(float, loud)) == 1.0
