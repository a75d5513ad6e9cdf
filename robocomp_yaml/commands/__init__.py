"""One module a command: parse the options, call, render. `cli.COMMANDS` names them."""
