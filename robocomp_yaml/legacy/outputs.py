"""What a run writes: decided against what stands on the disk, then carried out, all files of a root at once.

`.rcyaml/migrated.json` remembers the digest of each file that was written, so that a later run can tell its own files
from those that a user wrote or edited.
"""

from __future__ import annotations

import json

import msgspec

from robocomp_yaml import secrets
from robocomp_yaml.diag.render.json import dumps
from robocomp_yaml.source.digest import digest
from robocomp_yaml.source.migrated import MEMORY
from robocomp_yaml.transactions.atomic import FileStep, WriteFailed, carry_out, recover
from robocomp_yaml.transactions.changes import unified
from robocomp_yaml.transactions.output_root import Root
from robocomp_yaml.transactions.plan import rights_of

CREATED, CHANGED, UNCHANGED, EDITED, TAKEN, FAILED = "created", "changed", "unchanged", "edited", "taken", "failed"
UPGRADED = "upgraded"
"""An older document of ours, which stays the user's."""


class Output(msgspec.Struct):
    """One file that shall stand at `path` below the root, made of `sources`. `state` says what is, or was, to be done
    about it."""

    path: str
    text: str
    state: str = ""
    before: str = ""
    problem: str = ""
    sources: tuple[str, ...] = ()

    @property
    def differs(self) -> bool:
        return self.state in (CREATED, CHANGED, EDITED, UPGRADED)

    def diff(self, shown: str) -> str:
        """From what stands there to what shall, as a unified diff; secrets are hidden."""
        old, new = ("".join(secrets.hidden_lines(text)) for text in (self.before, self.text))
        name = "/dev/null" if self.state == CREATED else shown
        return unified(old, new, name, shown)


class OutputRoot(msgspec.Struct):
    """All that one run writes below one folder."""

    root: Root
    outputs: list[Output] = []
    memory: dict[str, str] = {}
    remembered: bytes | None = None
    problem: str = ""

    @classmethod
    def at(cls, path: str) -> OutputRoot:
        """The root as it is, put in order if a run was interrupted there."""
        made = cls(Root(path))
        try:
            recover(made.root.real)
        except (OSError, WriteFailed) as error:
            made.problem = str(error)
        found = made.root.status(MEMORY)
        made.remembered = found.data
        try:
            known = json.loads(found.data or b"{}").get("files", {})
            made.memory = {str(path): str(value) for path, value in known.items()}
        except (ValueError, AttributeError):  # not ours any more: what stands there is then not known to be ours
            made.memory = {}
        return made

    def is_ours(self, path: str) -> bool:
        """Whether a file is as an earlier run wrote it."""
        found = self.root.status(path)
        return found.data is not None and self.memory.get(path) == digest(found.data)

    def add(self, path: str, text: str, *, force: bool = False, sources: tuple[str, ...] = ()) -> Output:
        output = Output(path, text, sources=sources)
        self.outputs.append(output)
        found, new = self.root.status(path), text.encode()
        if found.problem or self.problem:
            output.state, output.problem = FAILED, found.problem or self.problem
        elif not found.exists:
            output.state = CREATED
        else:
            data = found.data or b""
            output.before = data.decode("utf-8", "replace")
            known = self.memory.get(path)
            if data == new:
                output.state = UNCHANGED
            elif known is None:
                output.state = TAKEN
            elif known == digest(data) or force:
                output.state = CHANGED
            else:
                output.state = EDITED
        return output

    def has_news(self, output: Output) -> bool:
        """Whether an edited file would get something else than the last run wrote."""
        return self.memory.get(output.path) != digest(output.text.encode())

    def write(self) -> None:
        """Writes what is created and changed; a file that cannot be written is marked, and the others go on."""
        while True:
            todo = [output for output in self.outputs if output.state in (CREATED, CHANGED, UPGRADED)]
            steps = [self._step(output) for output in todo]
            memory = self._memory()
            if memory is not None and memory != self.remembered:
                steps.append(FileStep(MEMORY, self.remembered, memory))
            if not steps:
                return
            try:
                carry_out({self.root.real: steps})
                return
            except WriteFailed as failed:
                folder = failed.path.rpartition("/")[0]
                hit = [o for o in todo if o.path == failed.path or (folder and o.path.startswith(f"{folder}/"))]
                for output in hit or todo:
                    output.state, output.problem = FAILED, failed.reason
                if not hit:
                    self.problem = failed.reason
                    return

    def _step(self, output: Output) -> FileStep:
        found = self.root.status(output.path)
        before = None if output.state == CREATED else found.data
        mode = None if output.state == CREATED else found.mode or None
        return FileStep(output.path, before, output.text.encode(), mode=mode, rights=rights_of(output.sources))

    def _memory(self) -> bytes | None:
        """What is to be remembered; None where there never was anything."""
        known = dict(self.memory)
        for output in self.outputs:
            was_ours = output.state == UPGRADED and known.get(output.path) == digest(output.before.encode())
            if output.state in (CREATED, CHANGED, UNCHANGED) or was_ours:
                known[output.path] = digest(output.text.encode())
        if not known and self.remembered is None:
            return None
        return dumps({"files": dict(sorted(known.items()))}).encode()
