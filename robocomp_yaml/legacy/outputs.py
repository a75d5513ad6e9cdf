"""The files that a run writes: planned against the disk, then written in one transaction per root.

`.rcyaml/migrated.json` has the digest of each file that was written, so that a later run distinguishes its own files
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
"""A document of an earlier version, which remains the user's."""


class Output(msgspec.Struct):
    """One file to write at `path` below the root, converted from `sources`. `state` is what is, or was, to be done."""

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
        """Return a unified diff from the file on the disk to the output, without secrets."""
        old, new = ("".join(secrets.hidden_lines(text)) for text in (self.before, self.text))
        name = "/dev/null" if self.state == CREATED else shown
        return unified(old, new, name, shown)


class OutputRoot(msgspec.Struct):
    """All files that one run writes below one folder."""

    root: Root
    outputs: list[Output] = []
    memory: dict[str, str] = {}
    remembered: bytes | None = None
    problem: str = ""

    @classmethod
    def at(cls, path: str) -> OutputRoot:
        """Return the root at a path. If a run was interrupted in it, that run is rolled back first."""
        root = cls(Root(path))
        try:
            recover(root.root.real)
        except (OSError, WriteFailed) as error:
            root.problem = str(error)
        on_disk = root.root.status(MEMORY)
        root.remembered = on_disk.data
        try:
            digests = json.loads(on_disk.data or b"{}").get("files", {})
            root.memory = {str(path): str(value) for path, value in digests.items()}
        except (ValueError, AttributeError):  # it was edited: then no file is known as written by a run
            root.memory = {}
        return root

    def is_unchanged(self, path: str) -> bool:
        """Whether a file is as an earlier run wrote it."""
        on_disk = self.root.status(path)
        return on_disk.data is not None and self.memory.get(path) == digest(on_disk.data)

    def add(self, path: str, text: str, *, force: bool = False, sources: tuple[str, ...] = ()) -> Output:
        """Plan a file, and return it with its state. `force` overwrites a file that a user edited."""
        on_disk = self.root.status(path)
        data = on_disk.data or b""
        output = Output(path, text, before=data.decode("utf-8", "replace"), sources=sources)
        self.outputs.append(output)
        if on_disk.problem or self.problem:
            output.state, output.problem = FAILED, on_disk.problem or self.problem
        elif not on_disk.exists:
            output.state = CREATED
        elif data == text.encode():
            output.state = UNCHANGED
        elif path not in self.memory:
            output.state = TAKEN
        else:
            output.state = CHANGED if force or self.memory[path] == digest(data) else EDITED
        return output

    def differs_from_last(self, output: Output) -> bool:
        """Whether an output differs from what the last run wrote."""
        return self.memory.get(output.path) != digest(output.text.encode())

    def write(self) -> None:
        """Write the created and changed files. A file that cannot be written gets the state FAILED, and the others are
        written."""
        while True:
            pending = [output for output in self.outputs if output.state in (CREATED, CHANGED, UPGRADED)]
            steps = [self._step(output) for output in pending]
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
                affected = [o for o in pending if o.path == failed.path or (folder and o.path.startswith(f"{folder}/"))]
                for output in affected or pending:
                    output.state, output.problem = FAILED, failed.reason
                if not affected:
                    self.problem = failed.reason
                    return

    def _step(self, output: Output) -> FileStep:
        on_disk = self.root.status(output.path)
        before = None if output.state == CREATED else on_disk.data
        mode = None if output.state == CREATED else on_disk.mode or None
        return FileStep(output.path, before, output.text.encode(), mode=mode, rights=rights_of(output.sources))

    def _memory(self) -> bytes | None:
        """Return the new content of `migrated.json`; None where the file is not needed."""
        digests = dict(self.memory)
        for output in self.outputs:
            was_written = output.state == UPGRADED and digests.get(output.path) == digest(output.before.encode())
            if output.state in (CREATED, CHANGED, UNCHANGED) or was_written:
                digests[output.path] = digest(output.text.encode())
        if not digests and self.remembered is None:
            return None
        return dumps({"files": dict(sorted(digests.items()))}).encode()
