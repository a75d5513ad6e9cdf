"""A client that calls an operation of CommonBehavior, as a program of anybody could:
`control_client.py SLICE PROXY OPERATION [TOKEN [PROPERTY=VALUE]…]`. It prints what came of that in a line."""

from __future__ import annotations

import sys

import Ice


def main(slice_file: str, proxy: str, operation: str, token: str = "", *properties: str) -> None:
    data = Ice.InitializationData()
    data.properties = Ice.createProperties()
    for key, value in {
        "Ice.Override.ConnectTimeout": "2000", "Ice.Default.InvocationTimeout": "8000", "Ice.RetryIntervals": "-1",
        **dict(one.split("=", 1) for one in properties),
    }.items():  # fmt: skip
        data.properties.setProperty(key, value)
    with Ice.initialize(data) as communicator:
        Ice.loadSlice("", ["--all", slice_file])
        module = sys.modules["RoboCompCommonBehavior"]
        behavior = module.CommonBehaviorPrx.uncheckedCast(communicator.stringToProxy(proxy))
        arguments = {"setPeriod": [70], "setParameterList": [{}]}.get(operation, [])
        context = {"rcyaml.token": token} if token else None
        try:
            answer = getattr(behavior, operation)(*arguments, context)
            print("ok", answer if isinstance(answer, (int, str)) else type(answer).__name__)
        except Ice.UnknownException as error:
            print("rejected", error.unknown)
        except Ice.Exception as error:
            print("failed", type(error).__name__)


if __name__ == "__main__":
    main(*sys.argv[1:])
