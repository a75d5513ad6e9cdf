"""The configuration for Neovim, in a real Neovim without a user interface."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from conftest import ROOT
from editor.robot import write_robot
from terminals import environment

HERE = Path(__file__).resolve().parent
CONFIGURATION = ROOT / "editors/neovim/rcyaml.lua"
SESSION = HERE / "neovim_session.lua"


@pytest.fixture
def neovim(tmp_path: Path) -> Any:
    """Runs Lua in Neovim with one document open, and returns what it returns."""
    if shutil.which("nvim") is None:
        pytest.skip("Neovim is not installed (Debian: apt install neovim)")
    pytest.importorskip("pygls")
    robot = tmp_path / "robot"
    robot.mkdir()
    write_robot(robot)

    def run(document: str, lua: str, *, size: tuple[int, int] = (100, 20), **more: str) -> Any:
        result = tmp_path / "result.json"
        script = tmp_path / "session.lua"
        command = more.get("command", json.dumps([sys.executable, "-m", "robocomp_yaml", "lsp"]))
        script.write_text(
            f"vim.g.rcyaml_command = vim.fn.json_decode([==[{command}]==])\n"
            f"local nvim = dofile([[{SESSION}]])\n"
            "local ok, result = pcall(function()\n"
            f"dofile([[{CONFIGURATION}]])\nvim.cmd([[edit {document}]])\nvim.bo.filetype = 'yaml'\n"
            f"{lua}\nend)\n"
            f"vim.fn.writefile({{ vim.fn.json_encode({{ ok = ok, result = result }}) }}, [[{result}]])\n"
            "vim.lsp.stop_client(vim.lsp.get_active_clients())\nvim.cmd('qall!')\n"
        )
        sizes = ["--cmd", f"set columns={size[0]} lines={size[1]} noswapfile"]
        done = subprocess.run(
            ["nvim", "--clean", "--headless", *sizes, "-c", f"luafile {script}", "-c", "qall!"], cwd=robot, env=environment(),
            stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=90, check=False,
        )  # fmt: skip
        assert result.is_file(), done.stderr
        answer = json.loads(result.read_text())
        assert answer["ok"], answer["result"]
        return answer["result"]

    return run


def test_a_mistake_is_marked_and_mended(neovim: Any) -> None:
    before, after = neovim(
        "components/wheels/wheels.cdsl.yaml",
        """
        vim.api.nvim_buf_set_lines(0, 3, 4, false, { 'requires: [Girpper]' })
        nvim.wait('diagnostics', function() return #vim.diagnostic.get(0) > 0 end)
        local before = vim.tbl_map(function(one) return one.code .. ' ' .. one.lnum .. ':' .. one.col end, vim.diagnostic.get(0))
        vim.api.nvim_win_set_cursor(0, { 4, 12 })
        local client = vim.lsp.get_active_clients()[1]
        local params = vim.lsp.util.make_range_params()
        params.context = { diagnostics = vim.lsp.diagnostic.get_line_diagnostics(0, 3) }
        local _, answer = next(vim.lsp.buf_request_sync(0, 'textDocument/codeAction', params, 30000))
        vim.lsp.util.apply_workspace_edit(answer.result[1].edit, client.offset_encoding)
        nvim.wait('their end', function() return #vim.diagnostic.get(0) == 0 end)
        return { before, vim.api.nvim_buf_get_lines(0, 3, 4, false) }
        """,
    )
    assert before == ["RC2003 3:11"]
    assert after == ["requires: [Gripper]"]


def test_names_are_completed_explained_and_followed(neovim: Any) -> None:
    labels, hover, definition, references = neovim(
        "components/wheels/wheels.cdsl.yaml",
        """
        nvim.wait('the server', function()
          local client = vim.lsp.get_active_clients()[1]
          return client and client.server_capabilities.hoverProvider
        end)
        local hover = nvim.ask('textDocument/hover', 4, 12)
        local definition = nvim.ask('textDocument/definition', 4, 12)
        local references = nvim.ask('textDocument/references', 4, 12, { context = { includeDeclaration = true } })
        local made = nvim.ask('textDocument/completion', 4, 11)
        local labels = vim.tbl_map(function(one) return one.label end, made.items or made)
        if not vim.tbl_islist(definition) then definition = { definition } end
        return { labels, hover.contents.value or hover.contents, definition[1].uri, #references }
        """,
    )
    assert {"Gripper", "Odometry"} <= set(labels)
    assert "Opens and closes." in hover
    assert definition.endswith("/interfaces/Gripper.idsl.yaml")
    assert references >= 3


def test_a_document_is_formatted(neovim: Any) -> None:
    lines = neovim(
        "components/wheels/wheels.cdsl.yaml",
        """
        vim.api.nvim_buf_set_lines(0, 3, 4, false, { "requires:   [ 'Gripper' ]" })
        nvim.wait('the server', function()
          local client = vim.lsp.get_active_clients()[1]
          return client and client.server_capabilities.documentFormattingProvider
        end)
        local client = vim.lsp.get_active_clients()[1]
        local edits = nvim.ask('textDocument/formatting', 1, 0, { options = { tabSize = 2, insertSpaces = true } })
        vim.lsp.util.apply_text_edits(edits, 0, client.offset_encoding)
        return vim.api.nvim_buf_get_lines(0, 3, 4, false)
        """,
    )
    assert lines == ["requires: [Gripper]"]


def test_one_server_serves_a_workspace(neovim: Any) -> None:
    roots = neovim(
        "components/wheels/wheels.cdsl.yaml",
        """
        vim.cmd('edit interfaces/Gripper.idsl.yaml')
        vim.bo.filetype = 'yaml'
        nvim.wait('the server', function() return #vim.lsp.get_active_clients() > 0 end)
        return vim.tbl_map(function(one) return vim.fn.fnamemodify(one.config.root_dir, ':t') end, vim.lsp.get_active_clients())
        """,
    )
    assert roots == ["robot"]


def test_an_absent_program_is_told_once(neovim: Any) -> None:
    told = neovim(
        "components/wheels/wheels.cdsl.yaml",
        """
        return vim.split(vim.fn.execute('messages'), '\\n', { trimempty = true })
        """,
        command='["/nowhere/rcyaml", "lsp"]',
    )
    assert [line for line in told if "rcyaml" in line and "not found" in line] == [
        "/nowhere/rcyaml is not found: pip install 'rcyaml[lsp]'"
    ]


def test_the_screen_of_the_docs_is_that_of_neovim(neovim: Any, request: pytest.FixtureRequest) -> None:
    lines = neovim(
        "components/wheels/wheels.cdsl.yaml",
        """
        vim.api.nvim_buf_set_lines(0, 3, 4, false, { 'requires: [Girpper]' })
        vim.opt.number = true
        vim.opt.laststatus = 0
        vim.opt.ruler = false
        nvim.wait('diagnostics', function() return #vim.diagnostic.get(0) > 0 end)
        return nvim.screen()
        """,
        size=(110, 8),
    )
    screen = "\n".join(re.sub(r"\(/.*/", "(…/", line).rstrip() for line in lines).rstrip()
    page = ROOT / "docs/editor.md"
    text = page.read_text(encoding="utf-8")
    begin, end = "<!-- Neovim's screen -->\n```text\n", "\n```\n"
    before, _, rest = text.partition(begin)
    shown, _, after = rest.partition(end)
    if request.config.getoption("--update-golden"):
        page.write_text(before + begin + screen + end + after, encoding="utf-8")
        shown = screen
    assert shown == screen
