"""Real interfaces in C++: every operation as slice2cpp declares it; a sample is compiled by g++."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest
from click.testing import CliRunner

from conftest import CORPUS, needs_corpus
from cpp_programs import needs_cpp
from robocomp_yaml import resources
from robocomp_yaml.cli import group
from robocomp_yaml.diag.diagnostic import ERROR
from robocomp_yaml.emit import slice as slice_target
from robocomp_yaml.emit.component import of_language
from robocomp_yaml.languages.cpp.ports import port_views
from robocomp_yaml.link.program import LinkedComponent, LinkedModule, Port
from robocomp_yaml.model.component import Component, Language, Use
from robocomp_yaml.pipeline import analyse

OPERATION = re.compile(r"^    virtual (\S.*) (\w+)\((.*)const ::Ice::Current& \w+\) = 0;$", re.MULTILINE)
SAMPLE = 6 if "RCYAML_ALL_BUILDS" in os.environ else 3


@pytest.fixture(scope="module")
def modules(tmp_path_factory: pytest.TempPathFactory) -> list[LinkedModule]:
    """The interfaces of the corpus without errors, by name."""
    folder = tmp_path_factory.mktemp("yaml")
    CliRunner().invoke(group, ["migrate", str(CORPUS / "idsl"), "-o", str(folder)])
    analysis = analyse([str(folder)])
    broken = {Path(d.span.file).resolve() for d in analysis.diagnostics if d.severity == ERROR}
    whole = [
        linked for linked in analysis.program.modules.values()
        if not any(Path(scope.module.path).resolve() in broken or scope.unresolved for scope in linked.closure())
    ]  # fmt: skip
    assert len(whole) > 100
    return sorted(whole, key=lambda linked: linked.module.path)


def component(linked: LinkedModule) -> LinkedComponent:
    """Implements, requires, publishes and subscribes everything in the module."""
    ports = tuple(Port(Use(i.name, i.name), i, linked) for i in linked.module.all_interfaces)
    topics = tuple(port for port in ports if any(m.can_be_published for m in port.interface.methods))
    return LinkedComponent(
        Component("Sample", "sample.cdsl.yaml", Language("cpp")), [linked], ports, ports, topics, topics
    )


def compile_slice(modules: list[LinkedModule], folder: Path) -> None:
    files = {slice_target.file_name(linked): slice_target.text(linked) for linked in modules}
    for name, text in {**files, "CommonBehavior.ice": resources.text("templates/slice/CommonBehavior.ice")}.items():
        (folder / name).write_text(text, encoding="utf-8")
    names = sorted(file.name for file in folder.glob("*.ice"))
    command = ["slice2cpp", "-I.", "--header-ext", "ice.h", "--source-ext", "ice.cpp", *names]
    subprocess.run(command, cwd=folder, check=True)


def plain(declaration: str, own: str) -> str:
    """Without names of parameters, and without the names of the own module and the global scope."""
    flat = re.sub(r"\(\s+", "(", re.sub(r"\s+", " ", declaration))
    head, _, rest = flat.partition("(")
    types = [re.sub(r"(?<=[&\w]) \w+$", "", word) for word in rest.split(", ") if word]
    types = [re.sub(r"^long long$", "long long int", word) for word in types]
    spelled = re.sub(r"(?<!\w)::", "", f"{head}({', '.join(types)})")
    return re.sub(rf"\b{own}::", "", spelled)


def operations(header: str, own: str) -> Iterator[str]:
    """The operations of the C++11 mapping, in the order of the file."""
    for returns, name, parameters in OPERATION.findall(header.partition("#else // C++98 mapping")[0]):
        yield plain(f"{returns} {name}({parameters.removesuffix(', ')}", own)


@needs_corpus
@pytest.mark.skipif(
    shutil.which("slice2cpp") is None, reason="slice2cpp is not installed (Debian: zeroc-ice-compilers)"
)
def test_every_operation_is_declared_as_ice_declares_it(modules: list[LinkedModule], tmp_path: Path) -> None:
    compile_slice(modules, tmp_path)
    checked = 0
    for linked in modules:
        module = linked.module
        header = (tmp_path / f"{slice_target.file_name(linked)}.h").read_text(encoding="utf-8")
        expected = sorted(operations(header, module.name))
        services = port_views(component(linked)).implements
        got = [operation.declaration for service in services for operation in service.operations]
        ours = [re.sub(r"(, )?\s*const Ice::Current&\) override$", "", text).rstrip(",") for text in got]
        assert sorted(plain(text, module.name) for text in ours) == expected, module.path
        for proxy in {accessor.proxy for accessor in port_views(component(linked)).requires}:
            assert f"class {proxy.rpartition('::')[2]};" in header
        checked += len(expected)
    assert checked == sum(len(i.methods) for m in modules for i in m.module.all_interfaces) > 400


@needs_corpus
@pytest.mark.slow
@needs_cpp
def test_a_sample_compiles(modules: list[LinkedModule], tmp_path: Path) -> None:
    compile_slice(modules, tmp_path)
    flags = ["-std=c++17", "-DICE_CPP11_MAPPING", "-Wall", "-Wextra", "-Werror", "-fsyntax-only"]
    big = sorted((m for m in modules if m.module.all_interfaces), key=lambda linked: len(slice_target.text(linked)))
    for linked in big[:: len(big) // SAMPLE][:SAMPLE]:
        folder = tmp_path / linked.module.stem
        for file in of_language(component(linked)):
            (folder / file.path).parent.mkdir(parents=True, exist_ok=True)
            (folder / file.path).write_text(file.text, encoding="utf-8")
        sources = ("generated/genericworker.cpp", "src/specificworker.cpp", "generated/main.cpp")
        (folder / "all.cpp").write_text("".join(f'#include "{source}"\n' for source in sources))
        folders = ["-I.", "-Igenerated", "-Isrc", "-isystem", str(tmp_path)]
        done = subprocess.run(["g++", *flags, *folders, "all.cpp"], cwd=folder, capture_output=True, text=True)
        assert done.returncode == 0, f"{linked.module.path}:\n{done.stderr[:3000]}"
