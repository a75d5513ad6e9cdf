"""The history of a deployment: what ran after each `up` that was all ready, the latest last.

It contains configurations, and so secrets: only the owner can read it, and `down` removes it.
"""

from __future__ import annotations

import contextlib
import json
from collections.abc import Iterable, Mapping

from msgspec.structs import replace

from robocomp_yaml.deploy import folder as own_folder
from robocomp_yaml.deploy.differences import differences
from robocomp_yaml.deploy.engine import Running
from robocomp_yaml.deploy.plan import in_order
from robocomp_yaml.deploy.spec import ProcessSpec
from robocomp_yaml.deploy.states import ENDED, fault
from robocomp_yaml.network.network import Network, NetworkHost

_FILE = "state/history.json"
_KEPT = 5

Specs = dict[str, ProcessSpec]


def keep(folder: str, running: Iterable[Running]) -> None:
    """Adds what runs, if all of it is as desired, and not the same as before. Raises OSError."""
    now = {one.name: one for one in running if _runs(one)}
    specs = {name: one.spec for name, one in now.items() if one.spec}
    if len(specs) < len(now) or any(fault(one, is_server=specs[name].process.is_server) for name, one in now.items()):
        return
    earlier = read(folder)
    if earlier and _is_same(earlier[-1], specs):
        earlier.pop()
    _write(folder, [*earlier, specs])


def is_there(folder: str) -> bool:
    return bool(read(folder))


def before(folder: str, running: Iterable[Running]) -> list[Specs]:
    """The history up to the latest entry that differs from what runs; empty if there is none."""
    now = {one.name: one.spec for one in running if _runs(one)}
    entries = read(folder)
    while entries and _is_same(entries[-1], now):
        entries.pop()
    return entries


def cut(folder: str, entries: list[Specs]) -> None:
    """Forgets what came after these entries. Raises OSError."""
    _write(folder, entries)


def remove(folder: str) -> None:
    own_folder.remove(folder, _FILE)


def network_of(name: str, path: str, folder: str, specs: Mapping[str, ProcessSpec], like: Network) -> Network:
    """The network of these specs. The locations of its processes, and its hosts, are from the current
    network `like`."""
    hosts: dict[str, NetworkHost] = {}
    for one in specs.values():
        known = like.hosts.get(one.process.host)
        is_known = known is not None and known.address == one.address
        hosts[one.process.host] = known if known and is_known else NetworkHost(one.process.host, one.address)
    processes = {name: replace(one.process, span=like.span_of(name)) for name, one in specs.items()}
    order = tuple((one,) for one in in_order({name: one.process.after for name, one in specs.items()}))
    return Network(name, path, folder, hosts, processes, order=order)


def _runs(one: Running) -> bool:
    return one.is_alive or one.state == ENDED


def _is_same(one: Mapping[str, ProcessSpec | None], other: Mapping[str, ProcessSpec | None]) -> bool:
    """Whether two networks are the same, except for the content of programs, which nothing brings back."""
    if one.keys() != other.keys():
        return False
    pairs = ((one[name], other[name]) for name in one)
    return all(old and new and not differences(old, replace(new, digests=old.digests)) for old, new in pairs)


def read(folder: str) -> list[Specs]:
    """The entries that this version of rcyaml can read."""
    with contextlib.suppress(OSError, ValueError, AttributeError):
        with open(f"{folder}/{_FILE}", encoding="utf-8") as file:
            entries = [{name: ProcessSpec.of_data(data) for name, data in one.items()} for one in json.load(file)]
        return [
            {name: spec for name, spec in one.items() if spec} for one in entries if one and all(one.values())
        ]  # fmt: skip
    return []


def _write(folder: str, entries: list[Specs]) -> None:
    data = [{name: spec.as_data() for name, spec in one.items()} for one in entries[-_KEPT:]]
    own_folder.write(folder, _FILE, json.dumps(data))
