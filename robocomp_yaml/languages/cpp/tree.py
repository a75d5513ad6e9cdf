"""A build tree of CMake, built by Ninja, or by make if Ninja is not installed."""

from __future__ import annotations

import os
import re
import shutil
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress

import msgspec

from robocomp_yaml.building import linker_output
from robocomp_yaml.building.compiler_output import CompilerOutput
from robocomp_yaml.building.job import BuildStep, ComponentBuild, Job
from robocomp_yaml.building.processes import Processes
from robocomp_yaml.building.unit import Unit
from robocomp_yaml.diag.codes import building as codes
from robocomp_yaml.diag.diagnostic import has_errors
from robocomp_yaml.diag.span import Span
from robocomp_yaml.source.regular import text as text_of

NINJA, MAKE = "Ninja", "Unix Makefiles"
LISTS, _CACHE = "CMakeLists.txt", "CMakeCache.txt"
_STATUS = re.compile(r"\[ *(\d+)(?:/(\d+)|%)\] (.*)")
_FAILED = re.compile(r"FAILED: (.*)")
_ERROR = re.compile(r"CMake Error(?: at (?P<file>.*?):(?P<line>\d+) \(.*\)| in (?P<folder>.*?))?: ?(?P<text>.*)")
_CALL = re.compile(r"  (?P<file>\S.*?):(?P<line>\d+) \(.*\)")
_MISSING = re.compile(r"ninja: error: '(?P<file>.*)', needed by '(?P<user>.*)', missing and no known rule to make it")
_DEPS = "#deps"
_UNDEFINED = re.compile(r"undefined reference to [`‘'](.*)['’]")
_LAST = 10  # lines that are shown of a failed step whose output is not understood


def source_of(unit: Unit) -> str:
    """The folder of the CMakeLists.txt that builds the component: its own, or `generated` if its own is RoboComp's."""
    own = text_of(unit.path(LISTS))
    generated = unit.path("generated")
    if (own is None or "component.cmake" not in own) and os.path.isfile(os.path.join(generated, LISTS)):
        return generated
    return unit.folder


class Failure(msgspec.Struct, frozen=True):
    """Why CMake cannot configure a tree: its message, and the locations that led there, the innermost first."""

    text: str
    more: tuple[str, ...]
    locations: tuple[tuple[str, int], ...]

    def is_in(self, source: str) -> bool:
        """Whether the failure is in the component with this CMakeLists.txt."""
        folder = os.path.dirname(source) if os.path.basename(source) == "generated" else source
        return any(_is_below(path, folder) for path, _ in self.locations)

    @property
    def is_of_all(self) -> bool:
        """Whether every component would fail alike: the compiler or Ice is missing."""
        return bool(self.locations) and os.path.basename(self.locations[0][0]) == "rcyaml.cmake"

    def report(self, job: Job, unit: Unit) -> None:
        """Reports the failure at the user's own line if CMake names one, else at the component's document."""
        folder = os.path.abspath(unit.folder)
        if (
            self.locations
            and _is_below(self.locations[0][0], folder)
            and not _is_below(self.locations[0][0], f"{folder}/generated")
        ):
            path, line = self.locations[0]
            text = (text_of(path) or "").splitlines()[line - 1 : line]
            end = len(text[0].rstrip()) + 1 if text else 2
            begin = len(text[0]) - len(text[0].lstrip()) + 1 if text else 1
            span = Span(_shown(path), line, begin, line, max(end, begin + 1))
            job.add([codes.ERROR_OF_COMPILER.at(span, tool="CMake", text=self.text, more="\n".join(self.more))])
        else:
            job.add_failure(unit, self.text, more=self.more)


class BuildTree(msgspec.Struct, frozen=True):
    """`source` is the folder of the CMakeLists.txt, `folder` the tree. Only files below `root` are the user's: changes
    of other files that compilers read are ignored."""

    source: str
    folder: str
    root: str

    @classmethod
    def own_of(cls, unit: Unit) -> BuildTree:
        """The tree of a component outside of a workspace."""
        return cls(source_of(unit), unit.path("build"), unit.folder)

    @property
    def cache(self) -> dict[str, str]:
        """The variables in CMake's cache."""
        lines = (text_of(os.path.join(self.folder, _CACHE)) or "").splitlines()
        pairs = (line.partition("=") for line in lines if line[:1].isalpha())
        return {name.partition(":")[0]: value for name, _, value in pairs}

    @property
    def is_configured(self) -> bool:
        return any(os.path.isfile(os.path.join(self.folder, name)) for name in ("build.ninja", "Makefile"))

    def configure(self, job: Job) -> Failure | None:
        """Runs CMake; returns the failure, if any. Raises FileNotFoundError if CMake is not installed."""
        job.report(BuildStep(0, 0, f"Configuring {_shown(self.folder)}"))
        cache, source = self.cache, os.path.abspath(self.source)
        if cache and os.path.realpath(cache.get("CMAKE_HOME_DIRECTORY", "")) != os.path.realpath(source):
            with suppress(OSError):  # the tree or its sources were moved
                os.unlink(os.path.join(self.folder, _CACHE))
                shutil.rmtree(os.path.join(self.folder, "CMakeFiles"))
            cache = {}
        generator = [] if cache else ["-G", NINJA if shutil.which("ninja") else MAKE]
        lines: list[str] = []
        ended = job.processes.run(
            ["cmake", "-S", source, "-B", os.path.abspath(self.folder), *generator, f"-DCMAKE_BUILD_TYPE={job.type}",
             "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON", *(f"-D{define}" for define in job.defines)], lines.append,
        )  # fmt: skip
        return _failure(lines, source) if ended.code else None

    def make(self, job: Job, parts: Mapping[Unit, str]) -> dict[Unit, ComponentBuild] | Failure:
        """Builds components; `parts` are their folders in the tree, '' for the whole tree. Returns a failure if CMake
        had to configure the tree again and could not."""
        run = _Run(self, job, parts)
        is_ninja = self.cache.get("CMAKE_GENERATOR") != MAKE
        targets = [f"{part}/all" if part else "all" for part in parts.values()]
        before = _log(self.folder)
        command = self._command(job, targets, is_ninja)
        with self._kept(parts):
            ended = job.processes.run(command, run.line, cwd=self.folder, env=_ENVIRONMENT)
        run.flush()
        if run.is_unconfigured:
            return _failure(run.lines, os.path.abspath(self.source))
        if run.impossible is not None and parts.keys() - {run.impossible}:  # Ninja built nothing
            rest = self.make(job, {unit: part for unit, part in parts.items() if unit is not run.impossible})
            return rest if isinstance(rest, Failure) else {run.impossible: ComponentBuild(False, 0, ()), **rest}
        shares = _shares(before, _log(self.folder), ended.cpu)
        read = _read_files(job.processes, self.folder, self.root) if is_ninja else {}
        done: dict[Unit, ComponentBuild] = {}
        for unit, part in parts.items():
            is_made = not ended.code or (unit not in run.failed and self._is_made(job, unit, part, is_ninja))
            mine = (part and f"{part}/", os.path.realpath(unit.program))
            cpu = sum(share for path, share in shares.items() if _is_of(path, *mine))
            files = {file for path, files in read.items() if _is_of(path, *mine) for file in files}
            if not is_made:
                run.explain(unit)
            elif not os.path.exists(unit.program):
                job.add_failure(unit, f"its build did not create {unit.program}")
                is_made = False
            done[unit] = ComponentBuild(is_made, cpu, tuple(sorted(files)))
        return done

    @contextmanager
    def _kept(self, units: Iterable[Unit]) -> Iterator[None]:
        """Restores programs that a linker deleted and did not create again."""
        kept = {unit.program: os.path.join(self.folder, f"{unit.name}.kept") for unit in units}
        for program, other in kept.items():
            with suppress(OSError):
                os.unlink(other)
            with suppress(OSError):
                os.link(program, other, follow_symlinks=False)
        try:
            yield
        finally:
            for program, other in kept.items():
                with suppress(OSError):
                    if not os.path.lexists(program):
                        os.link(other, program, follow_symlinks=False)
                with suppress(OSError):
                    os.unlink(other)

    def _command(self, job: Job, targets: list[str], is_ninja: bool) -> list[str]:
        if is_ninja:
            return ["ninja", "-k", "0", "-j", str(job.jobs), *targets]
        makefile = [] if targets == ["all"] else ["-f", "CMakeFiles/Makefile2"]
        return ["make", "-k", "-j", str(job.jobs), *makefile, *targets]

    def _is_made(self, job: Job, unit: Unit, part: str, is_ninja: bool) -> bool:
        """Whether a component is built in a run in which another one failed: what they share may have failed too."""
        target = [f"{part}/all" if part else "all"]
        return job.processes.run(self._command(job, target, is_ninja), lambda line: None, cwd=self.folder).code == 0


_ENVIRONMENT = {"NINJA_STATUS": "[%f/%t] "}


class _Run:
    """The output of a run of Ninja or make, step by step."""

    def __init__(self, tree: BuildTree, job: Job, parts: Mapping[Unit, str]) -> None:
        self.lines: list[str] = []
        self.failed: dict[Unit, list[str]] = {}
        self.is_unconfigured = False
        self.impossible: Unit | None = None
        """A component that needs a file that nothing makes."""
        self._tree, self._job, self._parts = tree, job, parts
        self._piece: list[str] = []
        self._reader = CompilerOutput(tree.folder, "the C++ compiler")
        self._unassigned: list[str] = []

    def line(self, line: str) -> None:
        self.lines.append(line)
        status = _STATUS.fullmatch(line)
        if status or line.startswith("ninja: "):
            self.flush()
        if status:
            done, total, what = int(status[1]), int(status[2] or 100), status[3]
            self._job.report(BuildStep(done, total, what))
        elif match := _MISSING.fullmatch(line):
            self.impossible = self._owner([match["user"]])
            if self.impossible is None:
                self._unassigned.append(line)
            else:
                reason = f"{match['file']} is missing, and nothing in the build makes it"
                self._job.add_failure(self.impossible, reason)
        elif line.startswith("ninja: error: rebuilding") or "cmake_check_build_system] Error" in line:
            self.is_unconfigured = True
        else:
            self._piece.append(line)

    def flush(self) -> None:
        """Handles the output of the step that has ended."""
        piece, self._piece = self._piece, []
        if not piece:
            return
        found = list(self._reader.diagnostics(piece))
        outputs = next((match[1] for line in piece if (match := _FAILED.match(line))), None)
        owner = self._owner(outputs.split()) if outputs is not None else None
        if owner is not None:
            found += linker_output.diagnostics(piece, lambda path: _users_source(owner, path))
        self._job.add(found)
        if outputs is None:
            self._unassigned += piece
            return
        output = piece[2:]  # without the command
        if owner is not None:
            lines = self.failed.setdefault(owner, [])
            lines += [] if has_errors(found) else output
        elif not has_errors(found):
            self._unassigned += output

    def explain(self, unit: Unit) -> None:
        """Reports why a component is not built, unless the compiler's diagnostics say it."""
        lines = self.failed.get(unit, self._unassigned)
        if lines or not has_errors(self._job.diagnostics):
            shown = [line for line in lines if line.strip() and not line.startswith("collect2:")]
            missing = next((match[1] for line in shown if (match := _UNDEFINED.search(line))), "")
            reason = f"the linker finds no definition of {missing}" if missing else "a step of its build failed"
            self._job.add_failure(unit, reason, more=shown[-_LAST:])

    def _owner(self, outputs: list[str]) -> Unit | None:
        for unit, part in self._parts.items():
            program = os.path.realpath(unit.program)
            if any(_is_of(os.path.join("", path), part and f"{part}/", program) for path in outputs):
                return unit
        return None


def _users_source(unit: Unit, path: str) -> str | None:
    """The user's source that CMake compiles to the object of this path in the folder of the target; None for others."""
    steps = (os.pardir if step == "__" else step for step in path.split("/"))
    source = os.path.normpath(os.path.join(source_of(unit), *steps))
    is_users = not _is_below(source, unit.path("generated")) and os.path.isfile(source)
    return _shown(source) if is_users else None


def _is_of(path: str, part: str, program: str) -> bool:
    """Whether an output of a tree belongs to a component; in a tree of its own, every output does."""
    if "rcyaml_slice_" in path and part:
        return False  # it may be in the folder of any component
    return not part or path.startswith(part) or path == program


def _failure(lines: list[str], source: str) -> Failure:
    """The first error in CMake's output."""
    text: list[str] = []
    locations: list[tuple[str, int]] = []
    for line in lines:
        if match := _ERROR.fullmatch(line):
            if text or locations:
                break
            if match["file"]:
                locations.append((os.path.join(source, match["file"]), int(match["line"])))
            elif match["folder"]:
                locations.append((os.path.join(source, match["folder"]), 1))
            text += [match["text"]] if match["text"] else []
        elif (text or locations) and (call := _CALL.fullmatch(line)):
            locations.append((os.path.join(source, call["file"]), int(call["line"])))
        elif (text or locations) and (line.startswith("  ") or not line) and not line.startswith("Call Stack"):
            text.append(line.strip() and line[2:])
        elif (text or locations) and not line.startswith("Call Stack"):
            break
    head, more = _split(text)
    return Failure(head or "CMake failed", tuple(more or (() if head else lines[-_LAST:])), tuple(locations))


def _split(text: list[str]) -> tuple[str, list[str]]:
    """The first sentence, which CMake wraps, and the lines after it."""
    lines = list(_without_ends(text))
    end = next((at for at, line in enumerate(lines) if not line or line.startswith(" ")), len(lines))
    return " ".join(lines[:end]).rstrip(":"), [line for line in lines[end:] if line]


def _without_ends(lines: list[str]) -> Iterator[str]:
    while lines and not lines[-1].strip():
        lines = lines[:-1]
    while lines and not lines[0].strip():
        lines = lines[1:]
    yield from lines


def _is_below(path: str, folder: str) -> bool:
    return path == folder or path.startswith(f"{folder}/")


def _shown(path: str) -> str:
    relative = os.path.relpath(path)
    return path if relative.startswith(os.pardir) else relative


def _log(folder: str) -> dict[str, tuple[str, ...]]:
    """The entry of the last step of each output: begin and end in milliseconds, time of change, hash."""
    found: dict[str, tuple[str, ...]] = {}
    for line in (text_of(os.path.join(folder, ".ninja_log")) or "").splitlines()[1:]:
        fields = line.split("\t")
        if len(fields) == 5:
            found[fields[3]] = (*fields[:3], fields[4])
    return found


def _shares(
    before: Mapping[str, tuple[str, ...]], after: Mapping[str, tuple[str, ...]], cpu: float
) -> dict[str, float]:
    """The seconds of processor time of each step of a run, in proportion to its duration."""
    taken = {path: int(entry[1]) - int(entry[0]) for path, entry in after.items() if before.get(path) != entry}
    total = sum(taken.values())
    return {path: cpu * time / total for path, time in taken.items()} if total else {}


def _read_files(processes: Processes, folder: str, root: str) -> dict[str, set[str]]:
    """The files below `root` that the compiler read for each object, without those of the tree itself."""
    found: dict[str, set[str]] = {}
    top, tree = (os.path.join(os.path.realpath(one), "") for one in (root, folder))
    known: dict[str, str] = {}
    current: set[str] = set()

    def relative(named: str) -> str:
        """The path relative to the root; '' if the file is not below it."""
        path = os.path.realpath(os.path.join(folder, named))
        return os.path.normpath(os.path.join(root, path[len(top) :])) if _is_in(path, top, tree) else ""

    def line(line: str) -> None:
        nonlocal current
        if line.startswith("    "):
            if line not in known:
                known[line] = relative(line[4:])
            if known[line]:
                current.add(known[line])
        elif _DEPS in line:
            current = found.setdefault(line.partition(f": {_DEPS}")[0], set())

    processes.run(["ninja", "-t", "deps"], line, cwd=folder)
    return found


def _is_in(path: str, top: str, tree: str) -> bool:
    return path.startswith(top) and not path.startswith(tree)
