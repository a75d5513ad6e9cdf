"""A component whose code a language's checker checks."""

from __future__ import annotations

import msgspec

from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.transactions.output_root import Root
from robocomp_yaml.transactions.plan import FilePlan


class CheckedCode(msgspec.Struct, frozen=True):
    """`root` is the folder of the component, `files` what a compile would write there; `workspace` is the folder of the
    workspace."""

    linked: LinkedComponent
    root: Root
    files: tuple[FilePlan, ...]
    workspace: str
