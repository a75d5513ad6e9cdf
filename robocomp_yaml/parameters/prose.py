"""Docs as Markdown that shows what they say."""

from __future__ import annotations

import re

_CODE_OR_TAG = re.compile(r"((`+)(?!`).*?(?<!`)\2(?!`))|(?<!\\)<(?!https?://)", re.DOTALL)


def prose(doc: str) -> str:
    """A doc, which may be Markdown, but no HTML: `<name>` is to be seen."""
    return _CODE_OR_TAG.sub(lambda found: found[0] if found[1] else "\\<", doc)
