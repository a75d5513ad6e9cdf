"""Parameters, constraints and values as written: no name is resolved."""
