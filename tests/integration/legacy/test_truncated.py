"""Truncated files of every format: converted or rejected, each line in the ledger, never a traceback."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

TEXTS = {
    "Speech.idsl": "module RoboCompSpeech\n{\n  /* words */\n  interface Speech\n  {\n    bool say(string text);\n  };\n};\n",
    "Speech.ice": "#ifndef A\n#define A\nmodule M { struct S { int a; }; interface I { void f(S s); }; };\n#endif\n",
    "speech.cdsl": 'import "Speech.idsl";\nComponent SpeechComp\n{\n  Communications\n  {\n    implements Speech;\n  };\n'
                   "  language Python;\n};\n",
    "machine.smdsl": "machine{\n  states compute, wait;\n  initial_state initialize;\n  end_state finalize;\n"
                     "  transitions{\n    initialize => compute;\n    compute => wait, finalize;\n  };\n};\n",
    "etc/config": "# motors\nMotor.Num = 2\nMotor.M0 = a,1,true\nMotor.M1 = b,2,false\nSpeech.Endpoints=tcp -p 1\n",
    "etc/config.toml": "Period.Compute = 10\n[Motor]\nnames = [\"a\", \"b\"]\n[[rows]]\nx = 1\n",
    "manager.xml": '<?xml version="1.0"?>\n<rcmanager>\n  <node alias="a" endpoint="a:tcp -p 1">\n'
                   '    <upCommand command="rcremote h t /d bin/a etc/config" />\n  </node>\n</rcmanager>\n',
    "sub.toml": '[[components]]\nname = "joy"\ncwd = "~/joy"\ncmd = "bin/joy etc/config"\nice_name = "Joy:tcp -p 1"\n',
}  # fmt: skip


@pytest.mark.parametrize("name", TEXTS)
def test_a_truncated_file(name: str, rcyaml: Callable[..., Result], tmp_path: Path) -> None:
    text = TEXTS[name]
    for end in range(1, len(text), 11):
        path = tmp_path / str(end) / name
        path.parent.mkdir(parents=True)
        path.write_text(text[:end], encoding="utf-8")
    result = rcyaml("migrate", ".", "-o", "out", "--report", "ledger.json")
    assert result.exit_code in (0, 1), result.output
    files = json.loads((tmp_path / "ledger.json").read_text(encoding="utf-8"))["files"]
    assert len(files) > 5
    for file in files:
        lines = dict(file["lines"])
        assert lines.pop("total") == sum(lines.values()) == len((tmp_path / file["source"]).read_text().splitlines())
        assert not lines["lost"] or file["diagnostics"], "what is lost is told"
        assert file["outputs"] or file["diagnostics"] or file["status"] == "skipped", file


def test_an_empty_list_is_lost_and_reported(rcyaml: Callable[..., Result], tmp_path: Path) -> None:
    """A table that is always empty implies no type, and cannot be a property."""
    (tmp_path / "etc").mkdir()
    (tmp_path / "etc/config.toml").write_text("a = 1\n[[rows]]\n", encoding="utf-8")
    result = rcyaml("migrate", ".", "--strict")
    assert result.exit_code == 1
    assert "only texts and numbers can be properties, so that 'rows' is omitted" in result.output
    assert "1 line is lost" in result.output
