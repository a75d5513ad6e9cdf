"""Parameters, constraints and values as documents have them: no names are looked up yet."""
