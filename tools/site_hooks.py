"""Hooks of MkDocs for what the pages of docs/ have for code hosts and for the tests.

Pages are plain Markdown with relative links. A link out of docs/ leads to the repository, and a comment that names the
file of a block becomes the block's title.
"""

from __future__ import annotations

import posixpath
import re
from pathlib import Path
from typing import Any

_FILE = re.compile(r"^<!-- (?:file|client|fragment): (\S+) -->\n(```\w+)$", re.MULTILINE)
# The pages of diagnostics name a file after the language: ```yaml Speech.idsl.yaml
_NAMED = re.compile(r'^```(\w+) ("[^"\n]+"|[^\s"{=]+)(?: [^\n]*)?$', re.MULTILINE)
_LINK = re.compile(r"\]\((?![a-z]+:|#)([^)#\s]+)(#[^)\s]*)?\)")


def on_post_page(output: str, page: Any, config: Any) -> str:
    """With this mark, the theme asks the code host for the number of stars: a request to another server."""
    return output.replace(' data-md-component="source"', "")


def on_page_markdown(markdown: str, page: Any, config: Any, files: Any) -> str:
    home = posixpath.dirname(page.file.src_uri)

    def lead(found: re.Match[str]) -> str:
        path = posixpath.normpath(posixpath.join("docs", home, found[1]))
        if path.startswith("docs/") or path == "docs":
            return found[0]
        target = Path(config.config_file_path).parent / path
        if not target.exists():
            return found[0]  # MkDocs reports it
        kind = "tree" if target.is_dir() else "blob"
        return f"]({config.repo_url}/{kind}/main/{path}{found[2] or ''})"

    titled = _NAMED.sub(lambda found: f'```{found[1]} title="{found[2].strip(chr(34))}"', markdown)
    return _LINK.sub(lead, _FILE.sub(r'\2 title="\1"', titled))
