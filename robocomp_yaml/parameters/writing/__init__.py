"""Values in effect as properties and TOML, and parameters as a reference in Markdown."""
