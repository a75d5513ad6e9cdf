"""Messages of topics as Protobuf: a descriptor that is made from the types of IDSL, and both ways.

A message of `RoboCompArm.ArmEvents.moved` has the method's arguments as fields. Modules, topics and enums are messages
that only contain others, so that names stay as in the documents, and one file has all of them. Fields are numbered in
the order of the document. A list is a repeated field, a map a repeated field of entries with `key` and `value`; one
inside of another is wrapped in a message with the field `items`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from google.protobuf import descriptor_pb2, descriptor_pool, message_factory

from robocomp_yaml.wire.composites import MapOf, Members, SequenceOf, Struct
from robocomp_yaml.wire.interfaces import Operation, WireInterface
from robocomp_yaml.wire.values import Enumeration, WireType

_Proto = descriptor_pb2.FieldDescriptorProto
_PLAIN = {
    "bool": _Proto.TYPE_BOOL, "byte": _Proto.TYPE_UINT32, "short": _Proto.TYPE_INT32, "int": _Proto.TYPE_INT32,
    "long": _Proto.TYPE_INT64, "float": _Proto.TYPE_FLOAT, "double": _Proto.TYPE_DOUBLE, "string": _Proto.TYPE_STRING,
}  # fmt: skip
Convert = Callable[[Any], Any]


class MessageType:
    """The Protobuf message of an operation of a topic. `name` is its full name, `schema` the serialized descriptor."""

    def __init__(self, interface: WireInterface, operation: Operation) -> None:
        self.operation = operation
        self.name = f"{interface.id.removeprefix('::').replace('::', '.')}.{operation.name}"
        file = _ProtoFile(f"{self.name}.proto")
        file.message(self.name, operation.inputs)
        self.schema: bytes = descriptor_pb2.FileDescriptorSet(file=[file.proto]).SerializeToString(deterministic=True)
        pool = descriptor_pool.DescriptorPool()
        pool.Add(file.proto)

        def message_class(name: str) -> Any:
            return message_factory.GetMessageClass(pool.FindMessageTypeByName(name))

        self._class = message_class(self.name)
        converters = _Converters(message_class)
        members = operation.inputs
        self._out = [(name, converters.out(type_)) for name, type_ in members.types.items()]
        self._back = [(name, converters.back(type_)) for name, type_ in members.types.items()]

    def encode(self, values: tuple[Any, ...]) -> bytes:
        """The Ice values of a call as a serialized message."""
        fields = {name: out(value) for (name, out), value in zip(self._out, values, strict=True)}
        data: bytes = self._class(**fields).SerializeToString()
        return data

    def decode(self, data: bytes) -> tuple[Any, ...]:
        """The Ice values of a serialized message."""
        message = self._class.FromString(data)
        return tuple(back(getattr(message, name)) for name, back in self._back)


def _dotted(id_: str) -> str:
    return id_.removeprefix("::").replace("::", ".")


class _ProtoFile:
    """A file that is being made, with the types that its messages need."""

    def __init__(self, name: str) -> None:
        self.proto = descriptor_pb2.FileDescriptorProto(name=name, syntax="proto2")
        self._known: dict[str, Any] = {}

    def _place(self, name: str) -> Any:
        """The message of a full name, in those that contain it."""
        if name not in self._known:
            outer, _, own = name.rpartition(".")
            made = self._place(outer).nested_type.add() if outer else self.proto.message_type.add()
            made.name = own
            self._known[name] = made
        return self._known[name]

    def message(self, name: str, members: Members) -> None:
        made = self._place(name)
        for number, (field, type_) in enumerate(members.types.items(), 1):
            self._field(made, field, number, type_)

    def _field(self, made: Any, name: str, number: int, type_: WireType) -> None:
        field = made.field.add()
        field.name, field.number, field.label = name, number, _Proto.LABEL_OPTIONAL
        if _is_bytes(type_):
            field.type = _Proto.TYPE_BYTES
            return
        if isinstance(type_, (SequenceOf, MapOf)):
            field.label = _Proto.LABEL_REPEATED
            if isinstance(type_, MapOf):
                self._set_message(field, self._entry(type_))
                return
            type_ = type_.element
        if _is_collection(type_):
            self._set_message(field, self._wrapper(type_))
        elif isinstance(type_, Struct):
            name = _dotted(type_.id)
            if name not in self._known:
                self.message(name, type_.members)
            self._set_message(field, name)
        elif isinstance(type_, Enumeration):
            field.type, field.type_name = _Proto.TYPE_ENUM, f".{self._enum(type_)}"
        else:
            field.type = _PLAIN[type_.name]

    @staticmethod
    def _set_message(field: Any, name: str) -> None:
        field.type, field.type_name = _Proto.TYPE_MESSAGE, f".{name}"

    def _enum(self, type_: Enumeration) -> str:
        name = _dotted(type_.id)
        if name not in self._known:
            made = self._place(name).enum_type.add()
            made.name = "Value"
            for enumerator, value in type_.values.items():
                made.value.add(name=enumerator, number=value.value)
        return f"{name}.Value"

    def _entry(self, type_: MapOf) -> str:
        name = f"{_dotted(type_.id)}.Entry"
        if name not in self._known:
            made = self._place(name)
            self._field(made, "key", 1, type_.key_type)
            self._field(made, "value", 2, type_.value_type)
        return name

    def _wrapper(self, type_: WireType) -> str:
        assert isinstance(type_, (SequenceOf, MapOf))
        name = f"{_dotted(type_.id)}.List"
        if name not in self._known:
            self._field(self._place(name), "items", 1, type_)
        return name


def _is_bytes(type_: WireType) -> bool:
    return isinstance(type_, SequenceOf) and type_.element.name == "byte"


def _is_collection(type_: WireType) -> bool:
    return isinstance(type_, (SequenceOf, MapOf)) and not _is_bytes(type_)


def _same(value: Any) -> Any:
    return value


class _Converters:
    """Functions from Ice values to the values of fields, and back. `class_of` returns the class of a message."""

    def __init__(self, class_of: Callable[[str], Any]) -> None:
        self._class_of = class_of

    def out(self, type_: WireType) -> Convert:
        if _is_bytes(type_):
            return bytes
        if isinstance(type_, SequenceOf):
            inner = self._element_out(type_.element)
            return list if inner is _same else lambda value: [inner(item) for item in value]
        if isinstance(type_, MapOf):
            entry = self._class_of(f"{_dotted(type_.id)}.Entry")
            key, inner = self.out(type_.key_type), self.out(type_.value_type)
            return lambda value: [entry(key=key(k), value=inner(v)) for k, v in value.items()]
        if isinstance(type_, Struct):
            made = self._class_of(_dotted(type_.id))
            members = type_.members
            rows = [(name, members.attributes[name], self.out(one)) for name, one in members.types.items()]
            return lambda value: made(**{name: convert(getattr(value, own)) for name, own, convert in rows})
        return (lambda value: value.value) if isinstance(type_, Enumeration) else _same

    def _element_out(self, type_: WireType) -> Convert:
        """An element of a list: another collection is wrapped."""
        inner = self.out(type_)
        if not _is_collection(type_):
            return inner
        wrapper = self._class_of(f"{_dotted(type_.id)}.List")  # type: ignore[attr-defined]
        return lambda value: wrapper(items=inner(value))

    def back(self, type_: WireType) -> Convert:
        if _is_bytes(type_):
            return _same
        if isinstance(type_, SequenceOf):
            inner, is_wrapped = self.back(type_.element), _is_collection(type_.element)
            return lambda value: [inner(item.items if is_wrapped else item) for item in value]
        if isinstance(type_, MapOf):
            key, inner = self.back(type_.key_type), self.back(type_.value_type)
            return lambda value: {key(item.key): inner(item.value) for item in value}
        if isinstance(type_, Struct):
            return self._struct_back(type_)
        if isinstance(type_, Enumeration):
            by_number = {value.value: value for value in type_.values.values()}
            return lambda value: by_number[value]
        return _same

    def _struct_back(self, type_: Struct) -> Convert:
        members = type_.members
        rows = [(name, members.attributes[name], self.back(one)) for name, one in members.types.items()]

        def back(value: Any) -> Any:
            made = type_.kind()
            for name, own, convert in rows:
                setattr(made, own, convert(getattr(value, name)))
            return made

        return back
