"""Whose a file below an output root is: one rule for all of them.

A file that still is as rcyaml last put it there, written or merged, is rcyaml's: where it is one of those that are
rewritten (policy ALWAYS), it is renewed without a word. As soon as it holds anything of the user it is the user's, also
after a merge put something into it. What is written once (policy ONCE) is left to the user in any case; that it is
unchanged counts only once a document asks for it to be rewritten, as `etc/config.yaml` does for `etc/config`.
"""

from __future__ import annotations

from robocomp_yaml.source import properties
from robocomp_yaml.source.digest import digest
from robocomp_yaml.transactions.manifest import Entry
from robocomp_yaml.transactions.plan import Merge


def is_as_put(entry: Entry | None, data: bytes) -> bool:
    """Whether a file with this content is as rcyaml last put it there."""
    return entry is not None and entry.hash == digest(data)


def merged(entry: Entry | None, merge: Merge) -> str:
    """What the manifest keeps of a merge: the digest of all of it where nothing of the user was in the file before;
    else that of the skeleton, which the file then differs from."""
    return digest(merge.text if is_as_put(entry, merge.before) else merge.base)


def lost(base: bytes | None, yours: bytes, new: bytes) -> list[str] | None:
    """The keys of those entries of the user in a property file that another text lacks, or has with another value: of
    those that differ from what rcyaml wrote (`base`). None where that cannot be told. To Ice an entry without a value
    is none."""
    try:
        before, mine, then = (properties.read((data or b"").decode()).values for data in (base, yours, new))
    except UnicodeDecodeError:
        return None
    return [key for key, value in mine.items() if value not in (before.get(key, ""), then.get(key, ""))]
