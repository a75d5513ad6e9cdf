"""What completion proposes can stand where it is proposed."""

from __future__ import annotations

from collections.abc import Iterable

from editor.snippets import inserted
from editor.workbench import Proposal
from robocomp_yaml.source import schema, tree


def assert_can_stand_there(kind: str, text: str, proposals: Iterable[Proposal]) -> None:
    """A snippet, accepted as it is, gives YAML that the schema takes (but for keys that are still to come)."""
    for proposal in proposals:
        if "$" in proposal.text:
            result = inserted(text, proposal.text)
            root, said = tree.parse("new.yaml", result)
            assert root is not None, (proposal, result, said)
            assert [d.message for d in schema.validate(kind, root) if d.code != "RC0203"] == [], (proposal, result)
