"""A values document as the properties of `etc/config`, in their order, and as the text of that file."""

from __future__ import annotations

import os

from msgspec.structs import replace

from robocomp_yaml.diag.codes import values as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.model.build_interface import text
from robocomp_yaml.parameters.documents import LayeredValues
from robocomp_yaml.parameters.layers.effective import Effective
from robocomp_yaml.parameters.layers.settings import PREFIX, merged_entries, settings
from robocomp_yaml.parameters.types import Parameters
from robocomp_yaml.parameters.writing.sections import CLASSIC, FLAT_TOML, Property, Section, dialect, section_text
from robocomp_yaml.parameters.writing.write import Writer
from robocomp_yaml.semantics.spellings import quotes_texts
from robocomp_yaml.semantics.texts import unquoted
from robocomp_yaml.source.properties import VALUES_HEAD, unwritable
from robocomp_yaml.source.tree import Scalar

_TITLES = {
    "endpoints": "Where this component serves its interfaces", "proxies": "Where the components are that it requires",
    "topics": "Topics", "ice": "Ice", "properties": "Others",
}  # fmt: skip


def legacy_file(values: LayeredValues) -> str:
    """The legacy file that a migrated document is written to, or ''."""
    return text(values.document.root.get("legacy"), "file")


def properties(
    values: LayeredValues, effective: Effective, *, quoted: bool = False, beside: bool = False
) -> tuple[list[Section], list[Diagnostic]]:
    """The properties of a document and its layers, and the values that no property can hold. `quoted`: text is in
    quotes, as always in flat TOML. `beside`: they are for a file in the document's folder."""
    form = dialect(values)
    head = values.head
    quote = quoted or form == FLAT_TOML
    by_title: dict[str, list[Property]] = {}
    for one in settings(values, in_toml=form != CLASSIC):
        made = _property(one.key, one.node, quote and one.section != "properties")
        if made.value or one.path != PREFIX:  # an empty prefix is no prefix
            by_title.setdefault(_TITLES[one.section], []).append(made)
    sections = [Section(title, by_title.get(title, [])) for title in _TITLES.values()]
    unquotes = _seems_toml(effective.parameters, sections)
    folder = os.path.dirname(values.document.path) if beside else None
    writer = Writer(effective.parameters, head, bool(legacy_file(values)), quote, unquotes, folder)
    sections.insert(3, Section("Parameters", writer.write(effective.data, effective.merged)))
    faults = list(writer.faults)
    exact = {
        key: node.lexeme for key, node in merged_entries(values, "legacy", "exact").items() if isinstance(node, Scalar)
    }
    seen: dict[str, Property] = {}
    written = []
    for section in sections:
        kept = []
        for made in (_exact(one, exact.get(one.key)) for one in section.properties):
            problem = unwritable(made.key, made.value)
            if not problem and made.key in seen and seen[made.key].value != made.value:
                problem = "another value already uses this property"
            if problem:
                faults.append(codes.NOT_FOR_ICE.at(made.span or head, path=made.key, problem=problem))
            elif made.key not in seen:
                seen[made.key] = made
                kept.append(made)
        written += [replace(section, properties=kept)] if kept else []
    return written, faults


def _seems_toml(parameters: Parameters, sections: list[Section]) -> bool:
    """Whether components read the texts of the file as quoted, because of some of its keys."""
    spelled = [key for each in parameters.spellings for key in (each.key, each.count, *(key for _, key in each.fields))]
    own = [f"{member.name}." for member in parameters.root.members]
    others = [made.key for section in sections for made in section.properties]
    return quotes_texts((*spelled, *own, *others))


def property_text(sections: list[Section], name: str, source: str) -> str:
    """The text of `etc/config` of a component. `source` is the path of the values document, relative to the file."""
    head = f"# Configuration of {name}, {VALUES_HEAD} {source}: change it there, and compile again."
    return f"{head}\n{section_text(sections)}"


def _exact(made: Property, original: str | None) -> Property:
    """The property with its original spelling, if this still means the same value."""
    if original is None or original == made.value or made.read is None:
        return made
    try:
        same = made.read(original) == made.read(made.value)
    except (ValueError, KeyError):
        same = False
    return replace(made, value=original) if same else made


def _property(key: str, node: Scalar, quote: bool) -> Property:
    """`quote`: as in flat TOML, where text is in quotes and numbers are not."""
    value = node.lexeme
    if quote and isinstance(node.data, str) and '"' not in value:
        return Property(key, f'"{value}"', node.span, unquoted)
    return Property(key, value, node.span)
