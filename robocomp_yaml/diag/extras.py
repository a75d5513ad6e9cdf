"""How to install an extra of rcyaml into the environment in which it runs."""

from __future__ import annotations

import os
import sys

from robocomp_yaml.diag.terminal import typed


def command(extra: str) -> str:
    """The command to type, such as `pip install 'rcyaml[lsp]'`. Outside of environments of its own, the user knows
    which pip is rcyaml's; a pip that is first on the path need not be that of an environment."""
    wanted = f"rcyaml[{extra}]"
    if os.path.isfile(os.path.join(sys.prefix, "pipx_metadata.json")):
        return typed("pipx", "runpip", "rcyaml", "install", wanted)
    if sys.prefix != sys.base_prefix:
        return typed(sys.executable, "-m", "pip", "install", wanted)
    return typed("pip", "install", wanted)
