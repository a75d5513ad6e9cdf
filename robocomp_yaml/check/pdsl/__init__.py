"""Parameters and values: types, limits, constraints, and their spelling as properties."""
