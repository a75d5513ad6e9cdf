"""How single things are spelled in text: paths, references, plain values, rows, scalars of YAML."""
