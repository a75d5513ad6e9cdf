"""Compares the use that code makes of the worker with what the worker has: the same rules for every language."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping

import msgspec

from robocomp_yaml.diag.code import Code
from robocomp_yaml.diag.codes import usage as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.diag.suggest import did_you_mean, likeness, suggest
from robocomp_yaml.emit.usage import offer as offers
from robocomp_yaml.emit.usage.arguments import after, is_context, wrong_arguments, wrong_results, wrong_sum
from robocomp_yaml.emit.usage.code import (
    FILE,
    LOOPED,
    SETTINGS,
    WORKER,
    Arguments,
    Chain,
    CodeUsage,
    Constant,
    Step,
    Word,
)
from robocomp_yaml.emit.usage.kinds import Kind, kind_of, of_basic, wanted
from robocomp_yaml.emit.usage.literals import never_equal, of_setting
from robocomp_yaml.emit.usage.offer import Offer, OfferedMember, ServedInterface, WorkerOffer
from robocomp_yaml.emit.usage.slips import of_slip
from robocomp_yaml.emit.usage.values import EDITABLE, keys, unknown, unknown_setting, where, wrong_paths, wrong_value
from robocomp_yaml.link.program import LinkedComponent
from robocomp_yaml.model.interface import Member

_NEAR = 0.75  # similarity of a member that is surely misspelled
_PROXY = re.compile(r"\w+_(?:pub)?proxy\d*_*\Z")
_NEARLY = re.compile(r"([a-z]\w*?)_?(?:pub_?)?(?:[Pp]rox[yi]|[Pp]rx)\d*_*\Z")

_LONGER, _MISTYPED = 3, 0.85  # characters, and similarity, of a proxy that is surely misspelled
_OF_ICE = "ice_"
_FEW = 6  # members that are listed
_VALUES = (offers.RECORD, offers.TOOL, offers.PROXY, offers.TOPIC, offers.EVENTS, offers.PARAMETERS)


def is_proxy(name: str) -> bool:
    """Whether a name has the form that names of proxies have."""
    return _PROXY.match(name) is not None


def is_nearly_proxy(name: str, known: Iterable[str]) -> bool:
    """Whether a name is one of the known proxies in another form, such as `mouthProxy`, or with a typing error."""
    found = _NEARLY.match(name)
    proxies = [one for one in known if is_proxy(one)]
    stems = {re.sub(r"_(?:pub)?proxy.*", "", one).lower() for one in proxies}
    if found is not None:
        return found[1].lower().rstrip("_") in stems
    if "_" not in name or "x" not in name:
        return False  # most words: likeness takes long
    return any(abs(len(name) - len(one)) < _LONGER and likeness(name, one) > _MISTYPED for one in proxies)


def judge(
    linked: LinkedComponent, usage: CodeUsage, offer: WorkerOffer, config: Collection[str] = ()
) -> Iterator[Diagnostic]:  # fmt: skip
    """The diagnostics about the code of a component; `config` are the keys of its flat config."""
    for text, span in usage.faults:
        yield codes.SYNTAX.at(span, text=text)
    if usage.faults:
        return
    yield from map(of_slip, usage.slips)
    judging = _Judging(linked, usage, offer)
    seen = set[tuple[str, Span]]()  # chains through variables share their first steps
    for chain in usage.chains:
        if chain.root == FILE:
            yield from judging.own_call(chain, usage.functions.get(chain.steps[0].word.span.file, {}))
        elif chain.root in offer.roots:
            for fault in judging.chain(chain):
                if (fault.code, fault.span) not in seen:
                    seen.add((fault.code, fault.span))
                    yield fault
        elif chain.root == SETTINGS and chain.steps[-1].word.text not in usage.texts:
            yield from of_setting(linked, chain)
            if not chain.is_again:
                yield from unknown_setting(linked, chain, config)
    yield from judging.methods()
    for returned in usage.returned:
        yield from wrong_results(returned, offer)


class _Judging(msgspec.Struct):
    linked: LinkedComponent
    usage: CodeUsage
    offer: WorkerOffer

    def chain(self, chain: Chain) -> Iterator[Diagnostic]:
        """Follows a chain to the first step that is not offered."""
        now: Offer | None = self.offer.roots[chain.root]
        if chain.root == WORKER and chain.steps[0].word.text in self.usage.own:
            yield from self.own_call(chain, self.usage.signatures)
            return
        member: OfferedMember | None = None
        for number, step in enumerate(chain.steps):
            if now is None:
                return
            if step.makes:
                now, member = offers.of_list(now) if step.makes == "list" else offers.of_values(now), None
                continue
            if step.is_instance:  # what an annotation says is judged where it is
                member = now.members.get(step.word.text)
                now, member = (member.instance or member.value) if member is not None else None, None
                continue
            if step.is_index:
                word = step.word if step.word.text else step.shown
                if word is not None and not chain.is_again and "TypeError" not in chain.caught:
                    yield from self._indexed(now, word, is_text=bool(step.word.text))
                now, member = now.at(step), None
                continue
            member = now.members.get(step.word.text)
            if member is None and step.word.text in now.lacks and "AttributeError" not in chain.caught:
                if not chain.is_again:
                    hint = now.lacks[step.word.text]
                    yield codes.UNKNOWN_MEMBER.at(step.word.span, struct=now.name, name=step.word.text, hint=hint)
                return
            if member is None:
                if not chain.is_again and not self._may_exist(now, step, chain):
                    yield self._unknown(now, step)
                return
            is_last = number + 1 == len(chain.steps)
            if member.instead and not chain.is_hint and not chain.is_again and not chain.caught:
                yield codes.UNKNOWN_TYPE.at(step.word.span, name=step.word.text, module=now.name, hint=member.instead)
                return
            if not chain.is_again and (fault := self._called_or_not(now, step, member, chain)):
                yield fault
            elif step.arguments is not None and not chain.is_again:
                yield from self._call(now, step.word, member, step.arguments, chain)
            elif is_last and chain.is_assigned and member.parameter is not None:
                yield from self._assigned(now, member, step.word, chain.constant)
            elif is_last and chain.is_assigned and chain.constant is not None and now.kind == offers.STRUCT:
                yield from self._set(now, member, step.word, chain.constant)
            now = after(step, member)
        integers = self.linked.component.language.name == "python"  # an enum of C++98 may be compared with one
        yield from never_equal(chain, member, now, integers=integers)
        yield from wrong_sum(chain, now, member)
        if chain.used and now is not None and now.kind == offers.RESULTS and not now.count:
            yield self._results(now, chain.steps[-1].word, chain.used)
        elif chain.used == LOOPED and now is not None and now.kind == offers.STRUCT and chain.steps[-1].arguments:
            yield self._results(now, chain.steps[-1].word, chain.used)
        if chain.unpacked and now is not None and not _is_unpacked(now, chain.unpacked):
            yield self._results(now, chain.steps[-1].word, f"{chain.unpacked} values")

    def own_call(self, chain: Chain, signatures: Mapping[str, OfferedMember]) -> Iterator[Diagnostic]:
        """The arguments of a call of what the code defines itself."""
        word, arguments = chain.steps[0].word, chain.steps[0].arguments
        member = signatures.get(word.text)
        if member is not None and arguments is not None and not chain.is_again and word.text not in self.usage.texts:
            yield from self._call(offers.NOTHING, word, member, arguments, chain)

    def _called_or_not(self, now: Offer, step: Step, member: OfferedMember, chain: Chain) -> Diagnostic | None:
        """A value that is called, or a getter that is not."""
        word = step.word
        if step.arguments is None:
            return codes.NOT_CALLED.at(word.span, name=word.text, hint=f"write {word.text}()") if member.read else None
        if "TypeError" in chain.caught:
            return None
        if member.value is not None and member.value.kind == offers.ENUM and member.signature:
            return codes.NOT_CALLABLE.at(word.span, name=word.text, hint=f"write {member.signature}")
        is_value = member.parameter is not None or now.kind in (offers.STRUCT, offers.ENUM)
        is_value |= member.value is not None and member.value.kind in _VALUES
        if not is_value or member.most is not None or member.result is not None:
            return None
        return codes.NOT_CALLABLE.at(word.span, name=word.text, hint=f"write {word.text}, without ()")

    def _set(self, now: Offer, member: OfferedMember, word: Word, constant: Constant) -> Iterator[Diagnostic]:
        """A literal that a member of a struct cannot be."""
        if member.value is not None and member.value.kind == offers.PLAIN:
            if needed := wanted(member.value.name, constant.value, integers=True):
                yield codes.WRONG_LITERAL.at(
                    constant.span, owner=now.name, name=word.text, value=repr(constant.value), wanted=needed
                )

    def _results(self, now: Offer, word: Word, used: str) -> Diagnostic:
        count = "nothing" if not now.count else f"{now.count} values"
        count = count if now.kind == offers.RESULTS else f"one {now.name}"
        return codes.WRONG_RESULTS.at(word.span, owner=word.text, count=count, used=used)

    def _indexed(self, now: Offer, word: Word, *, is_text: bool) -> Iterator[Diagnostic]:
        """An index of what has attributes, or a text as the one of a list."""
        if now.kind == offers.PARAMETERS and not is_text:
            yield codes.NOT_INDEXED.at(word.span, owner="the parameters", name=word.text, hint="they are attributes")
        elif now.kind == offers.PARAMETERS:
            attributes = list(keys(self.linked.parameters.parameters.root))
            meant = word.text if word.text in attributes else suggest(word.text, attributes)
            called = "()" if any(member.most == 0 for member in now.members.values()) else ""
            hint = f"write parameters.{meant}{called}" if meant else where(self.linked)
            yield codes.NOT_INDEXED.at(word.span, owner="the parameters", name=word.text, hint=hint)
        elif now.kind in (offers.STRUCT, offers.ENUM, offers.RECORD):
            hint = f"write .{word.text}" if word.text in now.members else _listed(now.members, "it has")
            yield codes.NOT_INDEXED.at(word.span, owner=now.name or "it", name=word.text, hint=hint)
        elif now.kind == offers.PLAIN and now.is_complete and (is_text or now.name != "string"):
            hint = "an index is a number" if now.name == "string" else ""
            yield codes.NOT_INDEXED.at(word.span, owner=of_basic(now.name), name=word.text, hint=hint)
        elif now.each is not None and is_text:
            yield codes.NOT_INDEXED.at(word.span, owner="a list", name=word.text, hint="an index is a number")

    def _may_exist(self, now: Offer, step: Step, chain: Chain) -> bool:
        name = step.word.text
        if name in self.usage.texts or now.others(name) or "AttributeError" in chain.caught:
            return True
        if now.kind == offers.WORKER:
            if chain.is_assigned or self.usage.is_open:
                return True
            is_proxy_name = is_proxy(name) or is_nearly_proxy(name, now.members)
            return not is_proxy_name and (self.usage.is_shared or not now.is_complete)
        if now.kind in (offers.STRUCT, offers.TOOL) and (chain.is_assigned or name in self.usage.own):
            near = suggest(name, now.members)  # in Python, they may get further attributes
            return near is None or likeness(name, near) < _NEAR
        return not now.is_complete

    def _unknown(self, now: Offer, step: Step) -> Diagnostic:
        word, known = step.word, now.members
        name, component = word.text, self.linked.component.name
        match now.kind:
            case offers.WORKER if is_proxy(name) or is_nearly_proxy(name, known):
                proxies = [one for one, member in known.items() if _is_of_proxy(member)]
                lacking = self._lacking(name)
                similar = [one for one in proxies if not lacking or one.lower() == name.lower()]
                hint = lacking or f"`requires:` and `publishes:` of {self.linked.component.path} make the proxies"
                return self._at(codes.UNKNOWN_PROXY, word, similar, hint, component=component)
            case offers.WORKER:
                return self._at(codes.UNKNOWN_ATTRIBUTE, word, known, component=component)
            case offers.PROXY | offers.TOPIC:
                code = codes.UNKNOWN_METHOD if now.kind == offers.PROXY else codes.UNKNOWN_EVENT
                listed = [one for one in known if not one.endswith(offers.ASYNC) and not one.startswith(_OF_ICE)]
                return self._at(code, word, known, _listed(listed, "it has"), interface=now.name)
            case offers.PARAMETERS | offers.RECORD:
                if not_editable := self._not_editable(name, known):
                    return codes.NOT_EDITABLE.at(word.span, name=not_editable, hint=EDITABLE)
                return self._at(codes.UNKNOWN_PARAMETER, word, known, where(self.linked), owner=now.name or component)
            case offers.EVENTS:
                return self._at(codes.UNKNOWN_OF_MACHINE, word, known, what="event", component=component)
            case offers.MODULES:
                hint = f"add the document of {name} to `imports:`, if the component needs it"
                return self._at(codes.UNKNOWN_MODULE, word, known, hint, component=component)
            case offers.ENUM:
                return self._at(codes.UNKNOWN_ENUMERATOR, word, known, _listed(known, "it has"), enum=now.name)
            case offers.FUTURE:
                return codes.UNKNOWN_MEMBER.at(
                    word.span, struct=now.name, name=name, hint="result() waits for the result"
                )
            case offers.STRUCT | offers.TOOL:
                members = _listed(known, "it has") if now.kind == offers.STRUCT or len(known) < _FEW else ""
                return self._at(codes.UNKNOWN_MEMBER, word, known, members, struct=now.name)
            case offers.PLAIN | offers.LIST:
                return self._at(codes.UNKNOWN_MEMBER, word, known, struct=of_basic(now.name) or now.name)
            case offers.MAP:
                hint = f'write ["{name}"]'
                return self._at(codes.UNKNOWN_MEMBER, word, known, hint, struct=now.name)
            case offers.RESULTS:
                count = "nothing" if not now.count else f"{now.count} values"
                return codes.WRONG_RESULTS.at(word.span, owner=now.name, count=count, used=f"one with '{name}'")
            case _:
                return self._at(codes.UNKNOWN_TYPE, word, known, module=now.name)

    def _call(
        self, now: Offer, word: Word, member: OfferedMember, arguments: Arguments, chain: Chain
    ) -> Iterator[Diagnostic]:  # fmt: skip
        if member.takes_path:
            yield from wrong_paths(self.linked, arguments)
        if member.is_state and arguments.text and arguments.text.text not in self.offer.states:
            component = self.linked.component.name
            states = sorted(self.offer.states)
            yield self._at(codes.UNKNOWN_OF_MACHINE, arguments.text, states, what="state", component=component)
        first = arguments.values[0] if arguments.values else None
        if member.parameter is not None and member.most == 1 and first is not None:
            yield from wrong_value(member.parameter.type, member.path or member.parameter.name, first)
        if "TypeError" in chain.caught or not arguments.is_exact:
            return
        for name in arguments.names:
            if member.keywords is not None and name.text not in member.keywords:
                known = sorted(member.keywords - {"context"})
                yield self._at(codes.UNKNOWN_ARGUMENT, name, known, owner=word.text, signature=member.signature)
                return
        count = arguments.count + len([one for one in arguments.names if one.text != "context"])
        if member.can_be_empty and not count:
            return
        is_operation = now.kind in (offers.PROXY, offers.TOPIC)
        is_surplus = is_operation and arguments.count > member.least and member.most is not None
        is_surplus = is_surplus and not is_context(arguments, member.least, self.offer)
        owner = f"{now.name}.{word.text}" if is_operation else word.text
        if count < member.least or (member.most is not None and count > member.most) or is_surplus:
            hint = f"it is {member.signature}" if member.signature else ""
            is_open = not is_operation and member.most is not None and count > member.most > member.least
            expected = f"at most {_arguments(member.most or 0)}" if is_open else _arguments(member.least)
            yield codes.WRONG_ARGUMENTS.at(word.span, owner=owner, expected=expected, count=count, hint=hint)
        else:
            kinds = tuple(self._kind(now, one) for one in member.inputs)
            yield from wrong_arguments(owner, member.inputs, kinds, arguments, self.offer)

    def _kind(self, owner: Offer, parameter: Member) -> Kind | None:
        """What a parameter of an operation is, or a member of a struct."""
        ports = (*self.linked.requires, *self.linked.publishes)
        scopes = [port.scope for port in ports if port.interface.name == owner.name]
        if owner.kind == offers.MODULE:
            scopes = [scope for scope in self.linked.modules() if scope.module.name == owner.name]
        if parameter.type.is_basic:
            return Kind(of_basic(parameter.type.text), parameter.type.text)
        return next((kind for scope in scopes if (kind := kind_of(parameter.type, scope)) is not None), None)

    def _assigned(
        self, now: Offer, member: OfferedMember, word: Word, constant: Constant | None
    ) -> Iterator[Diagnostic]:  # fmt: skip
        parameter = member.parameter
        assert parameter is not None
        if now.kind == offers.RECORD:
            hint = f'call `set("{member.path or "PATH"}", value)` of the parameters'
            yield codes.NOT_ASSIGNED.at(word.span, name=member.path or parameter.name, hint=hint)
            return
        if not parameter.editable and not parameter.is_group:
            yield codes.NOT_EDITABLE.at(word.span, name=member.path or parameter.name, hint=EDITABLE)
        elif constant is not None:
            yield from wrong_value(parameter.type, member.path or parameter.name, constant)

    def methods(self) -> Iterator[Diagnostic]:
        """Methods whose names are like those that others call, but that nobody calls."""
        mine = {word.text for word in self.usage.methods}
        used = {step.word.text for chain in self.usage.chains if chain.root == WORKER for step in chain.steps[:1]}
        called = {name for one in self.offer.served for name in one.methods}
        for word in self.usage.methods:
            if word.text in used or word.text in self.usage.texts or word.text in called:
                continue
            if (interface := _served_by(word.text, self.offer.served)) is not None:
                name = word.text.removeprefix(interface.prefix)
                missing = [one.removeprefix(interface.prefix) for one in interface.methods if one not in mine]
                what = "topic" if interface.is_topic else "interface"
                hint = did_you_mean(name, missing, otherwise=_listed(missing, "the class lacks"))
                meant = f"{interface.prefix}{hint.meant}" if hint.meant else ""
                yield unknown(
                    codes.NEVER_CALLED, word, meant, otherwise=hint.text, safe=hint.safe, what=what,
                    owner=interface.name, method=name,
                )  # fmt: skip
            elif self.offer.handlers and word.text.startswith("sm_") and word.text not in self.offer.handlers:
                missing = [one for one in sorted(self.offer.handlers) if one not in mine]
                if suggest(word.text, missing):
                    yield self._at(codes.NO_HANDLER, word, missing)

    def _at(
        self, code: Code, word: Word, known: Iterable[str], otherwise: str = "", **facts: object
    ) -> Diagnostic:  # fmt: skip
        hint = did_you_mean(word.text, known, otherwise=otherwise)
        return unknown(code, word, hint.meant, otherwise=hint.text, safe=hint.safe, **facts)

    def _lacking(self, name: str) -> str:
        """The port that the document lacks for a proxy of this name; '' if there is no such interface."""
        is_topic = "_pubproxy" in name
        stem = re.sub(r"_(?:pub)?proxy.*", "", name)
        has = {port.interface.name.lower() for port in (*self.linked.requires, *self.linked.publishes)}
        if stem in has:
            return ""
        for scope in self.linked.imports:
            for interface in scope.module.all_interfaces:
                if interface.name.lower() == stem:
                    key = "publishes" if is_topic or interface.is_topic else "requires"
                    return f"add {interface.name} to `{key}:` of {self.linked.component.path}"
        return ""

    def _not_editable(self, name: str, known: Iterable[str]) -> str:
        """The parameter that a setter would set, if it were editable."""
        if not re.match(r"set[A-Z]", name):
            return ""
        stem = name.removeprefix("set").lower()
        paths = keys(self.linked.parameters.parameters.root)
        return next((path for path in paths if path.replace(".", "").lower() == stem), "")


def _is_unpacked(result: Offer, count: int) -> bool:
    """Whether a result may be unpacked to this number of variables."""
    if result.kind == offers.RESULTS:
        return result.count == count
    return not (result.kind == offers.STRUCT or (result.kind == offers.PLAIN and result.name != "string"))


def _is_of_proxy(member: OfferedMember) -> bool:
    return member.value is not None and member.value.kind in (offers.PROXY, offers.TOPIC)


def _listed(known: Iterable[str], head: str) -> str:
    names = list(known)
    return f"{head} {', '.join(names[:20])}" if names else ""


def _arguments(count: int) -> str:
    return "no arguments" if count == 0 else "1 argument" if count == 1 else f"{count} arguments"


def _served_by(name: str, served: Iterable[ServedInterface]) -> ServedInterface | None:
    return next((one for one in served if name.startswith(one.prefix)), None)
