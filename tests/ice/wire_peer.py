"""The other side of test_wire.py, with the code that Ice generates: a servant, or a client of one.

python wire_peer.py FOLDER            serves; prints its proxy
python wire_peer.py FOLDER PROXY      calls; prints what came back, as JSON
"""

from __future__ import annotations

import json
import sys
from typing import Any

import Ice


def main(folder: str, proxy: str = "") -> None:
    Ice.loadSlice(f"--all -I{folder} {folder}/Wire.ice")
    generated: Any = sys.modules["WireModule"]
    with Ice.initialize() as communicator:
        if proxy:
            print(json.dumps(called(generated, communicator.stringToProxy(proxy))))
            return
        adapter = communicator.createObjectAdapterWithEndpoints("", "tcp -h 127.0.0.1 -p 0")

        class Servant(generated.Wire):  # type: ignore[misc]
            def echo(self, value: Any, times: int, current: Any) -> tuple[str, Any, int]:
                return str(times), value, 1

            def fail(self, why: str, current: Any) -> None:
                raise generated.Jammed(why=why)

        print(adapter.addWithUUID(Servant()), flush=True)
        adapter.activate()
        sys.stdin.read()


def called(generated: Any, proxy: Any) -> dict[str, object]:
    wire = generated.WirePrx.checkedCast(proxy)
    results: dict[str, object] = {"is one": wire is not None}
    try:
        wire.fail("now")
    except generated.Jammed as jammed:
        results["jammed"] = [jammed.where.row, str(jammed.where.side), jammed.why]
    results["def"] = list(wire._def())
    results["silent"] = wire.silent()
    place = sys.modules["WireOthers"].Place(1)
    value = generated.All(text="hällo", grid=[[place]], byName={"": b"\x01\xff"})
    returned, same, counted = wire.echo(value, 3)
    results["echo"] = [returned, same.text, same.grid == [[place]], list(same.byName[""]), counted]
    return results


if __name__ == "__main__":
    main(*sys.argv[1:])
