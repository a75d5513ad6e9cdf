"""A text that completion offers."""

from __future__ import annotations

import msgspec

VALUE, CODE, PATH = "value", "code", "path"


class Proposal(msgspec.Struct, frozen=True):
    """A text that can stand at the cursor. `imports` is what the document must import for it; `snippet` is what is
    inserted, in the syntax of snippets, if it differs from the text."""

    text: str
    kind: str = ""
    says: str = ""
    doc: str = ""
    imports: str = ""
    snippet: str = ""
