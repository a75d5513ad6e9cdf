"""Resolves `component:`, `parameters:` and `extends:`; for a text that refers to no document, makes the hint."""

from __future__ import annotations

import os

import msgspec
from msgspec.structs import replace

from robocomp_yaml.diag.fix import NO_HINT, Hint
from robocomp_yaml.diag.suggest import meaning, suggest
from robocomp_yaml.patterns import pattern
from robocomp_yaml.source.discover import kind_of, name_of_folder
from robocomp_yaml.source.disk import Disk
from robocomp_yaml.source.yaml_text import quoted

_PLAIN = pattern(r"[\w./][\w./() -]*[\w./()]")
_WORDS = {
    "idsl": "interfaces", "cdsl": "a component", "pdsl": "parameters", "ddsl": "a deployment", "config": "values",
}  # fmt: skip


class ReferenceHint(msgspec.Struct, frozen=True):
    """The hint at a text that refers to no document; `is_known` if the text refers to something else that exists."""

    hint: Hint = NO_HINT
    is_known: bool = False


class References(msgspec.Struct, frozen=True):
    """Resolves references to documents on a disk, whose folders are read once."""

    disk: Disk
    _beside: dict[tuple[str, str], list[str]] = {}

    def is_document(self, path: str, kinds: tuple[str, ...]) -> bool:
        if os.path.basename(path) == "config.yaml" and self.disk.has_file(path):
            self.disk.read(path)  # its content may decide whether it is a document of rcyaml
        return kind_of(path, self.disk) in kinds and self.disk.has_file(path)

    def beside(self, folder: str, kind: str) -> list[str]:
        """The documents of a kind in a folder, sorted."""
        if (folder, kind) not in self._beside:
            paths = (os.path.normpath(os.path.join(folder, name)) for name in self.disk.documents(folder))
            self._beside[folder, kind] = [path for path in paths if self.is_document(path, (kind,))]
        return self._beside[folder, kind]

    def components_of(self, values: str) -> list[str]:
        """The component documents of which a path is `etc/config.yaml`; none for other paths."""
        folder, name = os.path.split(values)
        if name != "config.yaml" or name_of_folder(folder) != "etc":
            return []
        return self.beside(os.path.normpath(os.path.join(folder, os.pardir)), "cdsl")

    def hint_for(self, text: str, folder: str, key: str, kinds: tuple[str, ...], own: str = "") -> ReferenceHint:
        """The hint for `text` under a key, which refers to no document of these kinds, relative to the folder. The hint
        does not name `own`, the document with the text."""
        path = os.path.normpath(os.path.join(folder, text))
        if meant := self._completed(path, kinds):
            return ReferenceHint(entry_hint([meant], folder, key, text, safe=True), is_known=True)
        if self.disk.has_folder(path):
            found = [other for kind in kinds for other in self.beside(path, kind)]
            named = " or ".join(f"NAME.{kind}.yaml" for kind in kinds)
            hint = entry_hint(found, folder, key, text)
            words = f"that is a folder{f': {hint}' if found else f' without a {named}'}"
            return ReferenceHint(replace(hint, text=words), is_known=True)
        where = os.path.dirname(path)
        if self.disk.has_file(path):
            kind = kind_of(path, self.disk)
            what = f"is a document of {_WORDS[kind]}" if kind else "is not a document of rcyaml"
            near = [other for expected in kinds for other in self.beside(where, expected)]
            hint = entry_hint(near, folder, key, text)
            return ReferenceHint(replace(hint, text=f"that {what}" + (f"; {hint}" if near else "")), is_known=True)
        if not self.disk.has_folder(where or "."):
            return ReferenceHint(Hint(f"the folder '{where}' does not exist"))
        names = {os.path.basename(other): other for kind in kinds for other in self.beside(where, kind)}
        names.pop(os.path.basename(own) if os.path.dirname(own) == where else "", None)
        similar = suggest(os.path.basename(path), names)
        return ReferenceHint(meaning(text, os.path.relpath(names[similar], folder or ".")) if similar else NO_HINT)

    def hint_for_name(self, name: str, folder: str) -> ReferenceHint:
        """The hint for a plain name under `component:` of a parameter document; none if the name may be that of a
        component without a document."""
        path = os.path.normpath(os.path.join(folder, name))
        meant = self._completed(path, ("cdsl",))
        components = self.beside(folder, "cdsl")
        if meant or self.disk.has_folder(path) or len(components) != 1 or len(self.beside(folder, "pdsl")) > 1:
            is_near = meant or self.disk.has_folder(path)
            return self.hint_for(name, folder, "component", ("cdsl",)) if is_near else ReferenceHint()
        # The folder has one component and one parameter document.
        return ReferenceHint(entry_hint(components, folder, "component", name), is_known=True)

    def _completed(self, path: str, kinds: tuple[str, ...]) -> str:
        """The document to which a path refers if its suffix is completed; '' if there is none."""
        for kind in kinds:
            for end in (".yaml", ".yml", f".{kind}", f".{kind}.yml", ""):
                if path.endswith(end) and self.is_document(f"{path.removesuffix(end)}.{kind}.yaml", (kind,)):
                    return f"{path.removesuffix(end)}.{kind}.yaml"
        return ""


def stem(path: str) -> str:
    """`speech` for `speech.cdsl.yaml`."""
    name = os.path.basename(path)
    return name.removesuffix(f"{kind_of(path) or ''}.yaml").removesuffix(".")


def entry_hint(paths: list[str], folder: str, key: str, word: str = "", *, safe: bool = False) -> Hint:
    """A hint to write an entry that names one of these documents. A single document replaces `word` in a fix."""
    entry = f"`{key}: [{{}}]`" if key == "extends" else f"`{key}: {{}}`"
    named = [os.path.relpath(path, folder or ".") for path in paths[:3]]
    meant = named[0] if word and len(named) == 1 else ""
    return Hint("write " + " or ".join(entry.format(_plain(path)) for path in named), word, meant, safe)


def _plain(path: str) -> str:
    """A path as a YAML scalar, quoted if necessary."""
    return path if _PLAIN.fullmatch(path) else quoted(path)
