"""The configuration for Emacs with eglot, in a real Emacs in batch mode."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from typing import Any

import pytest

from conftest import ROOT
from editor.robot import write_robot
from terminals import environment

CONFIGURATION = ROOT / "editors/emacs/rcyaml.el"
HAS_EGLOT = "(progn (require 'package) (package-initialize) (require 'eglot) (require 'yaml-mode))"


WHEELS = "components/wheels/wheels.cdsl.yaml"
NAMED = """
(goto-char (point-min)) (search-forward "requires: [Gr")
(let* ((server (eglot-current-server))
       (at (eglot--TextDocumentPositionParams))
       (hover (jsonrpc-request server :textDocument/hover at))
       (target (car (xref-backend-definitions 'eglot (xref-backend-identifier-at-point 'eglot))))
       (found (jsonrpc-request server :textDocument/completion at))
       (items (if (vectorp found) found (plist-get found :items))))
  (vector (plist-get (plist-get hover :contents) :value)
          (xref-location-group (xref-item-location target))
          (mapcar (lambda (one) (plist-get one :label)) items)))
"""
FORMATTED = """
(goto-char (point-min)) (search-forward "requires: [Gripper]") (replace-match "requires:   [ Gripper ]")
(eglot--signal-textDocument/didChange)
(eglot-format-buffer)
(buffer-string)
"""
MISTAKEN = """
(goto-char (point-min)) (search-forward "requires: [Gripper") (replace-match "requires: [Girpper")
(eglot--signal-textDocument/didChange)
(wait "a diagnostic" (lambda () (flymake-start) (faults)))
(faults)
"""
PROJECT = "(file-name-nondirectory (directory-file-name (project-root (project-current))))"


@pytest.fixture(scope="module")
def said(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """What Emacs says in one session, in which a document that the server knows is edited: it takes seconds to start
    both."""
    if shutil.which("emacs") is None:
        pytest.skip("Emacs is not installed (Debian: apt install emacs-nox elpa-eglot elpa-yaml-mode)")
    done = subprocess.run(["emacs", "--batch", "-q", "--eval", HAS_EGLOT], capture_output=True, text=True, check=False)
    if done.returncode:
        pytest.skip("Emacs has no eglot or no yaml-mode (Debian: apt install elpa-eglot elpa-yaml-mode)")
    pytest.importorskip("pygls")
    folder = tmp_path_factory.mktemp("emacs")
    robot, result, script = folder / "robot", folder / "result.json", folder / "session.el"
    robot.mkdir()
    write_robot(robot)
    command = " ".join(json.dumps(part) for part in (sys.executable, "-m", "robocomp_yaml", "lsp"))
    script.write_text(
        f"""{HAS_EGLOT}
        (load "{CONFIGURATION}")
        (setq rcyaml-command (list {command}) eglot-sync-connect 30 make-backup-files nil)
        (defun wait (what is-done)
          (with-timeout (30 (error "Emacs waits in vain for %s" what))
            (while (not (funcall is-done)) (accept-process-output nil 0.05))))
        (defun faults ()
          (mapcar #'flymake-diagnostic-text (flymake-diagnostics)))
        (find-file "{WHEELS}")
        (apply #'eglot--connect (eglot--guess-contact))
        (eglot--maybe-activate-editing-mode)
        (wait "eglot" (lambda () eglot--managed-mode))
        (let ((made (list (cons "project" {PROJECT}) (cons "named" (progn {NAMED}))
                          (cons "formatted" (progn {FORMATTED})) (cons "mistaken" (progn {MISTAKEN})))))
          (with-temp-file "{result}" (insert (json-encode made))))
        (set-buffer-modified-p nil)
        (eglot-shutdown-all)
        """
    )
    done = subprocess.run(
        ["emacs", "--batch", "-q", "-l", str(script)], cwd=robot, env=environment(), stdin=subprocess.DEVNULL,
        capture_output=True, text=True, timeout=150, check=False,
    )  # fmt: skip
    assert result.is_file(), done.stderr
    found: dict[str, Any] = json.loads(result.read_text())
    return found


def test_a_mistake_is_marked(said: dict[str, Any]) -> None:
    [fault] = said["mistaken"]
    assert "unknown interface 'Girpper'" in fault


def test_names_are_explained_followed_and_completed(said: dict[str, Any]) -> None:
    hover, target, labels = said["named"]
    assert "Opens and closes." in hover
    assert target.endswith("Gripper.idsl.yaml")
    assert {"Gripper", "Odometry"} <= set(labels)


def test_a_document_is_formatted(said: dict[str, Any]) -> None:
    assert "requires: [Gripper]\n" in said["formatted"]


def test_a_workspace_is_a_project(said: dict[str, Any]) -> None:
    assert said["project"] == "robot"
