"""What rcyaml says about a document: spans, diagnostics, their table of codes, and how each output shows them."""
