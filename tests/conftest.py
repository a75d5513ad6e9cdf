"""What all tests share: trees of files, running rcyaml, and golden files."""

from __future__ import annotations

import gc
import os
import signal
from collections.abc import Callable, Generator, Mapping
from functools import cache
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

import in_memory
import own_ports
import tiers
from robocomp_yaml import api
from robocomp_yaml.cli import group
from robocomp_yaml.diag.diagnostic import ERROR
from robocomp_yaml.diag.render.json import as_data
from robocomp_yaml.link.program import LinkedComponent

ROOT = Path(__file__).resolve().parent.parent
CORPUS = ROOT.parent / "shared" / "corpus"

FUZZING = bool(os.environ.get("RCYAML_FUZZ"))

# What takes longest begins first where whole files are handed out to several processes (`--dist loadfile`).
LONGEST = (
    "test_changes", "test_cut_links", "test_fuzz_strings", "test_icegrid_moves", "test_cpp_qt", "test_clock", "test_cpp_build", "test_merge", "test_cpp_config",
    "test_icegrid", "test_parameters", "test_compile_migrated", "test_cpp_names", "test_cpp_topics", "test_cpp_calls",
    "test_cpp_stop", "test_verdicts_cpp", "test_engines", "test_packages", "test_icegrid_faults", "test_migrate_config",
    "test_cpp_corpus", "test_cpp_absent", "test_values_ice", "test_docs", "test_mistakes", "test_statemachine", "test_schemas", "test_codes",
)  # fmt: skip

IS_LONG = "RCYAML_ALL_BUILDS" in os.environ
"""Whether this is `make test-long`."""

# Where there is another one of its kind.
in_long = pytest.mark.skipif(not IS_LONG, reason="another one of its kind is tested: RCYAML_ALL_BUILDS=1 tests all")

needs_corpus = pytest.mark.skipif(not CORPUS.is_dir(), reason="the corpus of legacy files is not beside the checkout")


@pytest.fixture(autouse=True, scope="session")
def own_state(tmp_path_factory: pytest.TempPathFactory) -> Generator[None]:
    """Deployments of tests are not in the list of the user who runs the tests, and their units are not the user's."""
    with pytest.MonkeyPatch.context() as patch:
        use_folders_in(tmp_path_factory.mktemp("user"), patch)
        yield


def use_folders_in(home: Path, patch: pytest.MonkeyPatch) -> None:
    """What rcyaml keeps for a user is kept in this folder, and no systemd of the user is reached."""
    for name in ("state", "config", "runtime"):
        (home / name).mkdir(parents=True)
    patch.setenv("XDG_STATE_HOME", str(home / "state"))
    patch.setenv("XDG_CONFIG_HOME", str(home / "config"))
    patch.setenv("XDG_RUNTIME_DIR", str(home / "runtime"))
    patch.delenv("DBUS_SESSION_BUS_ADDRESS", raising=False)


Tree = Mapping[str, "str | bytes | None"]


def write_tree(folder: Path, files: Tree) -> Path:
    """Writes a tree: text, bytes, None for an empty folder, '-> target' for a symlink."""
    for name, content in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if content is None:
            path.mkdir(exist_ok=True)
        elif isinstance(content, bytes):
            path.write_bytes(content)
        elif content.startswith("-> "):
            path.symlink_to(content.removeprefix("-> "))
        else:
            path.write_text(content, encoding="utf-8")
    return folder


def unsaved(files: Tree) -> dict[str, bytes]:
    """The texts of a tree by path, as an editor has them that did not save them in the working folder. All else of the
    tree, such as links, is written."""
    texts = {name: text for name, text in files.items() if isinstance(text, str) and not text.startswith("-> ")}
    write_tree(Path(), {name: content for name, content in files.items() if name not in texts})
    return {os.path.abspath(name): text.encode() for name, text in texts.items()}


def read_tree(folder: Path) -> dict[str, str]:
    """Every file below a folder, path to text, sorted; without what Python itself leaves there."""
    return {
        str(path.relative_to(folder)): path.read_text(encoding="utf-8")
        for path in sorted(folder.rglob("*"))
        if path.is_file() and "__pycache__" not in path.parts
    }


@pytest.fixture
def rcyaml(request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., Result]:
    """Runs `rcyaml ARGS` in tmp_path, in this process; ports that others have are free to it."""
    own_ports.only(None if request.node.get_closest_marker("unit") else tmp_path, monkeypatch)
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("RCYAML_PATH", raising=False)

    def run(*args: str, stdin: str | None = None) -> Result:
        result = CliRunner().invoke(group, list(args), stdin, prog_name="rcyaml")
        if result.exception and not isinstance(result.exception, SystemExit):
            raise result.exception  # a traceback is never right
        return result

    return run


@pytest.fixture
def diagnostics(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., list[dict[str, object]]]:
    """The diagnostics that `rcyaml check` gives for a tree, as data."""
    monkeypatch.chdir(tmp_path)

    def check(files: Tree, *paths: str) -> list[dict[str, object]]:
        return [as_data(one) for one in api.load(*paths, overlay=unsaved(files)).check()]

    return check


@pytest.fixture
def link() -> Callable[[Tree], LinkedComponent]:
    """`link({path: YAML})`: the one component among the documents. Tests that have the same documents share it."""
    return lambda documents: _linked(tuple(documents.items()))


@cache
def _linked(documents: tuple[tuple[str, str], ...]) -> LinkedComponent:
    analysis = in_memory.analysed(dict(documents))
    assert [d for d in analysis.diagnostics if d.severity == ERROR] == []
    (component,) = analysis.program.components.values()
    return component


def use_memory() -> None:
    """Thousands of small folders are made and removed in memory, where the machine has it as folder: a disk takes
    a tenth of the time of the unit tests."""
    if os.access("/dev/shm", os.W_OK):
        os.environ.setdefault("PYTEST_DEBUG_TEMPROOT", "/dev/shm")


def leave_out_plugins(config: pytest.Config) -> None:
    """Units need no thread that waits for a hang of the whole process, no records of logs, no repetitions and no
    summary of random examples. For each test, that costs as much as a simple test."""
    for name in ("faulthandler", "logging-plugin", "rerunfailures", "hypothesispytest"):
        plugin = config.pluginmanager.get_plugin(name)
        if plugin is not None:
            config.pluginmanager.unregister(plugin)


def settle_random_tests() -> None:
    """Random tests take the same examples in every run, here and in CI; `make fuzz` looks for new ones. Units have no
    random tests, and do without the time of the import."""
    from hypothesis import HealthCheck, settings
    from hypothesis.database import DirectoryBasedExampleDatabase

    settings.register_profile(
        "fixed", derandomize=True, database=None, deadline=None, print_blob=True,
        suppress_health_check=[HealthCheck.too_slow],
    )  # fmt: skip
    settings.register_profile(
        "fuzz", derandomize=False, database=DirectoryBasedExampleDatabase(ROOT / ".fuzz" / "examples"), deadline=None,
        print_blob=True, suppress_health_check=list(HealthCheck),
    )  # fmt: skip
    settings.load_profile("fuzz" if FUZZING else "fixed")


# After all plugins, some of which are registered this late.
@pytest.hookimpl(trylast=True)
def pytest_configure(config: pytest.Config) -> None:
    """Tests interrupt what they start, which ignores that if we do: so does what a script runs in the background."""
    if config.option.markexpr == "unit":
        use_memory()
        leave_out_plugins(config)
    else:
        settle_random_tests()
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)


def pytest_collection_finish() -> None:
    """The garbage collector skips what lives as long as the run, and looks for cycles less often: a tenth of the time
    of the unit tests. A hundred thousand objects more are still little memory."""
    gc.freeze()
    gc.set_threshold(100_000, 10, 10)


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    return True if tiers.is_left_out(collection_path, config) else None


# Before `-m` chooses among them.
@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    for item in items:
        tiers.mark(item)
    if "PYTEST_XDIST_WORKER" in os.environ:
        ranks = {name: rank for rank, name in enumerate(LONGEST)}
        items.sort(key=lambda item: ranks.get(item.path.stem, len(LONGEST)))


@pytest.hookimpl(wrapper=True)
def pytest_runtest_setup(item: pytest.Item) -> Generator[None]:
    with tiers.watched(item):
        return (yield)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item: pytest.Item) -> Generator[None]:
    with tiers.watched(item):
        return (yield)


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--update-golden", action="store_true", help="write what the tests got as the golden files")


@pytest.fixture
def golden(request: pytest.FixtureRequest) -> Callable[[str, Mapping[str, str]], None]:
    """Compares `{path: text}` with the folder `tests/golden/NAME`; --update-golden makes them equal."""

    def compare(name: str, got: Mapping[str, str]) -> None:
        folder = ROOT / "tests" / "golden" / name
        if request.config.getoption("--update-golden"):
            for stale in set(read_tree(folder)) - set(got) if folder.is_dir() else ():
                os.unlink(folder / stale)
            write_tree(folder, got)
        assert folder.is_dir(), f"no golden files yet: run pytest --update-golden, and read {folder}"
        assert dict(got) == read_tree(folder)

    return compare
