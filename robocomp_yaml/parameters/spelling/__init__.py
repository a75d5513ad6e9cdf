"""How single things are spelled in text: references, rows, names of properties, scalars of YAML."""
