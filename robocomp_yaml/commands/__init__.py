"""The commands, one module each: options, call of the library, output. `cli.COMMANDS` names them."""
