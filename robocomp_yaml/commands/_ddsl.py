"""Which deployment the words of a command line mean: a document, or the name of a running deployment."""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import click

from robocomp_yaml.source.discover import of_kind

if TYPE_CHECKING:
    from robocomp_yaml.deploy.registered import RegisteredDeployment


class DocumentAnd(click.Argument):
    """The argument `[DDSL]` and the words after it, as the parameters `ddsl` and this one. If the first word is neither
    a document nor a folder with one, it is the first of the words, and the document is the only one below this
    folder. With `running`, `ddsl` is '' then, for `default_document`."""

    def __init__(
        self,
        declarations: list[str],
        limit: int | None = None,
        metavar: str = "",
        *,
        running: bool = False,
        **more: Any,
    ) -> None:
        self._limit, self._running = limit, running
        super().__init__(declarations, nargs=-1, type=click.Path(), metavar=f"[DDSL] {metavar}".rstrip(), **more)

    def process_value(self, ctx: click.Context, value: object) -> tuple[str, ...]:
        words: tuple[str, ...] = super().process_value(ctx, value) or ()
        ctx.params["ddsl"], rest = self._split(ctx, words)
        if self._limit is not None and len(rest) > self._limit:
            extra = rest[self._limit :]
            raise click.UsageError(f"Got unexpected extra argument{'s' * (len(extra) > 1)} ({' '.join(extra)})", ctx)
        return rest

    def _split(self, ctx: click.Context, words: tuple[str, ...]) -> tuple[str, tuple[str, ...]]:
        if not words:
            return "" if self._running else ".", ()
        first = words[0]
        if os.path.isdir(first):
            is_document = bool(of_kind(first, "ddsl")) or not of_kind(".", "ddsl")
        else:
            is_document = os.path.exists(first)
        if is_document:
            return first, words[1:]
        is_path = "/" in first or first.endswith((".yaml", ".yml"))
        if found := _running(first, is_path=is_path) or ("" if is_path else _of_name(first)):
            return found, words[1:]
        if self._limit == 0 or is_path or not of_kind(".", "ddsl"):
            if is_path or not self._running:
                raise click.BadParameter(f"Path '{first}' does not exist.", ctx, self, "'DDSL'")
        return "" if self._running else ".", words


def running_document(text: str) -> str:
    """The document at a path, or that of the running deployment of this name. Raises Refused if there is neither."""
    from robocomp_yaml.diag.errors import Refused

    if os.path.exists(text):
        return text
    is_path = "/" in text or text.endswith((".yaml", ".yml"))
    if found := _running(text, is_path=is_path):
        return found
    raise Refused(f"there is no document '{text}', and no running deployment of this name: see `rcyaml deploy ls`")


def named_document(text: str) -> str:
    """The document at a path, or that of the running deployment of this name, or the only one here of this name, or in
    the workspace; '' if there is none."""
    if os.path.exists(text):
        return text
    is_path = "/" in text or text.endswith((".yaml", ".yml"))
    found = _running(text, is_path=is_path) or ("" if is_path else _of_name(text) or _of_name(text, _documents_here()))
    return "" if os.path.isdir(found) else found  # the folder of one whose document is another deployment's now


def known_names() -> list[str]:
    """The names of the deployments here, and in the workspace."""
    from robocomp_yaml.deploy.folder import deployment_in

    documents = [*of_kind(".", "ddsl"), *_documents_here()]
    return sorted({name for document in documents if (name := deployment_in(document))})


def only_running() -> str:
    """The document of the only deployment that runs, if there are no documents here; else ''."""
    from robocomp_yaml.deploy import registered
    from robocomp_yaml.link.workspace import root_above
    from robocomp_yaml.source.discover import documents_below

    if root_above("") or next(documents_below("."), ""):
        return ""
    found = [one.document for one in registered.every()]
    return os.path.relpath(found[0]) if len(found) == 1 else ""


def default_document() -> str:
    """This folder, if there are documents; else that of the only running deployment. Raises Refused if none runs, or
    several."""
    from robocomp_yaml.deploy import registered
    from robocomp_yaml.diag.errors import Refused

    found = [] if (is_here := bool(of_kind(".", "ddsl"))) else [one.document for one in registered.every()]
    if len(found) > 1:
        raise Refused(f"several deployments run: {', '.join(found)}; name one of them")
    if not found and not is_here:
        raise Refused(
            "this folder has no deployment document, and no deployment runs: `rcyaml new deployment NAME` writes one"
        )
    return os.path.relpath(found[0]) if found else "."


def _running(word: str, *, is_path: bool) -> str:
    """The document of the running deployment of this name, or at this path, which may be gone; '' if none runs. In a
    folder with a document, the name of one of its processes or groups goes first. If the document describes another
    deployment now, the own folder of the running one. Raises Refused if several run."""
    from robocomp_yaml.deploy import registered
    from robocomp_yaml.deploy.folder import deployment_in
    from robocomp_yaml.deploy.install import installed
    from robocomp_yaml.diag.errors import Refused

    if is_path:
        return word if registered.of_document(word) else ""
    found = registered.named(word) or installed.named(word)
    if not found or any(_may_name(document, word) for document in _documents_here()):
        return ""
    if len(found) > 1:
        documents = ", ".join(one.document for one in found)
        raise Refused(f"several deployments '{word}' run: name one of the documents {documents}")
    (one,) = found
    is_another = deployment_in(one.document) not in ("", one.name)  # its own folder still means it
    return os.path.relpath(one.folder if is_another or _shares(one) else one.document)


def _shares(one: RegisteredDeployment) -> bool:
    """Whether another running deployment had the same document."""
    from robocomp_yaml.deploy import registered

    return any(other.document == one.document and other.folder != one.folder for other in registered.every())


def _of_name(word: str, documents: Sequence[str] | None = None) -> str:
    """The only document of the deployment of this name, by default below this folder, which need not run; '' if there
    is none, or if the word can also be the name of a process."""
    from robocomp_yaml.deploy.folder import deployment_in

    documents = of_kind(".", "ddsl") if documents is None else documents
    found = [document for document in documents if deployment_in(document) == word]
    return found[0] if len(found) == 1 and not any(_may_name(one, word) for one in documents) else ""


def _documents_here() -> list[str]:
    """The deployments' documents of this folder, and of its workspace."""
    from robocomp_yaml.link.workspace import root_above
    from robocomp_yaml.source.discover import kind_of

    root = root_above("")
    return of_kind(root, "ddsl") if root else [name for name in os.listdir(".") if kind_of(name) == "ddsl"]


def _may_name(document: str, word: str) -> bool:
    """Whether an entry, service or group of a document has this name."""
    from robocomp_yaml.source.heading import root_of
    from robocomp_yaml.source.tree import Mapping

    root = root_of(document)
    sections = [root.get(key) for key in ("components", "services", "groups", "include")] if root else []
    keys = [key.lexeme for one in sections if isinstance(one, Mapping) for key, _ in one.items()]
    return any(re.fullmatch(re.escape(key).replace(r"\{i\}", "([0-9]+|{i})"), word) for key in keys)
