"""The interface CommonBehavior, which every component serves, as a linked module. It is in no document of a workspace:
`templates/slice/CommonBehavior.ice` is what components are compiled with."""

from __future__ import annotations

from functools import cache

from robocomp_yaml.link.program import LinkedModule
from robocomp_yaml.model.build_interface import build
from robocomp_yaml.source.tree import Mapping, parse

MODULE = "RoboCompCommonBehavior"
CONTROLS = frozenset(("setPeriod", "killYourSelf", "setParameterList", "reloadConfig"))
"""The operations that change something, which components accept only from who may control them."""

_PATH = "CommonBehavior.idsl.yaml"
_TEXT = f"""\
module: {MODULE}
types:
  State: {{enum: [Starting, Running]}}
  Parameter: {{struct: {{editable: bool, value: string, type: string}}}}
  ParameterList: {{map: {{key: string, value: Parameter}}}}
interfaces:
  CommonBehavior:
    methods:
      getPeriod: {{idempotent: true, returns: int}}
      setPeriod: {{in: {{period: int}}}}
      timeAwake: {{idempotent: true, returns: int}}
      killYourSelf:
      getParameterList: {{returns: ParameterList}}
      setParameterList: {{in: {{l: ParameterList}}}}
      reloadConfig:
      getState: {{returns: State}}
"""


@cache
def common_behavior() -> LinkedModule:
    root, faults = parse(_PATH, _TEXT)
    assert isinstance(root, Mapping), faults
    return LinkedModule(build(root, _PATH))
