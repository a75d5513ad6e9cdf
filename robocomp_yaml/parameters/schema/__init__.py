"""JSON Schemas of values: for editors and tools, and as the gate of `check`."""
