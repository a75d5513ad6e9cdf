"""Values in effect as properties and TOML, and back."""
