"""Each kind of legacy file has a draft of its own type."""

from __future__ import annotations

from pathlib import Path

import pytest

from robocomp_yaml.legacy import draft
from robocomp_yaml.legacy.convert import convert

FILES = {
    "Arm.idsl": ("module RoboCompArm { interface Arm { void fold(); }; };", draft.ModuleDraft),
    "Arm.ice": ("module RoboCompArm { struct Pose { float x; }; };", draft.ModuleDraft),
    "arm.cdsl": ('Component Arm { Communications { }; language Cpp; statemachine "a.smdsl"; };', draft.ComponentDraft),
    "arm.jcdsl": ('{"name": "Arm", "language": "python"}', draft.ComponentDraft),
    "arm.smdsl": ("Arm{ initial_state up; transitions{ up => up; }; };", draft.MachineDraft),
    "arm.pdsl": ("ComponentParams Arm{ speed int 5 0:10 T; };", draft.ParametersDraft),
    "arm.pconf": ('import "arm.pdsl"; ConfigFile Arm{ speed = 3; };', draft.ValuesDraft),
    "arm.conf": ("Arm.Endpoints=tcp -p 10100\nspeed=3\n", draft.ConfigDraft),
    "arm.toml": ("speed = 3\n", draft.ConfigDraft),
    "run.toml": ('[[component]]\nname = "arm"\ncmd = "bin/arm"\n', draft.DeploymentDraft),
    "run.xml": (
        '<rcmanager><node alias="arm"><upCommand command="bin/arm"/></node></rcmanager>',
        draft.DeploymentDraft,
    ),
}


@pytest.mark.parametrize("name", FILES)
def test_each_format_has_its_draft(tmp_path: Path, name: str) -> None:
    text, type_ = FILES[name]
    (tmp_path / name).write_text(text, encoding="utf-8")
    result = convert(str(tmp_path / name))
    assert type(result.draft) is type_, result.diagnostics
    with pytest.raises(AttributeError):
        result.draft = None  # type: ignore[misc]
