"""The command `rcyaml`, also `python -m robocomp_yaml`. Until all modules are imported, a signal ends the process at
once."""

from __future__ import annotations

import os
import signal

from robocomp_yaml.garbage import collect_seldom


def main() -> None:
    for number in (signal.SIGINT, signal.SIGTERM):
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, lambda number, _: os._exit(128 + number))
    collect_seldom()
    from robocomp_yaml.cli import main as run

    run()


if __name__ == "__main__":
    main()
