"""Windows: the form in `src/` has what `gui:` promises."""

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
    """Nothing where there is no form yet: `compile` writes one."""
    path = os.path.normpath(os.path.join(os.path.dirname(linked.component.path), FORM))
    if disk.state(path) == NOTHING:
        return
    raw, said = disk.read(path)
    if raw is None:
        yield from (codes.NOT_A_FORM.at(Span(path), reason=fault.message) for fault in said)
        return
    from robocomp_yaml.source.form import read  # with the parser of XML, which few need

    form, said = read(path, raw)
    yield from said
    if form is not None:
        yield from _promises(form, gui)


def _promises(form: Form, gui: Gui) -> Iterator[Diagnostic]:
    if form.class_name != CLASS:
        found = f"'{form.class_name}'" if form.class_name else "missing"
        yield codes.NO_DIALOG.at(form.class_span, found=found, hint=f"write <class>{CLASS}</class>")
    if not form.widget:
        yield codes.NOT_A_FORM.at(form.widget_span, reason="it has no <widget>")
    elif form.widget not in (gui.base, "QWidget"):
        yield codes.OTHER_BASE.at(
            form.widget_span,
            found=form.widget,
            base=gui.base,
            hint=f"write `base: {form.widget}`, or make it a {gui.base} in the form",
            related=[Related("the component says so here", gui.span)],
        )
