"""What one file of C++ does with values whose types it names, as in `RoboCompMouth::Pose pose;`, and with RoboComp's
settings."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator

from tree_sitter import Node

from robocomp_yaml.emit.specific.code import field, text
from robocomp_yaml.emit.usage.code import MODULES, SETTINGS, Arguments, Chain, Step
from robocomp_yaml.languages.cpp.usage_files import CppFile, function_around, is_uncertain, worker_around

_DECLARING = ("declaration", "parameter_declaration", "for_range_loop")
_SETTINGS = re.compile(r"(?:this->)?(params|configLoader)\Z")
_ENDS = re.compile(r"\b(?:qFatal|throw|exit|_exit|abort|terminate|quick_exit|rethrow_exception|return\s+false)\b")
_GETTERS = frozenset(("at", "get", "find", "count", "contains"))


class TypedCppFile(CppFile):
    def typed(self, module: str) -> Iterator[Chain]:
        """The chains that begin at local variables and parameters of a type of a Slice module."""
        if module.encode() not in self._bytes:
            return
        for node in self._nodes(module, 0, len(self._bytes)):
            named = node.parent
            if named is None or named.type != "qualified_identifier" or named.child_by_field_name("scope") != node:
                continue
            declaration, type_ = named.parent, named.child_by_field_name("name")
            if declaration is None or declaration.type not in _DECLARING or type_ is None:
                continue
            if declaration.child_by_field_name("type") != named or type_.type != "type_identifier":
                continue
            if is_uncertain(named):
                continue
            head = [Step(self._word(node)), Step(self._word(type_), Arguments(is_exact=False))]
            for declarator in declaration.children_by_field_name("declarator"):
                if (name := _name(declarator)) is not None:
                    yield from self._of_variable(MODULES, head, name, declaration)

    def settings(self, workers: Collection[str]) -> Iterator[Chain]:
        """The properties that RoboComp's code reads: `params.at("speed")`, `configLoader.get<int>("speed")`. A handler
        of exceptions that goes on makes them optional."""
        for node in self._literals():
            around = node.parent
            if around is None or around.named_children[0] != node or is_uncertain(node):
                continue
            owner: Node | None = None
            if around.type == "subscript_argument_list" and around.parent is not None:
                owner = around.parent.child_by_field_name("argument")
            elif around.type == "argument_list" and around.parent is not None:
                function = around.parent.child_by_field_name("function")
                name = function.child_by_field_name("field") if function is not None else None
                if function is not None and name is not None and text(name).partition("<")[0] in _GETTERS:
                    owner = function.child_by_field_name("argument")
            found = _SETTINGS.match(text(owner)) if owner is not None else None
            if owner is None or found is None or worker_around(owner) not in workers or _is_optional(owner):
                continue
            if found[1] == "params" and not re.search(r"\bParameterList\b[^,]*\bparams\b", _signature(owner)):
                continue
            if (literal := self._literal(node)) is None or not isinstance(literal.value, str) or not literal.value:
                continue
            yield Chain(SETTINGS, (self._index(literal),))

    def _literals(self) -> Iterator[Node]:
        for found in re.compile(rb'"[^"\\\n]+"').finditer(self._bytes):
            node = self._tree.root_node.descendant_for_byte_range(found.start(), found.end())
            if node is not None and node.type == "string_literal":
                yield node


def _signature(node: Node) -> str:
    """The beginning of the function around a node."""
    function = function_around(node)
    return text(field(function, "declarator")) if function is not None else ""


def _is_optional(node: Node) -> bool:
    """Whether code goes on if the innermost handler around a node catches an exception."""
    now: Node | None = node.parent
    inner = node
    while now is not None and now.type != "function_definition":
        if now.type == "try_statement" and now.child_by_field_name("body") == inner:
            handlers = [child for child in now.named_children if child.type == "catch_clause"]
            return not all(_ENDS.search(text(handler)) for handler in handlers)
        inner, now = now, now.parent
    return False


def _name(declarator: Node) -> Node | None:
    """The name that a declarator declares, if it is a value or a reference."""
    now: Node | None = declarator
    while now is not None and now.type in ("reference_declarator", "init_declarator"):
        inner = now.child_by_field_name("declarator")
        now = inner if inner is not None else next(iter(now.named_children), None)
    return now if now is not None and now.type == "identifier" else None
