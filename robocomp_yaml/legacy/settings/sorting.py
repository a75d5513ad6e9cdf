"""Sort settings: endpoints, proxies, topics, properties of Ice, and parameters."""

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
"""At most this many parts may a parameter's key have. Real files have less than half as many."""

_USER_PREFIX = "x-"
_WORD = re.compile(r"[A-Za-z_]\w*\Z")


class PortNames(msgspec.Struct, frozen=True):
    """The names of a component's ports, as far as its document is known."""

    implements: frozenset[str] = frozenset()
    requires: frozenset[str] = frozenset()
    topics: frozenset[str] = frozenset()

    def is_connection(self, key: str) -> bool:
        """Whether a property of this name configures a connection instead of a parameter."""
        return (
            key in self.implements | self.topics
            or key.removesuffix("Topic") in self.topics
            or (key.endswith("Proxy") and key[:-5] in self.requires)
            or key == "CommonBehavior"
        )


class NamedSetting(msgspec.Struct, frozen=True):
    """A setting under its name in a section. `key` is the property, where it differs from the one of the name."""

    name: str
    setting: Setting
    key: str = ""


class SortedSettings(msgspec.Struct, frozen=True):
    """The settings of one file, by section."""

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

    @property
    def sections(self) -> tuple[list[NamedSetting], ...]:
        """Those with a meaning of their own: all but parameters and properties."""
        return self.endpoints, self.proxies, self.manager, self.prefixes, self.names, self.ice

    def put(self, section: list[NamedSetting], name: str, setting: Setting) -> None:
        """Add a setting to a section. Names that start with `x-` are reserved for the user: such a setting becomes a
        property."""
        if name.startswith(_USER_PREFIX):
            self.keep(setting)
        else:
            section.append(NamedSetting(name, setting))

    def connect(self, name: str, setting: Setting) -> None:
        """Add a proxy. Without a name, it is named after its property."""
        used = {named.name for named in self.proxies}
        if name and name not in used and not name.startswith(_USER_PREFIX):
            self.proxies.append(NamedSetting(name, setting))
        else:
            unique = free(setting.key.replace(_USER_PREFIX, "x_", 1), used)
            self.proxies.append(NamedSetting(unique, setting, setting.key))

    def keep(self, setting: Setting) -> None:
        """Add a property that fits no section. Lists and tables of TOML cannot be properties, and are lost."""
        if isinstance(setting.value, Leaf):
            self.properties.append(NamedSetting(setting.key, setting))
        else:
            what = f"only texts and numbers can be properties, so that '{setting.key}' is omitted"
            self.diagnostics.append(codes.LOST.at(setting.span, what=what))


def sort(settings: ConfigSettings, ports: PortNames, rules: Rules) -> SortedSettings:
    """Return the settings of a config by section."""
    result = SortedSettings(settings.dialect)
    for setting in settings.settings:
        if not isinstance(setting.value, Leaf):
            if rules.sections["service"].match(f"{setting.key}.") or len(setting.path) > MAX_DEPTH:
                result.keep(setting)
            else:
                result.parameters.append(setting)
        elif settings.dialect == CLASSIC:
            _classic(result, setting, ports, rules)
        else:
            _toml(result, setting, ports, rules)
    return result


def _classic(result: SortedSettings, setting: Setting, ports: PortNames, rules: Rules) -> None:
    key, text = setting.key, setting.text
    if key.startswith("Ice.") and len(key) > 4:
        result.ice.append(NamedSetting(key[4:], setting))
    elif key.endswith(".Endpoints") and len(key) > 10:
        result.put(result.endpoints, key[:-10], setting)
    elif key == "TopicManager.Proxy":
        result.manager.append(NamedSetting("manager", setting))
    elif rules.sections["proxy"].match(text) or (key.removesuffix("Proxy") in ports.requires and key[-5:] == "Proxy"):
        name = key.removesuffix("Proxy")
        result.connect(name if name != key else "", setting)
    elif key.startswith("Proxies.") and key.endswith("Prefix") and len(key) > 14:
        result.put(result.prefixes, key[8:-6], setting)
    elif (key == text or key.removesuffix("Topic") in ports.topics) and _WORD.match(key) and _WORD.match(text):
        result.names.append(NamedSetting(key, setting))
    else:
        _rest(result, setting, ports, rules)


def _toml(result: SortedSettings, setting: Setting, ports: PortNames, rules: Rules) -> None:
    key, path, text = setting.key, setting.path, setting.text
    if path[0] == "Ice" and len(path) > 1:
        result.ice.append(NamedSetting(key[4:], setting))
    elif path[0] == "Endpoints" and len(path) == 2 and text:
        result.put(result.endpoints, path[1], setting)
    elif key == "Proxies.TopicManager" and text:
        result.manager.append(NamedSetting("manager", setting))
    elif path[0] == "Proxies" and len(path) == 2 and not rules.sections["proxy"].match(text) and key[-6:] == "Prefix":
        result.put(result.prefixes, path[1][:-6], setting)
    elif path[0] == "Proxies" and len(path) == 2 and text:
        result.connect(path[1], setting)
    elif rules.sections["proxy"].match(text):
        result.connect("", setting)
    else:
        _rest(result, setting, ports, rules)


def _rest(result: SortedSettings, setting: Setting, ports: PortNames, rules: Rules) -> None:
    """Add a parameter; a setting whose name cannot be a parameter's becomes a property."""
    if result.dialect != TOML and rules.sections["suspicious"].search(setting.key):
        what = rules.repairs["suspicious"].format(text=setting.key)
        result.diagnostics.append(codes.REPAIRED.at(setting.span, what=what))
        result.keep(setting)
    elif (
        rules.sections["service"].match(setting.key)
        or ports.is_connection(setting.key)
        or references.in_text(setting.text)
        or len(setting.path) > MAX_DEPTH
    ):
        result.keep(setting)
    else:
        result.parameters.append(setting)
