"""The command `rcyaml`, which is `python -m robocomp_yaml` too: until all is imported, signals just end it."""

from __future__ import annotations

import os
import signal


def main() -> None:
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, lambda number, _: os._exit(128 + number))
    from robocomp_yaml.cli import main as run

    run()


if __name__ == "__main__":
    main()
