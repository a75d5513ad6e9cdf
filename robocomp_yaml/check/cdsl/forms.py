"""Windows: the form in `src/` agrees with `gui:`."""

from __future__ import annotations

import os
from collections.abc import Iterator
from typing import TYPE_CHECKING

from robocomp_yaml.diag.codes import cdsl as codes
from robocomp_yaml.diag.diagnostic import Diagnostic, Related
from robocomp_yaml.diag.span import Span
from robocomp_yaml.link.program import LinkedComponent, Program
from robocomp_yaml.model.component import Gui
from robocomp_yaml.source.disk import NOTHING, Disk

if TYPE_CHECKING:
    from robocomp_yaml.source.form import Form

FORM = os.path.join("src", "mainUI.ui")
CLASS = "guiDlg"


def check(program: Program) -> Iterator[Diagnostic]:
    for linked in sorted(program.components.values(), key=lambda c: c.component.path):
        if linked.component.gui:
            yield from _form(linked, linked.component.gui, program.disk)


def _form(linked: LinkedComponent, gui: Gui, disk: Disk) -> Iterator[Diagnostic]:
    """Checks the form of a component. A missing form is no error, because `compile` writes one."""
    path = os.path.normpath(os.path.join(os.path.dirname(linked.component.path), FORM))
    if disk.state(path) == NOTHING:
        return
    raw, diagnostics = disk.read(path)
    if raw is None:
        yield from (codes.NOT_A_FORM.at(Span(path), reason=fault.message) for fault in diagnostics)
        return
    from robocomp_yaml.source.form import read  # it imports the parser of XML, which few runs need

    form, diagnostics = read(path, raw)
    yield from diagnostics
    if form is not None:
        yield from _agrees(form, gui)


def _agrees(form: Form, gui: Gui) -> Iterator[Diagnostic]:
    if form.class_name != CLASS:
        shown = f"'{form.class_name}'" if form.class_name else "missing"
        yield codes.NO_DIALOG.at(form.class_span, found=shown, hint=f"write <class>{CLASS}</class>")
    if not form.widget:
        yield codes.NOT_A_FORM.at(form.widget_span, reason="it has no <widget>")
    elif form.widget not in (gui.base, "QWidget"):
        yield codes.OTHER_BASE.at(
            form.widget_span,
            found=form.widget,
            base=gui.base,
            hint=f"write `base: {form.widget}`, or change the form to a {gui.base}",
            related=[Related("the component's `gui:`", gui.span)],
        )
