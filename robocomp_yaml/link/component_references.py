"""Which document a `component:` or `parameters:` means; where it is none, what should have been written."""

from __future__ import annotations

import json
import os
import re
from robocomp_yaml.diag.suggest import suggest
from robocomp_yaml.source.discover import kind_of

_PLAIN = re.compile(r"[\w./][\w./() -]*[\w./()]")
_WORDS = {
    "idsl": "interfaces", "cdsl": "a component", "pdsl": "parameters", "ddsl": "a deployment", "config": "values",
}  # fmt: skip


def is_document(path: str, kinds: tuple[str, ...]) -> bool:
    return kind_of(path) in kinds and os.path.isfile(path)


def beside(folder: str, kind: str) -> list[str]:
    """The documents of a kind in a folder, sorted."""
    try:
        names = sorted(os.listdir(folder or "."))
    except OSError:
        return []
    return [path for name in names if is_document(path := os.path.normpath(os.path.join(folder, name)), (kind,))]


def components_of(values: str) -> list[str]:
    """The component documents that a values document is `etc/config.yaml` of; none for any other."""
    folder, name = os.path.split(values)
    if name != "config.yaml" or os.path.basename(os.path.abspath(folder)) != "etc":
        return []
    return beside(os.path.normpath(os.path.join(folder, os.pardir)), "cdsl")


def stem(path: str) -> str:
    """`speech` for `speech.cdsl.yaml`."""
    name = os.path.basename(path)
    return name.removesuffix(f"{kind_of(path) or ''}.yaml").removesuffix(".")


def hint(text: str, folder: str, key: str, kinds: tuple[str, ...]) -> str:
    """What to write behind a key where `text` stands, and leads to no document of these kinds from the folder."""
    path = os.path.normpath(os.path.join(folder, text))
    if meant := _completed(path, kinds):
        return write([meant], folder, key)
    if os.path.isdir(path):
        found = [other for kind in kinds for other in beside(path, kind)]
        named = " or ".join(f"NAME.{kind}.yaml" for kind in kinds)
        return f"that is a folder{f': {write(found, folder, key)}' if found else f', without a {named}'}"
    where = os.path.dirname(path)
    if os.path.isfile(path):
        kind = kind_of(path)
        what = f"a document of {_WORDS[kind]}" if kind else "no document of rcyaml"
        near = [other for wanted in kinds for other in beside(where, wanted)]
        return f"that is {what}" + (f"; {write(near, folder, key)}" if near else "")
    if not os.path.isdir(where or "."):
        return f"there is no folder '{where}'"
    names = {os.path.basename(other): other for kind in kinds for other in beside(where, kind)}
    near_by = suggest(os.path.basename(path), names)
    return f"did you mean '{os.path.relpath(names[near_by], folder or '.')}'?" if near_by else ""


def hint_for_name(name: str, folder: str) -> str:
    """The same for a plain name under `component:` in a document of parameters; '' where it may well stand for a
    component that has no document."""
    path = os.path.normpath(os.path.join(folder, name))
    meant = _completed(path, ("cdsl",))
    alone = beside(folder, "cdsl")
    if meant or os.path.isdir(path) or len(alone) != 1 or len(beside(folder, "pdsl")) > 1:
        return hint(name, folder, "component", ("cdsl",)) if meant or os.path.isdir(path) else ""
    return write(alone, folder, "component")  # the only parameters beside the only component


def write(paths: list[str], folder: str, key: str) -> str:
    """The entry that names a document, or one of several."""
    entry = f"`{key}: [{{}}]`" if key == "extends" else f"`{key}: {{}}`"
    return "write " + " or ".join(entry.format(_plain(os.path.relpath(path, folder or "."))) for path in paths[:3])


def _completed(path: str, kinds: tuple[str, ...]) -> str:
    """The document that a path leads to once its end has what it lacks; '' where there is none."""
    for kind in kinds:
        for end in (".yaml", ".yml", f".{kind}", f".{kind}.yml", ""):
            if path.endswith(end) and is_document(f"{path.removesuffix(end)}.{kind}.yaml", (kind,)):
                return f"{path.removesuffix(end)}.{kind}.yaml"
    return ""


def _plain(path: str) -> str:
    """A path as YAML takes it."""
    return path if _PLAIN.fullmatch(path) else json.dumps(path, ensure_ascii=False)
