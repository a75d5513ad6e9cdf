"""Where one file of C++ uses a name of the worker: `mouth_proxy->move(pose)`, `this->parameters.speed()`."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from functools import cached_property

import msgspec
from tree_sitter import Node, Tree

from robocomp_yaml.diag.span import Span
from robocomp_yaml.emit.specific.code import field, lines_of, location, text
from robocomp_yaml.emit.usage.code import MODULES, WORKER, Arguments, Chain, Constant, Step, Word
from robocomp_yaml.languages.cpp.code import parse

# Where an identifier is used. Everywhere else, it is declared.
_USES = frozenset(
    """argument_list assignment_expression binary_expression call_expression case_statement cast_expression
    comma_expression compound_literal_expression condition_clause conditional_expression co_await_expression
    delete_expression expression_statement field_expression for_range_loop for_statement if_statement
    initializer_list initializer_pair lambda_capture_specifier new_declarator parenthesized_expression
    pointer_expression qualified_identifier return_statement sizeof_expression subscript_argument_list
    subscript_expression switch_statement throw_statement unary_expression update_expression while_statement
    field_initializer co_return_statement co_yield_statement decltype""".split()
)
_TEXTS = ("comment", "preproc_arg", "raw_string_content", "string_content", "string_literal", "system_lib_string")
_INITIALIZERS = ("init_declarator", "optional_parameter_declaration", "lambda_capture_initializer", "declaration")
_MACRO = re.compile(r"[A-Z][A-Z0-9_]+\Z")


class Occurrence(msgspec.Struct, frozen=True):
    """A name in the code: declared there, or used in a chain, or neither, if it has another meaning or is not sure."""

    is_declared: bool = False
    chain: Chain | None = None


_OTHER, _DECLARED = Occurrence(), Occurrence(is_declared=True)


class CppFile:
    def __init__(self, path: str, source: str) -> None:
        self.path, self._source = path, source
        self._bytes = source.encode()

    @cached_property
    def _tree(self) -> Tree:
        return parse(self._source)

    @cached_property
    def _lines(self) -> list[str]:
        return lines_of(self._source)

    def classes(self) -> Iterator[tuple[str, list[str]]]:
        """The classes with their bases."""
        if b"class" not in self._bytes and b"struct" not in self._bytes:
            return
        for node in _of_types(self._tree.root_node, ("class_specifier", "struct_specifier"), _IN_SCOPES):
            if node.child_by_field_name("body") is not None:
                clause = next((child for child in node.children if child.type == "base_class_clause"), None)
                bases = [one for one in clause.named_children if one.type != "access_specifier"] if clause else []
                yield text(field(node, "name")), [text(base).rpartition("::")[2] for base in bases]

    def methods(self, workers: Collection[str]) -> Iterator[Word]:
        """The names of the methods that the worker's classes declare and define."""
        for node in _of_types(self._tree.root_node, ("function_declarator",), _IN_CLASSES):
            name = node.child_by_field_name("declarator")
            if name is None:
                continue
            if name.type == "qualified_identifier" and text(field(name, "scope")) in workers:
                name = field(name, "name")
            elif name.type != "field_identifier" or _class_around(node) not in workers:
                continue
            if name.type in ("identifier", "field_identifier"):
                yield self._word(name)

    def occurrences(self, name: str, workers: Collection[str]) -> Iterator[Occurrence]:
        """All occurrences of a name, also through variables that it initializes."""
        for node in self._nodes(name, 0, len(self._bytes)):
            start = self._start(node, name, workers)
            if isinstance(start, Occurrence):
                yield start
                continue
            steps, end = self._steps([Step(self._word(node))], start)
            yield Occurrence(chain=Chain(WORKER, tuple(steps)))
            for chain in self._through_variable(steps, end):
                yield Occurrence(chain=chain)

    def qualified(self, module: str) -> Iterator[Chain]:
        """The names in a Slice module: `RoboCompMouth::Shape::round`."""
        if module.encode() not in self._bytes:
            return
        for node in self._nodes(module, 0, len(self._bytes)):
            parent = node.parent
            is_scope = (
                parent is not None and parent.type == "qualified_identifier" and node.type == "namespace_identifier"
            )
            if not is_scope or parent is None or parent.child_by_field_name("scope") != node or _is_uncertain(node):
                continue
            if parent.parent is not None and parent.parent.type == "qualified_identifier":
                if parent.parent.child_by_field_name("scope") != parent and _has_scope(parent.parent):
                    continue  # the module of another namespace
            steps, now = [Step(self._word(node))], parent.child_by_field_name("name")
            while now is not None and now.type == "qualified_identifier":
                if (scope := now.child_by_field_name("scope")) is None or "identifier" not in scope.type:
                    break
                steps.append(Step(self._word(scope)))
                now = now.child_by_field_name("name")
            if now is not None and now.type in ("identifier", "type_identifier"):
                steps.append(Step(self._word(now)))
            yield Chain(MODULES, tuple(steps))

    def _nodes(self, name: str, start: int, end: int) -> Iterator[Node]:
        """The nodes between two positions in bytes that are this word, except in comments and texts."""
        for found in re.compile(rb"\b%s\b" % re.escape(name.encode())).finditer(self._bytes, start, end):
            node = self._tree.root_node.descendant_for_byte_range(found.start(), found.end())
            if node is not None and node.type not in _TEXTS:
                yield node

    def _start(self, node: Node, name: str, workers: Collection[str]) -> Node | Occurrence:
        """The node at which a chain begins, if the word is a use of the worker."""
        parent = node.parent
        if parent is None or text(node) != name or node.type not in ("identifier", "field_identifier"):
            return _DECLARED
        start = node
        if parent.type == "field_expression" and node.type == "field_identifier":
            owner = parent.child_by_field_name("argument")
            if owner is None or owner.type != "this":
                return _OTHER  # that of another object
            start = parent
        elif node.type == "field_identifier" or not _is_used(node, parent):
            return _DECLARED
        if _is_uncertain(start) or _worker_around(start) not in workers:
            return _OTHER
        return start

    def _steps(self, head: list[Step], start: Node) -> tuple[list[Step], Node]:
        """The steps of a chain that begins with some at a node, and the node at which it ends."""
        steps, now = list(head), start
        while (parent := now.parent) is not None:
            if parent.type == "field_expression" and parent.child_by_field_name("argument") == now:
                name = parent.child_by_field_name("field")
                operator = text(field(parent, "operator"))
                if name is None or name.type != "field_identifier" or not _is_followed(steps, operator):
                    break
                steps.append(Step(self._word(name)))
            elif parent.type == "call_expression" and parent.child_by_field_name("function") == now:
                if steps[-1].is_index or steps[-1].arguments is not None:
                    break
                steps[-1] = msgspec.structs.replace(steps[-1], arguments=self._arguments(parent))
            elif parent.type == "subscript_expression" and parent.child_by_field_name("argument") == now:
                steps.append(Step(Word("", Span(self.path)), is_index=True))
            elif parent.type != "parenthesized_expression":
                break
            now = parent
        return steps, now

    def _through_variable(self, steps: list[Step], end: Node) -> Iterator[Chain]:
        """The chains that begin at a local variable, if a chain initializes it, and no other of its name is near."""
        parent = end.parent
        if parent is not None and parent.type == "init_declarator" and parent.child_by_field_name("value") == end:
            declaration = parent.parent
        elif parent is not None and parent.type == "for_range_loop" and parent.child_by_field_name("right") == end:
            declaration, steps = parent, [*steps, Step(Word("", Span(self.path)), is_index=True)]
        else:
            return
        if declaration is None or field(declaration, "type").type != "placeholder_type_specifier":
            return
        declarator = parent.child_by_field_name("declarator")
        while declarator is not None and declarator.type == "reference_declarator":
            declarator = declarator.named_children[-1]
        function = _function_around(end)
        if declarator is None or declarator.type != "identifier" or function is None:
            return
        uses = []
        for node in self._nodes(text(declarator), function.start_byte, function.end_byte):
            if node.type == "identifier" and node != declarator:
                if node.parent is None or not _is_used(node, node.parent):
                    return
                uses.append(node)
        for node in uses:
            longer, _ = self._steps(steps, node)
            if len(longer) > len(steps) and not _is_uncertain(node):
                yield Chain(WORKER, tuple(longer))

    def _arguments(self, call: Node) -> Arguments:
        given = call.child_by_field_name("arguments")
        if given is None or given.type != "argument_list":
            return Arguments(is_exact=False)
        nodes = [node for node in given.named_children if node.type != "comment"]
        is_exact = not given.has_error and not any(
            node.type == "parameter_pack_expansion" or _MACRO.match(text(_called(node))) for node in nodes
        )
        first = self._literal(nodes[0]) if nodes else None
        last = self._literal(nodes[-1]) if nodes else None
        word = None
        if first is not None and isinstance(first.value, str):
            span = first.span
            word = Word(first.value, Span(self.path, span.line, span.column + 1, span.line, span.end_column - 1))
        constant = last if last is not None and (word is None or len(nodes) > 1) else None
        return Arguments(len(nodes), (), is_exact, word, (), constant)

    def _literal(self, node: Node) -> Constant | None:
        """A literal number, text or truth value."""
        written = text(node)
        value: str | int | float | None = None
        if node.type == "number_literal" or (node.type == "unary_expression" and re.match(r"-\s*[\d.]", written)):
            number = re.fullmatch(r"(-?)\s*(\d+|\d*\.\d+|\d+\.\d*)([fFlL]*)", written)
            if number:
                is_whole = number[2].isdigit() and "f" not in number[3].lower()
                value = (int if is_whole else float)(number[1] + number[2])
                if number[2].startswith("0") and number[2].isdigit() and number[2] != "0":
                    return None  # octal
        elif node.type in ("true", "false"):
            value = node.type == "true"
        elif node.type == "string_literal" and "\\" not in written and written[:1] == '"':
            value = written[1:-1]
        if value is None or node.start_point[0] != node.end_point[0]:
            return None
        return Constant(value, self._word(node).span)

    def _word(self, node: Node) -> Word:
        return Word(text(node), msgspec.structs.replace(location(node, self._lines), file=self.path))


def _is_used(node: Node, parent: Node) -> bool:
    if parent.type in (
        "init_declarator",
        "optional_parameter_declaration",
        "lambda_capture_initializer",
        "declaration",
    ):
        value = parent.child_by_field_name("value") or parent.child_by_field_name("default_value")
        if parent.type == "lambda_capture_initializer":
            value = parent.child_by_field_name("right")
        return value == node
    if parent.type == "for_range_loop":
        return parent.child_by_field_name("right") == node
    if parent.type == "qualified_identifier":
        return False
    return parent.type in _USES


def _is_followed(steps: list[Step], operator: str) -> bool:
    """Whether the operator leads to what is offered. A proxy is a shared pointer, and a part of the parameters a
    handle: after a dot come their own methods."""
    first, last = steps[0].word.text, steps[-1]
    if len(steps) == 1 and last.arguments is None:
        is_value = first in ("parameters", "events", "statemachine")
        return operator == ("." if is_value else "->")
    if last.is_index:
        return operator == "."
    return operator == "->" if last.arguments is not None else operator == "."


def _is_uncertain(node: Node) -> bool:
    """Whether a node is in code that may mean something else, or nothing."""
    now: Node | None = node
    while now is not None:
        if now.is_error or now.type == "template_declaration":
            return True
        if now.type.startswith("preproc") and not _is_guard(now):
            return True
        if now.has_error and now.type.endswith(("statement", "declaration", "declarator", "expression", "list")):
            if now.type not in ("compound_statement", "declaration_list", "field_declaration_list"):
                return True
        now = now.parent
    return False


def _is_guard(node: Node) -> bool:
    """Whether a condition of the preprocessor is the guard of a header."""
    if node.type != "preproc_ifdef" or not node.children or text(node.children[0]) != "#ifndef":
        return False
    name = text(field(node, "name"))
    defined = next((child for child in node.named_children if child.type == "preproc_def"), None)
    return defined is not None and text(field(defined, "name")) == name


def _worker_around(node: Node) -> str:
    """The class whose method contains a node, '' for other code."""
    now: Node | None = node
    outer = ""
    while now is not None:
        if now.type == "function_definition":
            declarator = now.child_by_field_name("declarator")
            while declarator is not None and declarator.type != "function_declarator":
                declarator = next((one for one in declarator.named_children if "declarator" in one.type), None)
            name = declarator.child_by_field_name("declarator") if declarator is not None else None
            if name is not None and name.type == "qualified_identifier":
                return text(field(name, "scope"))
            outer = "in a class"
        elif now.type in ("class_specifier", "struct_specifier"):
            return text(field(now, "name")) if outer else ""
        now = now.parent
    return ""


def _has_scope(node: Node) -> bool:
    """Whether a qualified name begins with a namespace, not with `::`."""
    return node.child_by_field_name("scope") is not None


def _function_around(node: Node) -> Node | None:
    now: Node | None = node
    while now is not None and now.type != "function_definition":
        now = now.parent
    return now


def _class_around(node: Node) -> str:
    now: Node | None = node
    while now is not None:
        if now.type in ("class_specifier", "struct_specifier"):
            return text(field(now, "name"))
        now = now.parent
    return ""


def _called(node: Node) -> Node:
    """The name of a called function, or the node itself."""
    return field(node, "function") if node.type == "call_expression" else node


_IN_SCOPES = frozenset(
    """translation_unit namespace_definition declaration_list declaration preproc_ifdef preproc_if
    linkage_specification""".split()
)
_IN_CLASSES = _IN_SCOPES | frozenset(
    """class_specifier struct_specifier field_declaration_list field_declaration declaration function_definition
    pointer_declarator reference_declarator""".split()
)


def _of_types(root: Node, types: Collection[str], scopes: Collection[str]) -> Iterator[Node]:
    """The nodes of these types in the scopes, in order."""
    todo = [root]
    while todo:
        node = todo.pop()
        if node.type in types:
            yield node
        if node.type in scopes:
            todo += reversed(node.named_children)
