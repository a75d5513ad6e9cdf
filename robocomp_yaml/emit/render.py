"""Templates rendered from views.

A view is a struct of ready strings (and lists of views); its fields are the template's names. Compiled templates are
kept in the user's cache folder, since compiling them costs more than all the rest of a run.
"""

from __future__ import annotations

import os
import stat
from contextlib import suppress
from functools import cache

import msgspec
from jinja2 import BytecodeCache, Environment, FileSystemBytecodeCache, StrictUndefined
from jinja2.bccache import Bucket
from jinja2.loaders import BaseLoader, ChoiceLoader, FileSystemLoader, PrefixLoader
from msgspec.structs import asdict

from robocomp_yaml import languages, resources


def render(name: str, view: msgspec.Struct) -> str:
    """The template `templates/NAME`, or `LANGUAGE/NAME` of a language, filled in with the fields of `view`."""
    return _environment().get_template(name).render(asdict(view))


class _Cache(FileSystemBytecodeCache):
    """Jinja2's, which checks the source's checksum, but a full disk does not end the run."""

    def dump_bytecode(self, bucket: Bucket) -> None:
        with suppress(OSError):
            super().dump_bytecode(bucket)


class _OfLanguages(dict[str, BaseLoader]):
    """The templates of each language; those of plug-ins become known as they come."""

    def __missing__(self, name: str) -> BaseLoader:
        self[name] = FileSystemLoader(languages.known()[name].templates)
        return self[name]


@cache
def _environment() -> Environment:
    return Environment(
        loader=ChoiceLoader([PrefixLoader(_OfLanguages()), FileSystemLoader(resources.folder("templates"))]),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=False,
        auto_reload=False,
        bytecode_cache=_bytecode_cache(),
    )


def _bytecode_cache() -> BytecodeCache | None:
    """None where there is no folder that only this user can write: what is cached is code, and it will be run."""
    base = os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache")
    folder = os.path.join(base, "rcyaml", "templates")
    try:
        os.makedirs(os.path.dirname(folder), exist_ok=True)
        with suppress(FileExistsError):
            os.mkdir(folder, mode=0o700)
        found = os.stat(folder)
    except OSError:
        return None
    private = stat.S_IMODE(found.st_mode) & 0o077 == 0 and found.st_uid == os.getuid()
    return _Cache(folder) if private and os.access(folder, os.W_OK) else None
