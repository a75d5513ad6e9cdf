"""The converters, a module for each format: `convert(reader)` returns the draft of a parsed legacy file."""
