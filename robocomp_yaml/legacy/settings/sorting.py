"""Which settings are endpoints, proxies, topics, Ice's own, and which are parameters."""

from __future__ import annotations

import re

import msgspec

from robocomp_yaml.diag.codes import migration as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.legacy.rules import Rules
from robocomp_yaml.legacy.settings.entries import CLASSIC, TOML, ConfigSettings, Leaf, Setting
from robocomp_yaml.legacy.settings.headers import free
from robocomp_yaml.parameters.spelling import references

MAX_DEPTH = 20
"""So many parts may a parameter's key have; nobody writes half as many."""

_OWN = "x-"
_WORD = re.compile(r"[A-Za-z_]\w*\Z")


class PortNames(msgspec.Struct, frozen=True):
    """The interfaces that a component names, as far as its document is known."""

    implements: frozenset[str] = frozenset()
    requires: frozenset[str] = frozenset()
    topics: frozenset[str] = frozenset()

    def takes(self, key: str) -> bool:
        """Whether a property of this name is the connection's, and no parameter's."""
        return (
            key in self.implements | self.topics
            or key.removesuffix("Topic") in self.topics
            or (key.endswith("Proxy") and key[:-5] in self.requires)
            or key == "CommonBehavior"
        )


class NamedSetting(msgspec.Struct, frozen=True):
    """A setting under its name in a section. `key`: the property, where the name does not say it."""

    name: str
    setting: Setting
    key: str = ""


class SortedSettings(msgspec.Struct, frozen=True):
    """The settings of one file by section."""

    dialect: str
    parameters: list[Setting] = []
    endpoints: list[NamedSetting] = []
    proxies: list[NamedSetting] = []
    manager: list[NamedSetting] = []
    prefixes: list[NamedSetting] = []
    names: list[NamedSetting] = []
    ice: list[NamedSetting] = []
    properties: list[NamedSetting] = []
    diagnostics: list[Diagnostic] = []

    def put(self, section: list[NamedSetting], name: str, setting: Setting) -> None:
        """Under its name in a section, where one that starts with `x-` would be the user's own."""
        if name.startswith(_OWN):
            self.keep(setting)
        else:
            section.append(NamedSetting(name, setting))

    def connect(self, name: str, setting: Setting) -> None:
        """A proxy. Without a name of its own it is called as its property."""
        taken = {named.name for named in self.proxies}
        if name and name not in taken and not name.startswith(_OWN):
            self.proxies.append(NamedSetting(name, setting))
        else:
            self.proxies.append(NamedSetting(free(setting.key.replace(_OWN, "x_", 1), taken), setting, setting.key))

    def keep(self, setting: Setting) -> None:
        """A property that no section has a place for. A list or a table, which TOML may give, can be none."""
        if isinstance(setting.value, Leaf):
            self.properties.append(NamedSetting(setting.key, setting))
        else:
            what = f"only texts and numbers can stand here, so '{setting.key}' is left out"
            self.diagnostics.append(codes.LOST.at(setting.span, what=what))


def sort(settings: ConfigSettings, ports: PortNames, rules: Rules) -> SortedSettings:
    found = SortedSettings(settings.dialect)
    for setting in settings.settings:
        if not isinstance(setting.value, Leaf):
            if rules.sections["service"].match(f"{setting.key}.") or len(setting.path) > MAX_DEPTH:
                found.keep(setting)
            else:
                found.parameters.append(setting)
        elif settings.dialect == CLASSIC:
            _classic(found, setting, ports, rules)
        else:
            _toml(found, setting, ports, rules)
    return found


def _classic(found: SortedSettings, setting: Setting, ports: PortNames, rules: Rules) -> None:
    key, text = setting.key, setting.text
    if key.startswith("Ice.") and len(key) > 4:
        found.ice.append(NamedSetting(key[4:], setting))
    elif key.endswith(".Endpoints") and len(key) > 10:
        found.put(found.endpoints, key[:-10], setting)
    elif key == "TopicManager.Proxy":
        found.manager.append(NamedSetting("manager", setting))
    elif rules.sections["proxy"].match(text) or (key.removesuffix("Proxy") in ports.requires and key[-5:] == "Proxy"):
        name = key.removesuffix("Proxy")
        found.connect(name if name != key else "", setting)
    elif key.startswith("Proxies.") and key.endswith("Prefix") and len(key) > 14:
        found.put(found.prefixes, key[8:-6], setting)
    elif (key == text or key.removesuffix("Topic") in ports.topics) and _WORD.match(key) and _WORD.match(text):
        found.names.append(NamedSetting(key, setting))
    else:
        _rest(found, setting, ports, rules)


def _toml(found: SortedSettings, setting: Setting, ports: PortNames, rules: Rules) -> None:
    key, path, text = setting.key, setting.path, setting.text
    if path[0] == "Ice" and len(path) > 1:
        found.ice.append(NamedSetting(key[4:], setting))
    elif path[0] == "Endpoints" and len(path) == 2 and text:
        found.put(found.endpoints, path[1], setting)
    elif key == "Proxies.TopicManager" and text:
        found.manager.append(NamedSetting("manager", setting))
    elif path[0] == "Proxies" and len(path) == 2 and not rules.sections["proxy"].match(text) and key[-6:] == "Prefix":
        found.put(found.prefixes, path[1][:-6], setting)
    elif path[0] == "Proxies" and len(path) == 2 and text:
        found.connect(path[1], setting)
    elif rules.sections["proxy"].match(text):
        found.connect("", setting)
    else:
        _rest(found, setting, ports, rules)


def _rest(found: SortedSettings, setting: Setting, ports: PortNames, rules: Rules) -> None:
    """A parameter, unless its name could not be one's."""
    if found.dialect != TOML and rules.sections["suspicious"].search(setting.key):
        what = rules.repairs["suspicious"].format(text=setting.key)
        found.diagnostics.append(codes.REPAIRED.at(setting.span, what=what))
        found.keep(setting)
    elif rules.sections["service"].match(setting.key) or ports.takes(setting.key) or references.in_text(setting.text):
        found.keep(setting)
    elif len(setting.path) > MAX_DEPTH:
        found.keep(setting)
    else:
        found.parameters.append(setting)
