"""The parts of a Qt Designer form that a component document declares: its class and its outermost widget.

The file is not trusted: DTDs and entities are rejected. The parser keeps no stack, so that deep nesting is harmless.
"""

from __future__ import annotations

from xml.parsers import expat

import msgspec

from robocomp_yaml.diag.codes import cdsl as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.span import Span


class Form(msgspec.Struct):
    """`class_name` is the text of `<class>`, `widget` the class of the outermost widget and `name` its name; each is ''
    if absent. The spans are those of the tags."""

    class_name: str = ""
    widget: str = ""
    name: str = ""
    class_span: Span = Span("")
    widget_span: Span = Span("")


class _FormRefused(Exception):
    def __init__(self, what: str) -> None:
        super().__init__(what)
        self.what = what


def read(path: str, raw: bytes) -> tuple[Form | None, list[Diagnostic]]:
    """The form in a file of these bytes; None, with diagnostics, if it is not a form."""
    reader = _FormReader(path)
    try:
        reader.parser.Parse(raw, True)
    except _FormRefused as refused:
        return None, [codes.FORM_WITH_ENTITIES.at(reader.here(), what=refused.what)]
    except (expat.ExpatError, ValueError, LookupError) as error:  # the latter two: an unknown encoding
        reason = expat.ErrorString(error.code) if isinstance(error, expat.ExpatError) else str(error)
        return None, [codes.NOT_A_FORM.at(reader.here(), reason=reason)]
    if reader.root != "ui":
        return None, [codes.NOT_A_FORM.at(Span(path), reason=f"its root is <{reader.root}>, not <ui>")]
    return reader.form, []


class _FormReader:
    def __init__(self, path: str) -> None:
        self.path = path
        self.form = Form(class_span=Span(path), widget_span=Span(path))
        self.root = ""
        self._depth = 0
        self._in_class = False
        self.parser = parser = expat.ParserCreate()
        parser.buffer_text = True
        parser.StartElementHandler = self._start
        parser.EndElementHandler = self._end
        parser.CharacterDataHandler = self._characters
        parser.StartDoctypeDeclHandler = self._doctype

    def here(self, length: int = 1) -> Span:
        line, column = self.parser.CurrentLineNumber, self.parser.CurrentColumnNumber + 1
        return Span(self.path, line, column, line, column + length)

    def _doctype(self, *_: object) -> None:
        raise _FormRefused("document type (<!DOCTYPE …>)")

    def _start(self, name: str, attributes: dict[str, str]) -> None:
        self._depth += 1
        if self._depth == 1:
            self.root = name
        elif self._depth == 2 and name == "class":
            self._in_class = True
            self.form.class_span = self.here(len(name) + 2)
        elif self._depth == 2 and name == "widget" and not self.form.widget:
            self.form.widget, self.form.name = attributes.get("class", ""), attributes.get("name", "")
            self.form.widget_span = self.here(len(name) + 1)

    def _end(self, _: str) -> None:
        self._depth -= 1
        self._in_class = False

    def _characters(self, text: str) -> None:
        if self._in_class:
            self.form.class_name += text.strip()
