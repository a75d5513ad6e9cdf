"""A stamp is up to date as long as the run would read and write the same; any other change makes it stale."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import msgspec
import pytest

from conftest import write_tree
from robocomp_yaml.source.digest import digest
from robocomp_yaml.source.disk import FOLDER, NOTHING
from robocomp_yaml.transactions import stamp

KEY = "0" * 8


@pytest.fixture(autouse=True)
def _in_a_folder_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def run() -> stamp.RunStamp | None:
    """A run that read two documents, one of them by a link, looked for a third, and wrote a program and a once file."""
    Path("docs/far").mkdir(parents=True)
    Path("docs/a.idsl.yaml").write_text("a")
    Path("docs/far/real.idsl.yaml").write_text("b")
    Path("docs/b.idsl.yaml").symlink_to("far/real.idsl.yaml")
    Path("out/bin").mkdir(parents=True)
    Path("out/bin/run").write_text("#!")
    Path("out/bin/run").chmod(0o755)
    Path("out/mine").write_text("mine")
    return stamp.create(
        real=os.path.realpath,
        inputs={"docs/a.idsl.yaml": b"a", "docs/b.idsl.yaml": b"b", "docs/far/real.idsl.yaml": b"b"},
        states={"docs/c.idsl.yaml": NOTHING, "elsewhere/c.idsl.yaml": NOTHING, "docs": FOLDER},
        listed={"docs/far": ["real.idsl.yaml"], "nowhere": []},
        names={"docs/far": ["real.idsl.yaml"]},
        walked={"docs": stamp.walked("docs")},
        outputs={"out/bin/run": digest(b"#!")},
        present=["out/mine"],
        replay={"told": ["é"], "exit": 0},
    )


def current() -> bool:
    kept = stamp.load("out", KEY)
    return kept is not None and stamp.is_current(kept)


def test_an_unchanged_tree_is_up_to_date() -> None:
    taken = run()
    assert taken is not None
    stamp.save("out", KEY, taken)
    assert stamp.load("out", KEY) == taken
    assert current()
    assert taken.replay == {"told": ["é"], "exit": 0}
    os.utime("docs/a.idsl.yaml", (1, 1))
    Path("out/mine").write_text("changed, as a user may")
    Path("docs/notes.txt").write_text("no document")
    assert current()


def relink(path: str, target: str) -> None:
    os.unlink(path)
    os.symlink(target, path)


@pytest.mark.parametrize(
    "change",
    [
        lambda: Path("docs/a.idsl.yaml").write_text("A"),
        lambda: Path("docs/a.idsl.yaml").unlink(),
        lambda: Path("docs/far/real.idsl.yaml").write_text("B"),
        lambda: relink("docs/b.idsl.yaml", "copy"),
        lambda: (Path("docs/copy").write_text("b"), relink("docs/b.idsl.yaml", "copy")),
        lambda: (os.rename("docs/far", "docs/near"), os.symlink("near", "docs/far")),
        lambda: Path("docs/c.idsl.yaml").write_text("c"),
        lambda: (Path("elsewhere").mkdir(), Path("elsewhere/c.idsl.yaml").symlink_to("nowhere")),
        lambda: Path("docs/far/new.cdsl.yaml").write_text("n"),
        lambda: Path("docs/far/other.YAML").write_text("n"),
        lambda: write_tree(Path("nowhere"), {"a.idsl.yaml": ""}),
        lambda: (shutil.rmtree("docs/far"), Path("docs/far").touch()),
        lambda: Path("docs/c.idsl.yaml").mkdir(),
        lambda: Path("out/bin/run").write_text("#! "),
        lambda: Path("out/bin/run").unlink(),
        lambda: Path("out/bin/run").chmod(0o644),
        lambda: (os.rename("out/bin/run", "out/bin/moved"), os.symlink("moved", "out/bin/run")),
        lambda: Path("out/mine").unlink(),
        lambda: os.rename("docs", "papers"),
        lambda: Path("out/.rcyaml/stamps/00000000.json").write_text("{"),
        lambda: Path("out/.rcyaml/stamps/00000000.json").write_text("[1]"),
        lambda: Path("out/.rcyaml/stamps/00000000.json").write_text(
            '{"tool": 1, "inputs": {}, "states": [[]], "listed": {}, "names": {}, "walked": {}, "outputs": {}, "present": [], "replay": {}}'
        ),
        lambda: Path("out/.rcyaml/stamps/00000000.json").write_text('{"inputs": {"a": 1}}'),
        lambda: Path("out/.rcyaml/stamps/00000000.json").write_text("[" * 100_000),
    ],
)
def test_a_change_makes_it_stale(change: Callable[[], object]) -> None:
    taken = run()
    assert taken is not None
    stamp.save("out", KEY, taken)
    assert current()
    change()
    assert not current()


def test_another_rcyaml_makes_it_stale(monkeypatch: pytest.MonkeyPatch) -> None:
    taken = run()
    assert taken is not None
    stamp.save("out", KEY, taken)
    monkeypatch.setattr("robocomp_yaml.__version__", "99")
    assert not current()


@pytest.fixture
def installed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with an installed rcyaml."""
    place = write_tree(tmp_path / "site-packages", {
        "robocomp_yaml/__init__.py": "", "robocomp_yaml/emit/build.py": "pass",
        "robocomp_yaml/_data/templates/a.j2": "a",
        "rcyaml-0.1.0.dist-info/RECORD": "robocomp_yaml/_data/templates/a.j2,sha256=one,1\n",
        "other-1.dist-info/RECORD": "",
    })  # fmt: skip
    monkeypatch.setattr("robocomp_yaml.__file__", str(place / "robocomp_yaml" / "__init__.py"))
    return place


def rewritten(path: Path, text: str) -> None:
    """Writes another text of the same length, with the same date."""
    before = path.stat()
    assert before.st_size == len(text)
    path.write_text(text)
    os.utime(path, ns=(before.st_atime_ns, before.st_mtime_ns))


@pytest.mark.parametrize(
    "change",
    [
        lambda at: rewritten(at / "rcyaml-0.1.0.dist-info/RECORD", "robocomp_yaml/_data/templates/a.j2,sha256=two,1\n"),
        lambda at: rewritten(at / "robocomp_yaml/_data/templates/a.j2", "b"),
        lambda at: rewritten(at / "robocomp_yaml/emit/build.py", "exit"),
        lambda at: (at / "robocomp_yaml/emit/more.py").touch(),
        lambda at: (at / "robocomp_yaml/emit/build.py").rename(at / "robocomp_yaml/emit/built.py"),
        lambda at: (at / "robocomp_yaml/_data/templates/a.j2").unlink(),
        lambda at: (at / "rcyaml-0.1.0.dist-info/RECORD").unlink(),
        lambda at: (at / "rcyaml-0.1.0.dist-info").rename(at / "rcyaml-0.1.0+local.dist-info"),
    ],
)
def test_another_build_of_the_same_version_makes_it_stale(installed: Path, change: Callable[[Path], object]) -> None:
    before = stamp.tool()
    assert stamp.tool() == before
    change(installed)
    assert stamp.tool() != before


@pytest.mark.parametrize(
    "change",
    [
        lambda at: write_tree(at / "robocomp_yaml/emit/__pycache__", {"build.pyc": ""}),
        lambda at: write_tree(at, {"other-1.dist-info/RECORD": "more", "another/__init__.py": ""}),
    ],
)
def test_other_files_do_not_make_it_stale(installed: Path, change: Callable[[Path], object]) -> None:
    before = stamp.tool()
    change(installed)
    assert stamp.tool() == before


def test_a_distribution_without_records(installed: Path) -> None:
    shutil.rmtree(installed / "rcyaml-0.1.0.dist-info")
    before = stamp.tool()
    rewritten(installed / "robocomp_yaml/_data/templates/a.j2", "b")
    assert stamp.tool() != before


def test_the_stamp_has_what_was_read_not_what_is_there_now() -> None:
    """The user saved a document while rcyaml was compiling its former text."""
    taken = run()
    assert taken is not None
    Path("docs/a.idsl.yaml").write_text("a changed")
    late = stamp.create(
        inputs={"docs/a.idsl.yaml": b"a"},
        real=os.path.realpath,
        states={},
        listed={},
        names={},
        walked={},
        outputs={},
        present=[],
        replay={},
    )
    assert late is not None and not stamp.is_current(late)


def test_different_runs_have_different_keys(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    keys = {stamp.key([]), stamp.key(["-o", "x"]), stamp.key(["-ox"])}
    monkeypatch.setenv("RCYAML_PATH", "/somewhere")
    keys.add(stamp.key([]))
    (tmp_path / "below").mkdir()
    monkeypatch.chdir("below")
    keys.add(stamp.key([]))
    assert len(keys) == 5


def test_a_stamp_that_cannot_be_saved_is_no_error() -> None:
    taken = run()
    assert taken is not None
    Path("blocked").write_text("a file")
    stamp.save("blocked", KEY, taken)
    assert stamp.load("blocked", KEY) is None


def test_old_stamps_are_removed() -> None:
    taken = run()
    assert taken is not None
    for number in range(40):
        stamp.save("out", f"{number:08}", taken)
    names = sorted(path.name for path in Path("out/.rcyaml/stamps").iterdir())
    assert len(names) == 33 and names[0] == ".gitignore"


def test_little_is_imported() -> None:
    code = "import sys, robocomp_yaml.transactions.stamp as s; print(*(m.partition('.')[0] for m in sys.modules))"
    out = subprocess.run(
        [sys.executable, "-S", "-c", code],
        capture_output=True,
        text=True,
        check=True,
        env={"PYTHONPATH": f"{Path(stamp.__file__).parents[2]}:{Path(msgspec.__file__).parents[1]}"},
    )
    assert set(out.stdout.split()) - sys.stdlib_module_names <= {
        "robocomp_yaml",
        "__main__",
        "msgspec",
        "typing_extensions",
    }
