"""Reads a component's state machine from the SCXML file that its document names, with all files that it includes."""

from __future__ import annotations

import os
import re

import msgspec

from robocomp_yaml.diag.codes import machines as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, has_errors
from robocomp_yaml.diag.span import Span
from robocomp_yaml.model.build_scxml import IncludedFiles, build
from robocomp_yaml.model.component import Component
from robocomp_yaml.model.scxml_shape import shape_faults
from robocomp_yaml.model.statemachine import StateMachine
from robocomp_yaml.source import xml
from robocomp_yaml.source.disk import FILE, NOTHING, Disk
from robocomp_yaml.source.text import decode

MAX_INCLUDED = 8  # the depth of machines that invoke machines from other files

_SCHEME = re.compile(r"[A-Za-z][A-Za-z0-9+.-]*:")


class MachineReader(msgspec.Struct):
    """Reads a machine. `files` are the paths of all files read."""

    disk: Disk
    files: list[str] = []
    diagnostics: list[Diagnostic] = []
    _open: list[str] = []

    def of(self, component: Component) -> StateMachine | None:
        """The machine that a component's document names; None if it has errors, which are reported."""
        path = os.path.normpath(os.path.join(os.path.dirname(component.path), component.statemachine))
        reason = self._unreadable(path)
        if reason:
            fault = codes.UNREADABLE.at(component.machine_span, path=component.statemachine, reason=reason)
            self.diagnostics.append(fault)
            return None
        return self._machine(path)

    def _unreadable(self, path: str) -> str:
        state = self.disk.state(path)
        return "" if state == FILE else "it is not a file" if state != NOTHING else "the file does not exist"

    def _machine(self, path: str) -> StateMachine | None:
        text = self._text(path)
        if text is None:
            return None
        root, diagnostics = xml.parse(path, text)
        if root is not None:
            diagnostics += shape_faults(root)
        self.diagnostics += diagnostics
        if root is None or has_errors(diagnostics):
            return None
        self._open.append(path)
        before = len(self.diagnostics)
        machine = build(root, path, IncludedFiles(self._included_text, self._included_machine))
        self._open.pop()
        return None if has_errors(self.diagnostics[before:]) else machine

    def _text(self, path: str) -> str | None:
        raw, diagnostics = self.disk.read(path)
        self.diagnostics += diagnostics
        if raw is None:
            return None
        if path not in self.files:
            self.files.append(path)
        text, diagnostics = decode(path, raw)
        self.diagnostics += diagnostics
        return text

    def _included_text(self, src: str, span: Span) -> str | None:
        path = self._included(src, span)
        return self._text(path) if path else None

    def _included_machine(self, src: str, span: Span) -> StateMachine | None:
        path = self._included(src, span)
        if path is None:
            return None
        if path in self._open or len(self._open) >= MAX_INCLUDED:
            reason = (
                "it includes itself"
                if path in self._open
                else f"files include each other more than {MAX_INCLUDED} deep"
            )
            self.diagnostics.append(codes.BAD_SOURCE.at(span, src=src, reason=reason))
            return None
        return self._machine(path)

    def _included(self, src: str, span: Span) -> str | None:
        """The file that `src` names, in the folder of the document or below it; None if it cannot be included."""
        name = src.strip().removeprefix("file:")
        folder = os.path.dirname(self._open[-1])
        path = os.path.normpath(os.path.join(folder, name))
        if _SCHEME.match(name) or name.startswith("//"):
            reason = "only files can be included"
        elif os.path.isabs(name) or os.path.relpath(os.path.realpath(path), os.path.realpath(folder)).startswith(".."):
            reason = "it is not below the document's folder"
        else:
            reason = self._unreadable(path)
        if reason:
            self.diagnostics.append(codes.BAD_SOURCE.at(span, src=src, reason=reason))
            return None
        return path
