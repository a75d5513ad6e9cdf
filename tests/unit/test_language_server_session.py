"""The documents of an editor, apart from the protocol."""

from __future__ import annotations

import pytest

pytest.importorskip("pygls")

from in_memory import ROOT
from robocomp_yaml.lsp import session as module
from robocomp_yaml.lsp.session import EditedText, Session


def test_a_key_does_not_look_at_each_pair_of_open_documents(monkeypatch: pytest.MonkeyPatch) -> None:
    """After a rename, an editor may have opened hundreds of documents."""
    made: list[int] = []

    class Disk(module.Disk):
        def __init__(self, overlay: dict[str, bytes]) -> None:
            made.append(len(overlay))
            super().__init__(overlay)

    monkeypatch.setattr(module, "Disk", Disk)
    session = Session([ROOT])
    paths = [f"{ROOT}/I{number}.idsl.yaml" for number in range(40)]
    for path in paths:
        session.edit(EditedText(f"file://{path}", path, "module: M\n", 1))
    assert session.roots() == {ROOT}
    made.clear()
    session.edit(EditedText(f"file://{paths[0]}", paths[0], "module: N\n", 2))
    assert session.roots() == {ROOT} and all(map(session.is_document, paths))
    assert made == [40]


def test_what_is_open_decides_which_workspace_a_document_belongs_to() -> None:
    session = Session([ROOT])
    document, settings = f"{ROOT}/deep/A.idsl.yaml", f"{ROOT}/deep/rcyaml.yaml"
    session.edit(EditedText(f"file://{document}", document, "module: M\n", 1))
    assert session.root_of(document) == ROOT
    session.edit(EditedText(f"file://{settings}", settings, "interfaces: [.]\n", 1))
    assert session.root_of(document) == f"{ROOT}/deep"
    session.close(settings)
    assert session.root_of(document) == ROOT


def test_other_files_are_no_documents_but_state_machines_are_checked() -> None:
    session = Session([ROOT])
    for name, is_document, is_checked in (
        ("a.idsl.yaml", True, True), ("rcyaml.yaml", True, True), ("a.mock.yaml", True, True),
        ("a.scxml", False, True), ("compose.yaml", False, False), ("config.yaml", False, False), ("a.ice", False, False),
    ):  # fmt: skip
        path = f"{ROOT}/{name}"
        session.edit(EditedText(f"file://{path}", path, "", 1))
        assert (session.is_document(path), session.is_checked(path)) == (is_document, is_checked), name
