"""What one file of C++ does with values whose types it names, as in `RoboCompMouth::Pose pose;`, and with RoboComp's
settings."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping

import msgspec
from tree_sitter import Node

from robocomp_yaml.emit.specific.code import field, text
from robocomp_yaml.emit.usage.code import ARROW, MODULES, SETTINGS, WORKER, Arguments, Chain, Slip, Step, Word
from robocomp_yaml.languages.cpp.usage_files import (
    IN_CLASSES,
    CppFile,
    Occurrence,
    class_around,
    function_around,
    is_uncertain,
    of_types,
    worker_around,
)

_DECLARING = ("declaration", "parameter_declaration", "for_range_loop")
_SETTINGS = re.compile(r"(?:this->)?(params|configLoader)\Z")
_ENDS = re.compile(r"\b(?:qFatal|throw|exit|_exit|abort|terminate|quick_exit|rethrow_exception|return\s+false)\b")
_LEAVING = frozenset("return_statement throw_statement co_return_statement goto_statement".split())
_LEAVES = re.compile("[A-Z][A-Z0-9_]+|abort|exit|_exit|terminate|quick_exit|rethrow_exception|qFatal|unreachable")
_GETTERS = frozenset(("at", "get", "find", "count", "contains"))
_CASTS = frozenset(("checkedCast", "uncheckedCast"))
_LISTS = frozenset("array deque list span vector".split())
_NAMED = re.compile(r"(?:::|std::shared_ptr<\s*(?:::)?)?(\w+)::(\w+)\s*>?")


class TypeName(msgspec.Struct, frozen=True):
    """A type of a module as the code names it."""

    module: Word
    type: Word


class TypedCppFile(CppFile):
    def typed(self, module: str, proxies: Mapping[str, str]) -> Iterator[Chain]:
        """The chains that begin at local variables and parameters of a type of a Slice module. `proxies` are the
        proxies of the worker, by interface: others of the same type have the same methods."""
        if module.encode() not in self._bytes:
            return
        for node in self._nodes(module, 0, len(self._bytes)):
            named = node.parent
            if named is None or named.type != "qualified_identifier" or named.child_by_field_name("scope") != node:
                continue
            declaration, type_ = named.parent, named.child_by_field_name("name")
            if type_ is not None and not is_uncertain(named):
                if (own := proxies.get(re.sub(r"Prx(Ptr)?\Z", "", text(type_)))) and re.search(r"Prx", text(type_)):
                    yield from self._of_proxy(named, Step(Word(own, self._word(type_).span)))
                    continue
                yield from self._of_list(named, [Step(self._word(node)), Step(self._word(type_), is_instance=True)])
            made = _initialized(named)
            if made is not None and type_ is not None and not is_uncertain(named):
                head = [Step(self._word(node)), Step(self._word(type_), Arguments(is_exact=False))]
                yield from self._of_variable(MODULES, head, *made)
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

    def dotted(self, proxy: str, methods: Collection[str], workers: Collection[str]) -> Iterator[Slip]:
        """The methods of a proxy of the worker that follow a dot, and not an arrow."""
        for node in self._nodes(proxy, 0, len(self._bytes)):
            start = self._start(node, proxy, workers)
            parent = start.parent if isinstance(start, Node) else None
            if parent is None or parent.type != "field_expression" or field(parent, "argument") != start:
                continue
            name = field(parent, "field")
            if text(field(parent, "operator")) == "." and text(name) in methods:
                yield Slip(ARROW, self._word(name), f"{proxy}->{text(name)}")

    def _of_proxy(self, named: Node, step: Step) -> Iterator[Chain]:
        """The chains that begin at variables and parameters whose type is a proxy, or a pointer to one, and at casts to
        it."""
        outer = _template_around(named)
        if outer is not None and outer.type == "template_function":
            call = outer.parent if outer.parent is not None else outer
            call = call.parent if call.type == "qualified_identifier" and call.parent is not None else call
            if text(field(outer, "name")) in _CASTS and call.type == "call_expression":
                steps, end = self._steps([step], call)
                yield from (Chain(WORKER, tuple(steps)) for _ in steps[1:2])
                yield from self._through_variable(WORKER, steps, end)
            return
        if outer is not None and text(field(outer, "name")) != "shared_ptr":
            return
        yield from self._declared(named if outer is None else outer, WORKER, [step])

    def _of_list(self, named: Node, head: list[Step]) -> Iterator[Chain]:
        """The chains that begin at variables and parameters that are lists of a type."""
        outer = _template_around(named)
        if outer is not None and outer.type == "template_type" and text(field(outer, "name")) in _LISTS:
            yield from self._declared(outer, MODULES, [*head, Step(Word("", head[0].word.span), makes="list")])

    def _declared(self, type_: Node, root: str, head: list[Step]) -> Iterator[Chain]:
        """The chains that begin at what is declared with a type."""
        while type_.parent is not None and type_.parent.type == "qualified_identifier":
            type_ = type_.parent  # `std::`
        declaration = type_.parent
        if declaration is None or declaration.type not in _DECLARING or field(declaration, "type") != type_:
            return
        for declarator in declaration.children_by_field_name("declarator"):
            if (name := _name(declarator)) is not None:
                yield from self._of_variable(root, head, name, declaration)
                if declaration.type == "for_range_loop":
                    return

    def members(self, workers: Collection[str]) -> Iterator[tuple[str, TypeName]]:
        """The members of the worker's classes that are of a type of a module, each with the type."""
        if b"RoboComp" not in self._bytes and b"::" not in self._bytes:
            return
        for node in of_types(self._tree.root_node, ("field_declaration",), IN_CLASSES):
            named = node.child_by_field_name("type")
            found = _NAMED.fullmatch(text(named)) if named is not None else None
            if named is None or found is None or class_around(node) not in workers or is_uncertain(node):
                continue
            start = named.start_byte + found.start(1)
            module = self._tree.root_node.descendant_for_byte_range(start, start + 1)
            for name in node.children_by_field_name("declarator"):
                if name.type == "field_identifier" and module is not None:
                    yield text(name), TypeName(self._word(module), Word(found[2], self._word(named).span))

    def of_member(self, name: str, root: str, head: list[Step], workers: Collection[str]) -> tuple[list[Chain], int]:
        """The chains that begin at a member of the worker, and how often the file declares its name."""
        found: list[Chain] = []
        declared = 0
        is_value = root == MODULES
        for node in self._nodes(name, 0, len(self._bytes)):
            start = self._start(node, name, workers)
            if isinstance(start, Occurrence):
                declared += start.is_declared
                continue
            steps, end = self._steps(head, start, is_value=is_value)
            found += (Chain(root, tuple(steps)) for _ in steps[len(head) : len(head) + 1])
            found += self._compared(root, steps, end)
            found += self._through_variable(root, steps, end)
        return found, declared

    def silent(self, names: Collection[str], workers: Collection[str]) -> Iterator[Word]:
        """The methods of the worker's classes among these that surely return nothing."""
        for node in of_types(self._tree.root_node, ("function_definition",), IN_CLASSES):
            declarator = node.child_by_field_name("declarator")
            while declarator is not None and declarator.type in ("pointer_declarator", "reference_declarator"):
                declarator = next(iter(declarator.named_children), None)
            name = declarator.child_by_field_name("declarator") if declarator is not None else None
            body = node.child_by_field_name("body")
            if name is not None and name.type == "qualified_identifier" and text(field(name, "scope")) in workers:
                name = field(name, "name")
            elif name is None or name.type != "field_identifier" or class_around(node) not in workers:
                continue
            if text(name) in names and body is not None and not is_uncertain(node) and _falls_off(body):
                yield self._word(name)

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


def _template_around(named: Node) -> Node | None:
    """The template whose only or first argument is this type."""
    descriptor = named.parent
    given = descriptor.parent if descriptor is not None and descriptor.type == "type_descriptor" else None
    if descriptor is None or given is None or given.type != "template_argument_list":
        return None
    is_first = given.named_children[0] == descriptor and len(descriptor.named_children) == 1
    return given.parent if is_first else None


def _initialized(type_: Node) -> tuple[Node, Node] | None:
    """The variable that a new value of a type initializes, as in `auto pose = RoboCompMouth::Pose{};`, and its
    declaration."""
    value = type_.parent
    if value is None or value.type not in ("call_expression", "compound_literal_expression"):
        return None
    if value.named_children[0] != type_ or value.parent is None or value.parent.type != "init_declarator":
        return None
    declaration, name = value.parent.parent, _name(value.parent)
    if declaration is None or declaration.type != "declaration" or name is None:
        return None
    declared = declaration.child_by_field_name("type")
    is_auto = declared is not None and declared.type == "placeholder_type_specifier"
    return (name, declaration) if is_auto and value.parent.child_by_field_name("value") == value else None


def _falls_off(node: Node) -> bool:
    """Whether a function surely reaches its end, and returns nothing."""
    if node.is_error or node.type.startswith(("preproc", "asm", "gnu_asm")):
        return False
    if node.type in _LEAVING or (node.type == "identifier" and _LEAVES.fullmatch(text(node))):
        return False
    if node.type in ("while_statement", "do_statement") and re.search(r"[(]\s*(true|1)\s*[)]", text(node)):
        return False
    if node.type == "for_statement" and node.child_by_field_name("condition") is None:
        return False
    return all(_falls_off(child) for child in node.named_children if child.type != "lambda_expression")


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
