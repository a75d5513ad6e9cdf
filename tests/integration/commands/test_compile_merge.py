"""`rcyaml compile` after an interface changed: what it reports, what `--merge` writes, and what it does not change."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from conftest import read_tree, write_tree

pytestmark = pytest.mark.processes  # by git

SPEECH = """module: RoboCompSpeech
types:
  Voice: {enum: [low, high]}
interfaces:
  Speech:
    methods:
      say: {in: {text: string}, returns: bool}
      stop:
"""
COMPONENT = "component: SpeechComp\nlanguage: %s\nimports: [Speech]\nimplements: [Speech]\n"
SING = "      sing: {in: {voice: Voice}, returns: Voice}\n"

Run = Callable[..., Result]


@pytest.fixture(params=["python", "cpp"])
def language(request: pytest.FixtureRequest) -> str:
    return request.param


@pytest.fixture
def component(language: str, rcyaml: Run, tmp_path: Path) -> Path:
    """A component with code of its user."""
    write_tree(tmp_path, {"Speech.idsl.yaml": SPEECH, "speech.cdsl.yaml": COMPONENT % language})
    assert rcyaml("compile").exit_code == 0
    for path in sources(tmp_path):
        text = (tmp_path / path).read_text()
        (tmp_path / path).write_text(text.replace('log.info("Speech_say() is', 'log.info("mine: Speech_say() is'))
    return tmp_path


def sources(root: Path) -> dict[str, str]:
    return {f"src/{path}": text for path, text in read_tree(root / "src").items()}


def change(root: Path, old: str, new: str) -> None:
    path = root / "Speech.idsl.yaml"
    assert old in path.read_text()
    path.write_text(path.read_text().replace(old, new))


def diagnostics(rcyaml: Run, *args: str) -> list[dict[str, object]]:
    return json.loads(rcyaml("compile", *args, "--format", "json").stdout)["diagnostics"]


def test_missing_methods_are_reported_by_each_compile(component: Path, language: str, rcyaml: Run) -> None:
    before = sources(component)
    change(component, "      stop:\n", f"      stop:\n{SING}")
    for _ in range(2):
        result = rcyaml("compile")
        assert result.exit_code == 0
        assert "warning[RC6201]: SpecificWorker lacks Speech_sing\n" in result.stdout
        assert f"src/specificworker.{'py' if language == 'python' else 'h'}:" in result.stdout
    if language == "python":
        assert "    from generated.interfaces import RoboCompSpeech\n" in result.stdout
        assert "        def Speech_sing(self, voice: RoboCompSpeech.Voice) -> RoboCompSpeech.Voice:\n" in result.stdout
    else:
        assert "    // in src/specificworker.cpp:\n" in result.stdout
        assert "    RoboCompSpeech::Voice SpecificWorker::Speech_sing(RoboCompSpeech::Voice /*" in result.stdout
    assert sources(component) == before


def test_the_text_to_paste_is_the_missing_methods(component: Path, language: str, rcyaml: Run) -> None:
    change(component, "      stop:\n", f"      stop:\n{SING}")
    (diagnostic,) = diagnostics(rcyaml)
    pasted = str(diagnostic["more"])
    if language == "python":
        line, _, method = pasted.partition("\n")
        path = component / "src/specificworker.py"
        path.write_text(path.read_text().replace("\nclass ", f"{line}\n\n\nclass ", 1) + f"\n{method}\n")
    else:
        declaration, _, definition = pasted.partition("// in src/specificworker.cpp:\n")
        header, source = component / "src/specificworker.h", component / "src/specificworker.cpp"
        header.write_text(header.read_text().replace("\n};", f"\n{declaration}}};"))
        source.write_text(f"{source.read_text()}\n{definition}\n")
    assert diagnostics(rcyaml) == []


def test_a_merge_adds_them(component: Path, rcyaml: Run) -> None:
    change(component, "      say:", f"{SING}      say:")
    result = rcyaml("compile", "--merge")
    assert result.exit_code == 0
    assert "merged   src/specificworker." in result.stdout
    now = "\n".join(sources(component).values())
    assert "Speech_sing(" in now and "mine: Speech_say()" in now
    for path, text in sources(component).items():
        assert (component / ".rcyaml/base" / path).read_text() == text.replace("mine: ", "")
    assert diagnostics(rcyaml) == []
    assert rcyaml("compile", "--check").exit_code == 0


def test_dry_runs_of_a_merge_write_nothing(component: Path, rcyaml: Run) -> None:
    change(component, "      stop:\n", f"      stop:\n{SING}")
    before = read_tree(component)
    assert "would merge   src/specificworker." in rcyaml("compile", "--merge", "--dry-run").stdout
    assert "Speech_sing" in rcyaml("compile", "--merge", "--diff").stdout
    assert rcyaml("compile", "--merge", "--check").exit_code == 1
    assert read_tree(component) == before


def test_a_changed_signature(component: Path, rcyaml: Run) -> None:
    change(component, "{text: string}", "{text: string, times: int}")
    assert {d["code"] for d in diagnostics(rcyaml)} == {"RC6202"}
    assert rcyaml("compile", "--merge").exit_code == 0
    now = "\n".join(sources(component).values())
    assert "times" in now and "mine: Speech_say()" in now
    assert diagnostics(rcyaml) == []


def test_a_renamed_method_is_kept_with_a_warning(component: Path, language: str, rcyaml: Run) -> None:
    change(component, "      stop:\n", "      halt:\n")
    for args in ((), ("--merge",), (), ("--merge",)):
        gone = [d for d in diagnostics(rcyaml, *args) if d["code"] == "RC6203"]
        assert len(gone) == 1 and "Speech_stop" in str(gone[0]["message"])
        assert len(gone[0]["related"]) == (language == "cpp")  # the definition's place
        is_written = "Speech_halt" in "".join(sources(component).values())
        assert ("Speech_halt" in str(gone[0]["hint"])) != is_written
    for path in sources(component):
        text = (component / path).read_text()
        assert "Speech_stop" in text and "Speech_halt" in text


def test_a_conflict_is_shown_and_nothing_is_written(component: Path, language: str, rcyaml: Run) -> None:
    path = component / ("src/specificworker.py" if language == "python" else "src/specificworker.cpp")
    old = "text: str)" if language == "python" else "/*text*/)"
    path.write_text(path.read_text().replace(old, "words: str)" if language == "python" else "words)"))
    change(component, "{text: string}", "{text: string, times: int}")
    change(component, "      stop:\n", f"      stop:\n{SING}")
    before = {name: text for name, text in read_tree(component).items() if "stamps" not in name}
    result = rcyaml("compile", "--merge")
    assert result.exit_code == 1
    assert f"error[RC6204]: '{path.relative_to(component)}' cannot be merged" in result.stdout
    assert "<<<<<<< yours" in result.stdout and "||||||| as generated before" in result.stdout
    line = next(n for n, line in enumerate(path.read_text().splitlines(), 1) if "words" in line)
    assert f"{path.relative_to(component)}:{line}:" in result.stdout
    after = {name: text for name, text in read_tree(component).items() if "stamps" not in name}
    assert {name: text for name, text in after.items() if not name.startswith("slice/")} == {
        name: text for name, text in before.items() if not name.startswith("slice/")
    }


def test_without_a_base_missing_methods_are_added(component: Path, rcyaml: Run) -> None:
    for path in (component / ".rcyaml/base/src").iterdir():
        path.unlink()
    change(component, "      stop:\n", f"      stop:\n{SING}")
    before = sources(component)
    assert rcyaml("compile", "--merge").exit_code == 0
    for path, text in sources(component).items():
        assert "Speech_sing(" in text
        kept = iter(text.splitlines())
        assert all(line in kept for line in before[path].splitlines())
    assert diagnostics(rcyaml) == []


def test_a_method_that_the_user_removed_is_reported(component: Path, language: str, rcyaml: Run) -> None:
    assert diagnostics(rcyaml) == []
    path = component / ("src/specificworker.py" if language == "python" else "src/specificworker.cpp")
    path.write_text(path.read_text().replace("Speech_stop(", "Speech_stopAll("))
    assert {d["code"] for d in diagnostics(rcyaml)} == {"RC6201", "RC6312"}


def test_parts_of_the_class_may_be_in_other_files(component: Path, language: str, rcyaml: Run) -> None:
    if language == "python":
        (component / "src/voice.py").write_text("class Voice:\n    def Speech_stop(self):\n        pass\n")
        path = component / "src/specificworker.py"
        text = path.read_text().replace("(GenericWorker)", "(GenericWorker, Voice)")
        text = text.replace(
            "from generated.genericworker", "from voice import Voice\n\nfrom generated.genericworker", 1
        )
        path.write_text(text.replace("def Speech_stop(", "def quiet("))
    else:
        path = component / "src/specificworker.cpp"
        text = path.read_text()
        (component / "src/voice.cpp").write_text(text[text.index("void SpecificWorker::Speech_stop") :])
        path.write_text(text[: text.index("void SpecificWorker::Speech_stop")])
    assert diagnostics(rcyaml) == []


def test_a_merge_keeps_line_ends(component: Path, rcyaml: Run) -> None:
    for path in sources(component):
        data = (component / path).read_bytes()
        (component / path).write_bytes(data.replace(b"\n", b"\r\n"))
    change(component, "      stop:\n", f"      stop:\n{SING}")
    assert rcyaml("compile", "--merge").exit_code == 0
    for path in sources(component):
        data = (component / path).read_bytes()
        assert b"Speech_sing" in data and data.count(b"\n") == data.count(b"\r\n")


def test_a_file_that_is_no_text_is_not_merged(component: Path, language: str, rcyaml: Run) -> None:
    path = component / ("src/specificworker.py" if language == "python" else "src/specificworker.h")
    path.write_bytes(b"# \xff\n" + path.read_bytes())
    before = path.read_bytes()
    result = rcyaml("compile", "--merge")
    assert (result.exit_code, path.read_bytes()) == (1, before)
    assert "RC6204" in result.stdout and "it is not UTF-8 text" in result.stdout


def test_missing_settings_are_added_to_the_configuration(component: Path, rcyaml: Run) -> None:
    config = component / "etc/config"
    config.write_text(config.read_text().replace("tcp -p ", "tcp -h localhost -p "))
    write_tree(component, {"Mouth.idsl.yaml": SPEECH.replace("Speech", "Mouth")})
    document = component / "speech.cdsl.yaml"
    document.write_text(document.read_text().replace("[Speech]", "[Speech, Mouth]", 1) + "requires: [Mouth]\n")
    before = config.read_text()
    assert [d["code"] for d in diagnostics(rcyaml)] == ["RC6206"]
    assert rcyaml("compile", "--merge").exit_code == 0
    assert config.read_text().startswith(before) and "\nMouthProxy=mouth:tcp" in config.read_text()
    assert diagnostics(rcyaml) == []


@pytest.mark.parametrize("text", ["", "\n", "class SpecificWorker", "}{)(", "\x00"])
def test_a_file_without_the_class(component: Path, language: str, rcyaml: Run, text: str) -> None:
    path = component / ("src/specificworker.py" if language == "python" else "src/specificworker.h")
    path.write_text(text)
    syntax = ["RC6317"] if language == "python" and text.isprintable() and text else []
    assert [d["code"] for d in diagnostics(rcyaml)] == ["RC6205", *syntax]
    assert {d["code"] for d in diagnostics(rcyaml, "--merge")} == {"RC6204"}
    assert path.read_text() == text


def test_a_link_is_not_written_through(component: Path, language: str, rcyaml: Run) -> None:
    path = component / ("src/specificworker.py" if language == "python" else "src/specificworker.h")
    path.rename(component / "elsewhere.txt")
    path.symlink_to("../elsewhere.txt")
    change(component, "      stop:\n", f"      stop:\n{SING}")
    before = read_tree(component / "src")
    assert "RC6204" in {d["code"] for d in diagnostics(rcyaml, "--merge")}
    assert path.is_symlink() and read_tree(component / "src") == before
