"""One module a kind of document: `convert(reader)` makes a draft of a parsed legacy file."""
