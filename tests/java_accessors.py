"""Generated accessors of Java: as those of C++, one program that judges and reads values with them."""

from __future__ import annotations

import subprocess
from pathlib import Path

from conftest import ROOT
from cpp_accessors import Program as CppProgram
from robocomp_yaml.languages import language
from robocomp_yaml.languages.java import parameters as java_parameters
from robocomp_yaml.parameters.types import Parameters

DRIVER = ROOT / "tests" / "java_driver" / "Driver.java"


class Program(CppProgram):
    def __init__(self, folder: Path, parameters: Parameters) -> None:
        (folder / "generated").mkdir()
        text = java_parameters.text(parameters, "Driver", "x.pdsl.yaml")
        (folder / "generated" / "Parameters.java").write_text(text, encoding="utf-8")
        (folder / "generated" / "runtime").symlink_to(language("java").templates / "runtime")
        jars = ":".join(map(str, Path("/usr/share/java").glob("ice*-3.7*.jar")))
        command = [
            "javac",
            "-encoding",
            "UTF-8",
            "-cp",
            jars,
            "-sourcepath",
            str(folder),
            "-d",
            str(folder / "classes"),
        ]
        done = subprocess.run([*command, str(DRIVER)], capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        self.command = ["java", "-cp", f"{folder / 'classes'}:{jars}", "generated.runtime.Driver"]
