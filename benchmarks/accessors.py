"""The time for reading and setting a parameter while a component runs, in Python and in C++.

    python benchmarks/accessors.py

The component is compiled from the document below. Python is compared with a plain attribute; C++ (-O2) is measured in
nanoseconds, with and without another thread that sets a parameter a thousand times a second.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

DOCUMENTS = {
    "x.pdsl.yaml": """\
component: x.cdsl.yaml
types:
  Motor: {struct: {name: string, vel: {type: float, range: [0, 2], default: 0.9}}}
parameters:
  speed: {type: int, range: [0, 1000000], default: 1, editable: true}
  device: {type: string, default: /dev/ttyUSB0}
  motors: {list: Motor, default: [{name: a}, {name: b}]}
""",
    "x.cdsl.yaml": "component: X\nlanguage: {language}\nparameters: x.pdsl.yaml\n",
}
PYTHON = """
import sys, timeit
sys.path.insert(0, sys.argv[1])
from generated.parameters import TABLE, Parameters
from generated.runtime.parameters import Store

class Plain:
    pass

worker, plain = Plain(), Plain()
plain.speed, worker.parameters, worker.plain = 1, Parameters(Store(TABLE, {}, {})), plain
plain.motors = [plain]
codes = {
    "a plain attribute": "worker.plain.speed",
    "a parameter": "worker.parameters.speed",
    "a plain object's in a list": "worker.plain.motors[0].speed",
    "a record's in a list": "worker.parameters.motors[0].vel",
}
best = dict.fromkeys(codes, 1e9)
for _ in range(100):  # in turn, so that other load of the machine affects all alike
    for name, code in codes.items():
        best[name] = min(best[name], timeit.timeit(code, globals=globals(), number=30_000) / 30_000 * 1e9)
floors = [taken for name, taken in best.items() if "plain" in name for _ in "12"]
for (name, taken), floor in zip(best.items(), floors):
    print(f"Python  {name:<42} {taken:8.1f} ns  {taken / floor:5.2f} times")
taken = min(timeit.repeat("p.set('speed', p.speed + 1)", globals={"p": worker.parameters}, number=500, repeat=5)) / 500
print(f"Python  {'setting a parameter':<42} {taken * 1e9:8.0f} ns")
"""
CPP = """
#include "parameters.h"

#include "runtime/log.h"

#include <chrono>
#include <iomanip>
#include <iostream>
#include <thread>

namespace runtime
{
Log::Log(std::string name) : name_(std::move(name))
{
}
void Log::error(const std::string&) const
{
}
}

volatile long long sink = 0;

template <typename Read>
void measure(const char* what, int times, const Read& read)
{
    double best = 1e9;
    for (int round = 0; round < 7; ++round)
    {
        const auto begin = std::chrono::steady_clock::now();
        for (int time = 0; time < times; ++time)
        {
            sink = sink + read();
        }
        const std::chrono::duration<double, std::nano> taken = std::chrono::steady_clock::now() - begin;
        best = std::min(best, taken.count() / times);
    }
    std::cout << "C++     " << std::left << std::setw(42) << what << " " << std::right << std::setw(8) << std::fixed
              << std::setprecision(1) << best << " ns" << std::endl;
}

int main()
{
    runtime::Store store(parameters::table());
    Parameters parameters(store);
    store.load({}, {});
    volatile int plain = 1;
    const int times = 5'000'000;
    const auto all = [&]
    {
        measure("a parameter: speed()", times, [&] { return parameters.speed(); });
        measure("a text: device()", times, [&] { return parameters.device().size(); });
        measure("a list: motors()[0].vel", times, [&] { return parameters.motors()[0].vel > 0; });
        measure("all at one moment: now()->speed", times, [&] { return parameters.now()->speed; });
    };
    measure("a plain variable", times, [&] { return plain; });
    all();
    std::atomic<bool> stop{false};
    std::thread setter(
        [&]
        {
            for (int n = 0; !stop; ++n)
            {
                parameters.setSpeed(n % 1000);
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            }
        });
    std::cout << "while another thread sets one every millisecond:" << std::endl;
    all();
    stop = true;
    setter.join();
    int n = 0;
    measure("setting a parameter: setSpeed(…)", 2000, [&] { parameters.setSpeed(++n % 100); return 1; });
}
"""


def compiled(folder: Path, language: str) -> Path:
    folder.mkdir()
    for name, text in DOCUMENTS.items():
        (folder / name).write_text(text.replace("{language}", language), encoding="utf-8")
    subprocess.run([Path(sys.executable).with_name("rcyaml"), "-q", "compile", folder], check=True)
    return folder


def main() -> None:
    with tempfile.TemporaryDirectory() as name:
        python = compiled(Path(name) / "python", "python")
        subprocess.run([sys.executable, "-c", PYTHON, python], check=True)
        if shutil.which("g++") is None:
            sys.exit("g++ is not installed: C++ was not measured")
        cpp = compiled(Path(name) / "cpp", "cpp") / "generated"
        sources = ["kinds", "texts", "references", "secrecy", "reading", "editing", "store"]  # what needs no Ice
        text = "".join(f'#include "{cpp}/runtime/{source}.cpp"\n' for source in sources)
        (cpp / "bench.cpp").write_text(f'{text}#include "parameters.cpp"\n{CPP}', encoding="utf-8")
        program = str(cpp / "bench")
        command = ["g++", "-std=c++17", "-O2", "-pthread", "-I", cpp, "-o", program, cpp / "bench.cpp"]
        subprocess.run(command, check=True)
        subprocess.run([program], check=True)


if __name__ == "__main__":
    main()
