"""What the worker offers to code in C++, and which of that the user's code uses.

A name that the code declares anywhere may hide the worker's own, so nothing is said about it. Code in conditional
parts of the preprocessor, in macros and in templates is not judged, nor is anything near a syntax error.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from functools import partial

from msgspec import structs

from robocomp_yaml.emit.lowering import ports as lowering
from robocomp_yaml.emit.usage import offer as offers
from robocomp_yaml.emit.usage.code import MODULES, NO_RESULT, WORKER, Arguments, Chain, CodeUsage, Slip, Step, Word
from robocomp_yaml.emit.usage.judge import is_nearly_proxy, is_proxy
from robocomp_yaml.emit.usage.offer import Offer, OfferedMember, WorkerOffer
from robocomp_yaml.emit.usage.types import OfferedTypes
from robocomp_yaml.languages._shared.usage_file import TEXT, WORD, unused, workers_of
from robocomp_yaml.languages.cpp import LANGUAGE
from robocomp_yaml.languages.cpp.names import PORTS, ice_name, older_names
from robocomp_yaml.languages.cpp.parameters import accessors
from robocomp_yaml.languages.cpp.usage_files import Occurrence
from robocomp_yaml.languages.cpp.usage_typed import TypedCppFile
from robocomp_yaml.link.program import LinkedComponent

_INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*"([^"]+)"', re.MULTILINE)
_METHOD = re.compile(r"\b(?:sm_\w+|[A-Z]\w*_\w+)\b")


def offer(linked: LinkedComponent) -> WorkerOffer:
    """What the worker of a component offers."""
    ports, machine = lowering.lower(linked, PORTS), linked.machine
    types = OfferedTypes(ice_name, _is_of_every_struct, _is_of_every_exception)
    returned = partial(types.result, tuples=False)
    members = offers.OfferedProxies(PORTS.called, _is_of_every_proxy, returned, outputs=True).every(ports)
    if linked.component.compatibility:
        members |= {name: members[now] for name, now in older_names(list(members))}
    else:
        members["parameters"] = OfferedMember(_parameters(linked))
        if machine:
            members["events"] = OfferedMember(offers.events(machine, ice_name))
            is_in = {"isIn": OfferedMember(least=1, most=1, is_state=True)}
            members["statemachine"] = OfferedMember(Offer(offers.OTHER, "", is_in, is_complete=False))
    served = offers.served(ports)
    handled = offers.handlers(machine) if machine else ()
    modules = offers.modules(linked, ice_name, ice_name, lambda name: True, types.of_definition)
    if linked.component.compatibility:
        modules = structs.replace(
            modules, members={name: _with_enumerators(one) for name, one in modules.members.items()}
        )
    return WorkerOffer(
        {WORKER: Offer(offers.WORKER, linked.component.name, members, is_complete=False), MODULES: modules},
        served, handled, offers.states(machine) if machine else (), offers.answering(ports, outputs=False),
    )  # fmt: skip


def _with_enumerators(module: OfferedMember) -> OfferedMember:
    """A module in which enumerators are outside of their enums, too, as in RoboComp's code."""
    assert module.value is not None
    enums = [one.value.members for one in module.value.members.values() if one.value is not None]
    outside = {name: member for members in enums for name, member in members.items()}
    return OfferedMember(structs.replace(module.value, members={**outside, **module.value.members}))


def _parameters(linked: LinkedComponent) -> Offer:
    """The getters and setters of the parameters."""
    root = linked.parameters.parameters.root
    members = {
        "now": OfferedMember(offers.record(root, LANGUAGE.in_code), most=0),
        "set": OfferedMember(least=2, most=2, takes_path=True, signature="set(path, value)"),
        "change": OfferedMember(least=1, most=1, signature="change(function)"),
        "listen": OfferedMember(least=1, most=1, signature="listen(function)"),
    }
    for getter, member, setters in accessors(root):
        value = offers.value(member.type, LANGUAGE.in_code, member.name if member.is_group else "")
        members[getter] = OfferedMember(value, most=0, signature=f"{getter}()", read=member)
        members |= offers.setters(setters)
    return Offer(offers.PARAMETERS, linked.component.name, members)


def _is_of_every_proxy(name: str) -> bool:
    """Methods of Ice, and its asynchronous variants of the operations."""
    return name.startswith(("ice_", "_", "begin_", "end_"))


def _is_of_every_struct(name: str) -> bool:
    return name.startswith(("ice_", "_", "operator"))


def _is_of_every_exception(name: str) -> bool:
    return name == "what" or _is_of_every_struct(name)


def read(files: Mapping[str, str], linked: LinkedComponent, worker: WorkerOffer) -> CodeUsage:
    """The use that the files below src/ make of the worker, by their paths there."""
    known = worker.roots[WORKER].members
    words = {word for text in files.values() for word in WORD.findall(text)}
    names = {word for word in words if word in known or is_proxy(word) or is_nearly_proxy(word, known)}
    handlers = {word for word in words if _METHOD.fullmatch(word)} if worker.served or worker.handlers else set()
    modules = words & worker.roots[MODULES].members.keys() - _extended(files.values())
    is_robocomp = bool(linked.component.compatibility)
    if not names and not handlers and not modules and not is_robocomp:
        return CodeUsage()
    parsed = [TypedCppFile(path, text) for path, text in files.items() if _is_own(path)]
    workers = workers_of(one for file in parsed for one in file.classes())
    if not workers:
        return CodeUsage()
    uses: list[Occurrence] = []
    declared: set[str] = set()
    for file in parsed:
        for name in sorted(names):
            for occurrence in file.occurrences(name, workers):
                if occurrence.is_declared:
                    declared.add(name)
                elif occurrence.chain is not None:
                    uses.append(occurrence)
    if not all(_is_known_include(one, files) for text in files.values() for one in _INCLUDE.findall(text)):
        declared |= {name for name in names if name not in known}  # it may be declared there
    settings = tuple(chain for file in parsed for chain in file.settings(workers)) if is_robocomp else ()
    written = Counter(text for source in files.values() for text in TEXT.findall(source))
    written.subtract(chain.steps[0].word.text for chain in settings)
    texts = {text for text, count in written.items() if count > 0}
    chains = tuple(one.chain for one in uses if one.chain is not None)
    # Beside code for RoboComp's own tool, there may be files of that tool, which are not compiled.
    compiled = [file for file in parsed if not is_robocomp or "specificworker." in file.path]
    proxies = _proxies(worker.roots[WORKER])
    for file in compiled:
        for name in sorted(modules):
            chains += (*file.qualified(name), *file.typed(name, proxies))
    chains += tuple(_of_members(compiled, modules, worker.roots[WORKER], workers))
    methods = unused([word for file in parsed for word in file.methods(workers)], files.values(), _METHOD)
    first = tuple({word.text: word for word in reversed(methods)}.values())  # not its definition, too
    silent = "noreturn" not in words
    slips = [Slip(NO_RESULT, word) for file in compiled if silent for word in file.silent(worker.answering, workers)]
    for name, interface in ((name, one.value) for name, one in known.items() if name in names - declared):
        if interface is not None and is_proxy(name):
            slips += [slip for file in compiled for slip in file.dotted(name, interface.members, workers)]
    return CodeUsage(
        (*chains, *settings), first, frozenset(declared), frozenset(texts), is_shared=True, slips=tuple(slips)
    )  # fmt: skip


def _of_members(
    files: Sequence[TypedCppFile], modules: Collection[str], worker: Offer, workers: Collection[str]
) -> Iterator[Chain]:  # fmt: skip
    """The chains that begin at members of the worker which are proxies, or of another type of a Slice module. The name
    of a member has one declaration in all files."""
    proxies = _proxies(worker)
    for name, type_ in [member for file in files for member in file.members(workers)]:
        interface = re.sub(r"Prx(Ptr)?\Z", "", type_.type.text)
        root, head = MODULES, [Step(type_.module), Step(type_.type, Arguments(is_exact=False))]
        if interface != type_.type.text and interface in proxies:
            root, head = WORKER, [Step(Word(proxies[interface], type_.type.span))]
        if type_.module.text in modules:
            found = [file.of_member(name, root, head, workers) for file in files]
            if sum(declared for _, declared in found) == 1:
                yield from (chain for chains, _ in found for chain in chains)


def _proxies(worker: Offer) -> dict[str, str]:
    """The names of the worker's proxies, by interface."""
    return {one.value.name: name for name, one in worker.members.items() if one.value is not None and is_proxy(name)}


def _extended(texts: Iterable[str]) -> set[str]:
    """The namespaces to which the code adds something."""
    return {name for text in texts for name in re.findall(r"\bnamespace\s+(\w+)\s*(?:::|\{|=)", text)}


def _is_own(path: str) -> bool:
    """Whether a file is not one that RoboComp's own tool left in src/."""
    return not re.search(r"(^|/)(generic(worker|monitor)|specificmonitor|commonbehaviorI|ui_\w+|moc_\w+)\.\w+$", path)


def _is_known_include(path: str, files: Mapping[str, str]) -> bool:
    name = path.rpartition("/")[2]
    generated = ("genericworker.h", "interfaces.h", "parameters.h", "statemachine.h", "ui_mainUI.h")
    return name in generated or any(other == path or other.endswith(f"/{path}") for other in files)
