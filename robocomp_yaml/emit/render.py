"""Renders templates from views.

A view has strings and lists of views. The template's variables are its fields.
"""

from __future__ import annotations

from types import SimpleNamespace

import msgspec
from msgspec.structs import asdict


class View(SimpleNamespace):
    """What templates read: strings, lists, and views."""


def changed(view: View, **fields: object) -> View:
    """A view with other values of some fields."""
    return View(**{**vars(view), **fields})


def render(name: str, view: msgspec.Struct | View = View(), /, **more: object) -> str:
    """Renders the template `templates/NAME`, or `LANGUAGE/NAME` of a language, with the fields of `view`, and more."""
    from robocomp_yaml.emit.jinja import environment  # imports Jinja2, which most runs do not need

    variables = asdict(view) if isinstance(view, msgspec.Struct) else vars(view)
    return environment().get_template(name).render(variables, **more)
