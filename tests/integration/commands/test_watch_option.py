"""`--watch`: one block for each change, however editors and git write files; Ctrl-C ends it."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from conftest import write_tree
from terminals import COMMAND, environment

pytest.importorskip("watchfiles")
pytestmark = pytest.mark.processes

SPEECH = "module: RoboCompSpeech\ninterfaces: {Speech: {methods: {say: {in: {text: string}}}}}\n"
COMPONENT = "component: SpeechComp\nlanguage: python\nimports: [Speech]\nimplements: [Speech]\n"
PLACE = {
    "rcyaml.yaml": "interfaces: [interfaces]\n",
    "interfaces/Speech.idsl.yaml": SPEECH,
    "speech/speech.cdsl.yaml": COMPONENT,
    "speech/speech.pdsl.yaml": "component: speech.cdsl.yaml\nparameters: {volume: {type: int, default: 3}}\n",
}
WITHIN = 30  # seconds, on a busy machine
END = re.compile(r"^(?:\d+ documents? compiled.*|\d+ documents?: .*)$", re.MULTILINE)


class Watching:
    """A running `--watch`, of which each block is read once."""

    def __init__(self, folder: Path, *args: str) -> None:
        self.folder, self.output, self.seen = folder, folder.parent / "output", 0
        with self.output.open("wb") as output:
            self.process = subprocess.Popen(
                [*COMMAND, *args], cwd=folder, env=environment(), stdout=output, stderr=subprocess.STDOUT
            )
        self.until("Ctrl-C ends it")

    def until(self, text: str) -> str:
        """The output since the last call, which contains this text, once it has ended."""
        limit = time.monotonic() + WITHIN
        while time.monotonic() < limit:
            said = self.output.read_text()[self.seen :]
            if text in said:
                time.sleep(0.6)  # whatever else it would say
                said = self.output.read_text()[self.seen :]
                self.seen += len(said)
                return said
            assert self.process.poll() is None, said
            time.sleep(0.05)
        raise AssertionError(f"{text!r} is not in {said!r}")

    def block(self, change: Callable[[], object], text: str = "compiled") -> str:
        """The one block of output that a change gives."""
        change()
        said = self.until(text)
        assert said.count(" changed\n") == 1, said
        return said

    def silent(self, change: Callable[[], object]) -> None:
        change()
        time.sleep(1.5)
        assert self.output.read_text()[self.seen :] == ""


@pytest.fixture
def start(tmp_path: Path) -> Iterator[Callable[..., Watching]]:
    started: list[Watching] = []

    def begin(*args: str) -> Watching:
        folder = tmp_path / "ws"
        write_tree(folder, PLACE)
        started.append(Watching(folder, *args))
        return started[-1]

    yield begin
    for one in started:
        if one.process.poll() is None:
            one.process.kill()
        one.process.wait()


def _edited(old: str, new: str, path: Path) -> Callable[[], object]:
    return lambda: path.write_text(path.read_text().replace(old, new))


def test_each_change_is_compiled_once(start: Callable[..., Watching]) -> None:
    watching = start("compile", "--watch")
    ws = watching.folder
    interface, component = ws / "interfaces/Speech.idsl.yaml", ws / "speech/speech.cdsl.yaml"
    generated = ws / "slice/Speech.ice"
    assert "say" in generated.read_text()

    said = watching.block(_edited("say:", "utter:", interface))
    assert "interfaces/Speech.idsl.yaml changed\n" in said and "updated" in said
    assert "utter" in generated.read_text()

    before = generated.read_bytes()
    said = watching.block(_edited("string", "strng", interface), "error")
    assert "unknown type 'strng'" in said and "skipped: interfaces/Speech.idsl.yaml (it has errors)" in said
    assert generated.read_bytes() == before
    watching.block(lambda: interface.write_text("module: [\n"), "error")
    assert generated.read_bytes() == before
    watching.block(lambda: interface.write_text(SPEECH))
    assert "say" in generated.read_text()

    watching.silent(lambda: component.write_bytes(component.read_bytes()))
    watching.silent(lambda: (ws / "notes.txt").write_text("x"))

    own = ws / "speech/src/specificworker.py"
    said = watching.block(_edited("say", "sya", own))
    assert "speech/src/specificworker.py changed\n" in said


def test_what_a_run_wrote_and_a_user_edits_is_a_change(start: Callable[..., Watching]) -> None:
    one = start("compile", "--watch")
    config = one.folder / "speech/etc/config"
    said = one.block(lambda: config.write_text(f"{config.read_text()}volume = many\n"), "document")
    assert "volume" in said and "error[" in said and "speech/etc/config changed" in said


def test_as_editors_save(start: Callable[..., Watching]) -> None:
    watching = start("compile", "--watch")
    component = watching.folder / "speech/speech.cdsl.yaml"

    def by_vim() -> None:
        (component.parent / "4913").touch()
        (component.parent / "4913").unlink()
        component.rename(f"{component}~")
        component.write_text(f"{COMPONENT}period: 20\n")
        Path(f"{component}~").unlink()

    def by_renaming() -> None:
        beside = component.with_name("x.tmp")
        beside.write_text(f"{COMPONENT}period: 30\n")
        beside.rename(component)

    def by_emacs() -> None:
        lock = component.with_name(f".#{component.name}")
        lock.symlink_to("me@here.1:2")
        component.with_name(f"#{component.name}#").write_text("component: [")
        component.with_name(f"#{component.name}#").unlink()
        lock.unlink()

    def by_locked_emacs() -> None:
        component.with_name(f".#{component.name}").symlink_to("me@here.1:2")  # it stays while the buffer has changes
        component.write_text(f"{COMPONENT}period: 40\n")

    for save, period in ((by_vim, 20), (by_renaming, 30), (by_locked_emacs, 40)):
        said = watching.block(save)
        assert f"period={period}" in (watching.folder / "speech/generated/component.py").read_text()
        assert "error" not in said
    component.with_name(f".#{component.name}").unlink()
    watching.silent(by_emacs)


def test_many_saves_are_one_change_and_folders_come_and_go(start: Callable[..., Watching]) -> None:
    watching = start("compile", "--watch")
    ws = watching.folder

    def many() -> None:
        for number in range(30):
            write_tree(ws, {f"c{number}/c{number}.cdsl.yaml": COMPONENT.replace("SpeechComp", f"C{number}Comp")})

    assert re.search(r"c\d+/c\d+.cdsl.yaml.* and \d+ more changed", watching.block(many))
    assert (ws / "c29/generated").is_dir()
    away = ws.with_name("away")
    away.mkdir()  # at once, as it may be compiled meanwhile
    watching.block(lambda: [(ws / f"c{number}").rename(away / f"c{number}") for number in range(30)])
    watching.block(lambda: (ws / "speech").rename(ws / "voice"))
    assert (ws / "voice/generated").is_dir()

    aside = ws.with_name("aside")
    ws.rename(aside)
    watching.until("no such file or directory")
    aside.rename(ws)
    watching.until("compiled")
    watching.block(_edited("[Speech]\n", "[Speech]\nperiod: 9\n", ws / "voice/speech.cdsl.yaml"))


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
@pytest.mark.parametrize("command", ["compile", "check"])
def test_a_signal_ends_it(start: Callable[..., Watching], command: str, number: int, code: int) -> None:
    watching = start(command, "--watch")
    os.kill(watching.process.pid, number)
    assert watching.process.wait(timeout=WITHIN) == code
    assert "Traceback" not in watching.output.read_text()


def test_check_writes_nothing(start: Callable[..., Watching]) -> None:
    watching = start("check", "--watch")
    said = watching.block(_edited("int", "itn", watching.folder / "speech/speech.pdsl.yaml"), "error")
    assert "did you mean 'int'?" in said and END.search(said)
    watching.block(_edited("itn", "int", watching.folder / "speech/speech.pdsl.yaml"), "nothing wrong")
    assert not (watching.folder / "slice").exists()


def test_an_import_from_elsewhere_is_watched_as_soon_as_it_is_named(start: Callable[..., Watching]) -> None:
    watching = start("check", "--watch")
    ws, elsewhere = watching.folder, watching.folder.with_name("elsewhere")
    write_tree(elsewhere, {"Mouth.idsl.yaml": "module: RoboCompMouth\ninterfaces: {Mouth: {methods: {shut: {}}}}\n"})
    watching.block(_edited("[interfaces]", "[interfaces, ../elsewhere]", ws / "rcyaml.yaml"), "nothing wrong")
    watching.block(_edited("imports: [Speech]", "imports: [Speech, Mouth]", ws / "speech/speech.cdsl.yaml"), "document")
    said = watching.block(_edited("shut: {}", "shut: {in: {far: flaot}}", elsewhere / "Mouth.idsl.yaml"), "error")
    assert "did you mean 'float'?" in said


@pytest.mark.parametrize("more", ["--dry-run", "--diff", "--check", "--format=json"])
def test_options_that_do_not_fit(tmp_path: Path, more: str) -> None:
    found = subprocess.run(
        [*COMMAND, "compile", "--watch", more], cwd=tmp_path, env=environment(), capture_output=True, text=True
    )
    assert found.returncode == 2 and "--watch" in found.stderr
