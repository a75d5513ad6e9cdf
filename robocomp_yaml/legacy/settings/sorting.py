"""Which settings are endpoints, proxies, topics, Ice's own, and which are parameters."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.legacy.rules import Rules
from robocomp_yaml.legacy.settings.entries import CLASSIC, Leaf, Setting, Settings

_WORD = re.compile(r"[A-Za-z_]\w*\Z")
_SERVICES = ("IceStorm", "IceBox", "IceGrid", "IceSSL", "IceDiscovery", "IceLocatorDiscovery", "Glacier2", "Endpoints",
             "Proxies", "TopicManager")


@dataclass(frozen=True, slots=True)
class Ports:
    """The interfaces that a component names, as far as its document is known."""

    requires: frozenset[str] = frozenset()
    topics: frozenset[str] = frozenset()


@dataclass(frozen=True, slots=True)
class Named:
    """A setting under its name in a section. `key`: the property, where the name does not say it."""

    name: str
    setting: Setting
    key: str = ""


@dataclass(slots=True)
class Sorted:
    """The settings of one file by section."""

    dialect: str
    parameters: list[Setting] = field(default_factory=list)
    endpoints: list[Named] = field(default_factory=list)
    proxies: list[Named] = field(default_factory=list)
    manager: list[Named] = field(default_factory=list)
    prefixes: list[Named] = field(default_factory=list)
    names: list[Named] = field(default_factory=list)
    ice: list[Named] = field(default_factory=list)
    properties: list[Named] = field(default_factory=list)
    diagnostics: list[Diagnostic] = field(default_factory=list)

    def keep(self, setting: Setting) -> None:
        """A property that no section has a place for."""
        self.properties.append(Named(setting.key, setting))


def sort(settings: Settings, ports: Ports, rules: Rules) -> Sorted:
    found = Sorted(settings.dialect)
    for setting in settings.settings:
        if not isinstance(setting.value, Leaf):
            found.parameters.append(setting)
        elif settings.dialect == CLASSIC:
            _classic(found, setting, ports, rules)
        else:
            _toml(found, setting, rules)
    return found


def _classic(found: Sorted, setting: Setting, ports: Ports, rules: Rules) -> None:
    key, text = setting.key, setting.text
    if key.startswith("Ice."):
        found.ice.append(Named(key[4:], setting))
    elif key.endswith(".Endpoints") and len(key) > 10:
        found.endpoints.append(Named(key[:-10], setting))
    elif key == "TopicManager.Proxy":
        found.manager.append(Named("manager", setting))
    elif rules.sections["proxy"].match(text) or (key.removesuffix("Proxy") in ports.requires and key[-5:] == "Proxy"):
        name = key.removesuffix("Proxy")
        found.proxies.append(Named(name, setting) if name != key and name else Named(key, setting, key))
    elif key.startswith("Proxies.") and key.endswith("Prefix") and len(key) > 14:
        found.prefixes.append(Named(key[8:-6], setting))
    elif (key == text or key in ports.topics) and _WORD.match(key) and _WORD.match(text):
        found.names.append(Named(key, setting))
    else:
        _rest(found, setting, rules)


def _toml(found: Sorted, setting: Setting, rules: Rules) -> None:
    key, path, text = setting.key, setting.path, setting.text
    if path[0] == "Ice" and len(path) > 1:
        found.ice.append(Named(key[4:], setting))
    elif path[0] == "Endpoints" and len(path) == 2 and text:
        found.endpoints.append(Named(path[1], setting))
    elif key == "Proxies.TopicManager" and text:
        found.manager.append(Named("manager", setting))
    elif path[0] == "Proxies" and len(path) == 2 and not rules.sections["proxy"].match(text) and key[-6:] == "Prefix":
        found.prefixes.append(Named(path[1][:-6], setting))
    elif path[0] == "Proxies" and len(path) == 2 and text:
        found.proxies.append(Named(path[1], setting))
    elif rules.sections["proxy"].match(text):
        found.proxies.append(Named(key, setting, key))
    else:
        _rest(found, setting, rules)


def _rest(found: Sorted, setting: Setting, rules: Rules) -> None:
    """A parameter, unless its name could not be one's."""
    if rules.sections["suspicious"].search(setting.key):
        what = rules.repairs["suspicious"].format(text=setting.key)
        found.diagnostics.append(codes.REPAIRED.at(setting.span, what=what))
        found.keep(setting)
    elif (setting.path[0] in _SERVICES and len(setting.path) > 1) or "${env:" in setting.text:
        found.keep(setting)
    else:
        found.parameters.append(setting)
