"""The parameters of `period`, which each component has."""

from __future__ import annotations

from msgspec.structs import replace

from robocomp_yaml.diag.codes import pdsl as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.span import Span
from robocomp_yaml.parameters.defaults import EMERGENCY, PERIOD
from robocomp_yaml.parameters.types import BasicType, Bound, Default, Parameters, Range, RecordType, ResolvedMember

_PERIODS = {
    "compute": "How often compute() runs.",
    "emergency": "The period of RoboComp's emergency(); in other components, for their own code.",
}


def of_no_document(period: int | None) -> Parameters:
    """The parameters of a component without a parameters document."""
    return Parameters(with_period(RecordType("", ()), period)[0])


def with_period(root: RecordType, period: int | None) -> tuple[RecordType, list[Diagnostic]]:
    """The parameters with `period.compute` and `period.emergency`, unless the document defines them, and the
    problems."""
    defined = root.member("period")
    if defined is not None and not defined.is_group:
        problem = "'period' must be the group of the worker's periods"
        hint = "write period: {group: {compute: …}}, or rename the parameter"
        return root, [codes.PERIOD.at(defined.span, problem=problem, hint=hint)]
    found: list[Diagnostic] = []
    own = defined.type.members if defined is not None and isinstance(defined.type, RecordType) else ()
    by_name = {member.name: member for member in own}
    for name in _PERIODS:
        member = by_name.get(name)
        if member is not None and not (isinstance(member.type, BasicType) and member.type.name == "int"):
            problem = f"'period.{name}' must be a whole number of milliseconds: int"
            found.append(codes.PERIOD.at(member.span, problem=problem))
    compute = by_name.get("compute") or _period("compute", period or PERIOD)
    if compute.default is None and not compute.optional:
        compute = replace(compute, default=Default(period or PERIOD))
    elif period is not None and compute.default is not None and compute.default.data != period:
        if (node := compute.default.node) is not None:
            problem, hint = f"the component's 'period:' is {period} ms", "remove one of the two"
            found.append(codes.PERIOD.at(node.span, problem=problem, hint=hint))
    emergency = by_name.get("emergency") or _period("emergency", EMERGENCY)
    others = [member for member in own if member.name not in _PERIODS]
    group = RecordType("", (compute, emergency, *others), "How often the component works.")
    doc, span = (defined.doc, defined.span) if defined is not None else (group.doc, Span(""))
    made = ResolvedMember("period", group, doc, code_name="period", editable=True, span=span)
    rest = [other for other in root.members if other.name != "period"]
    return replace(root, members=(*rest, made)), found


def _period(name: str, default: int) -> ResolvedMember:
    type_ = BasicType("int", Range(Bound(1, False, "1"), None), unit="ms")
    return ResolvedMember(name, type_, _PERIODS[name], Default(default), editable=True, code_name=name)
