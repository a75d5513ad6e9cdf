"""The templates, and the cache of those that are compiled, in the user's cache folder, because compiling them takes
longer than the rest of a run."""

from __future__ import annotations

import os
import stat
from contextlib import suppress
from functools import cache

from jinja2 import BytecodeCache, Environment, FileSystemBytecodeCache, StrictUndefined
from jinja2.bccache import Bucket
from jinja2.loaders import BaseLoader, ChoiceLoader, FileSystemLoader, PrefixLoader

from robocomp_yaml import languages, resources


class _Cache(FileSystemBytecodeCache):
    """The cache of Jinja2, which compares checksums of sources. Errors of the disk are ignored."""

    def dump_bytecode(self, bucket: Bucket) -> None:
        with suppress(OSError):
            super().dump_bytecode(bucket)


class _LanguageLoaders(dict[str, BaseLoader]):
    """The loader of each language's templates, created at its first use, because plug-ins are loaded late."""

    def __missing__(self, name: str) -> BaseLoader:
        self[name] = FileSystemLoader(languages.known()[name].templates)
        return self[name]


@cache
def environment() -> Environment:
    return Environment(
        loader=ChoiceLoader([PrefixLoader(_LanguageLoaders()), FileSystemLoader(resources.folder("templates"))]),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=False,
        auto_reload=False,
        bytecode_cache=_bytecode_cache(),
    )


def _bytecode_cache() -> BytecodeCache | None:
    """The cache; None if there is no folder that only this user can write, because cached code is executed."""
    base = os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache")
    folder = os.path.join(base, "rcyaml", "templates")
    try:
        os.makedirs(os.path.dirname(folder), exist_ok=True)
        with suppress(FileExistsError):
            os.mkdir(folder, mode=0o700)
        status = os.stat(folder)
    except OSError:
        return None
    private = stat.S_IMODE(status.st_mode) & 0o077 == 0 and status.st_uid == os.getuid()
    return _Cache(folder) if private and os.access(folder, os.W_OK) else None
