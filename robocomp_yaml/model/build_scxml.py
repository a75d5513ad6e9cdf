"""Builds a `StateMachine` from the elements of an SCXML document, after `scxml_shape` has accepted them."""

from __future__ import annotations

from collections.abc import Callable

import msgspec

from robocomp_yaml.diag.span import Span
from robocomp_yaml.model import statemachine as model
from robocomp_yaml.model.located import Text
from robocomp_yaml.model.scxml_shape import ROBOCOMP, scxml_children
from robocomp_yaml.source.xml import Element

ReadText = Callable[[str, Span], str | None]
ReadMachine = Callable[[str, Span], model.StateMachine | None]


class IncludedFiles(msgspec.Struct, frozen=True):
    """Reads the files that `src` names. Both functions report a file that cannot be read, and return None."""

    text: ReadText
    machine: ReadMachine


def build(root: Element, path: str, files: IncludedFiles) -> model.StateMachine:
    """Returns the machine of an `<scxml>` element; `path` is the document as opened."""
    return _ScxmlBuilder(path, files).machine(root)


class _ScxmlBuilder:
    def __init__(self, path: str, files: IncludedFiles) -> None:
        self.path = path
        self.files = files

    def machine(self, root: Element) -> model.StateMachine:
        events = root.get(f"{ROBOCOMP} events")
        return model.StateMachine(
            name=root.get("name") or "",
            path=self.path,
            root=model.numbered(self.state(root)),
            datamodel=root.get("datamodel") or "",
            late=root.get("binding") == "late",
            scripts=tuple(self.action(child) for child in scxml_children(root) if child.name == "script"),
            events=model.words(events or "", root.place(f"{ROBOCOMP} events")),
            span=root.span,
            datamodel_span=root.place("datamodel"),
        )

    def state(self, element: Element) -> model.State:
        children = list(scxml_children(element))

        def each(name: str) -> list[Element]:
            return [child for child in children if child.name == name]

        done = each("donedata")
        kind = model.STATE if element.name == "scxml" else element.name
        return model.State(
            id=element.get("id") or "",
            kind=kind,
            states=tuple(
                self.state(c) for c in children if c.name in (model.STATE, model.PARALLEL, model.FINAL, model.HISTORY)
            ),
            transitions=() if kind == model.HISTORY else tuple(self.transition(child) for child in each("transition")),
            initial=self.initial(element, children),
            deep=element.get("type") == "deep",
            entry=tuple(self.block(child) for child in each("onentry")),
            exit=tuple(self.block(child) for child in each("onexit")),
            data=tuple(self.data(item) for model in each("datamodel") for item in scxml_children(model)),
            invokes=tuple(self.invoke(child) for child in each("invoke")),
            done=self.payload(done[0]) if done else model.Payload(),
            span=element.place("id"),
        )

    def initial(self, element: Element, children: list[Element]) -> model.Transition | None:
        """The transition of `initial=` or `<initial>`; of a history, its own transition."""
        if element.get("initial") is not None:
            return model.Transition(targets=_words(element, "initial"), span=element.place("initial"))
        for child in children:
            if child.name == "initial":
                return self.transition(next(scxml_children(child)))
            if child.name == "transition" and element.name == model.HISTORY:
                return self.transition(child)
        return None

    def transition(self, element: Element) -> model.Transition:
        return model.Transition(
            events=_words(element, "event"),
            condition=_text(element, "cond") if (element.get("cond") or "").strip() else None,
            targets=_words(element, "target"),
            internal=element.get("type") == "internal",
            actions=self.block(element),
            span=element.span,
        )

    def block(self, element: Element) -> model.Block:
        return tuple(self.action(child) for child in scxml_children(element))

    def action(self, e: Element) -> model.Action:
        match e.name:
            case "raise":
                return model.Raise(_text(e, "event") or Text(""), span=e.span)
            case "send":
                return model.Send(
                    _value(e, "event"), _value(e, "target"), _value(e, "type"), _value(e, "delay"), e.get("id") or "",
                    _text(e, "idlocation"), self.payload(e), span=e.span,
                )  # fmt: skip
            case "cancel":
                return model.Cancel(_value(e, "sendid"), span=e.span)
            case "log":
                return model.Log(e.get("label") or "", model.Value(expr=_text(e, "expr"), span=e.span), span=e.span)
            case "assign":
                return model.Assign(_text(e, "location") or Text(""), self.content(e), span=e.span)
            case "script":
                code = self.files.text(e.attributes["src"], e.place("src")) if "src" in e.attributes else e.text
                return model.Script(Text(code or "", span=e.span), span=e.span)
            case "if":
                return model.If(self.branches(e), span=e.span)
            case _:
                return model.Foreach(
                    _text(e, "array") or Text(""), _text(e, "item") or Text(""), _text(e, "index"), self.block(e),
                    span=e.span,
                )  # fmt: skip

    def branches(self, element: Element) -> tuple[tuple[Text | None, model.Block], ...]:
        branches: list[tuple[Text | None, list[model.Action]]] = [(_text(element, "cond"), [])]
        for child in scxml_children(element):
            if child.name in ("elseif", "else"):
                branches.append((_text(child, "cond"), []))
            else:
                branches[-1][1].append(self.action(child))
        return tuple((condition, tuple(inner)) for condition, inner in branches)

    def data(self, element: Element) -> model.Data:
        if "src" in element.attributes:
            value = model.Value(
                literal=self.files.text(element.attributes["src"], element.place("src")), span=element.span
            )
        else:
            value = self.content(element)
        return model.Data(_text(element, "id") or Text(""), value, span=element.span)

    def content(self, element: Element) -> model.Value:
        """An expression, a machine, or the text in the element."""
        if element.get("expr") is not None:
            return model.Value(expr=_text(element, "expr"), span=element.span)
        for child in scxml_children(element):
            if child.name == "scxml":
                return model.Value(literal=child.raw, machine=self.machine(child), span=element.span)
        literal = "".join(item if isinstance(item, str) else item.raw for item in element.content)
        return model.Value(literal=literal if literal.strip() else None, span=element.span)

    def payload(self, element: Element) -> model.Payload:
        names = _words(element, "namelist")
        params = [model.Param(name.text, model.Value(expr=name, span=name.span), span=name.span) for name in names]
        content = None
        for child in scxml_children(element):
            if child.name == "param":
                expr = _text(child, "expr") or _text(child, "location")
                params.append(
                    model.Param(child.get("name") or "", model.Value(expr=expr, span=child.span), span=child.span)
                )
            elif child.name == "content":
                content = self.content(child)
        return model.Payload(tuple(params), content)

    def invoke(self, element: Element) -> model.Invoke:
        source = _value(element, "src")
        if source.literal is not None:
            machine = self.files.machine(source.literal, element.place("src"))
            source = model.Value(literal=source.literal, machine=machine, span=source.span)
        final = [child for child in scxml_children(element) if child.name == "finalize"]
        return model.Invoke(
            type=_value(element, "type"),
            source=source,
            id=element.get("id") or "",
            id_location=_text(element, "idlocation"),
            payload=self.payload(element),
            autoforward=element.get("autoforward") == "true",
            finalize=self.block(final[0]) if final else None,
            span=element.span,
        )


def _text(element: Element, name: str) -> Text | None:
    value = element.get(name)
    return None if value is None else Text(value.strip(), span=element.place(name))


def _words(element: Element, name: str) -> tuple[Text, ...]:
    return model.words(element.get(name) or "", element.place(name))


def _value(element: Element, name: str) -> model.Value:
    """The attribute `name` as a literal, and the attribute `NAMEexpr` as an expression."""
    return model.Value(_text(element, f"{name}expr"), element.get(name), span=element.place(name))
