"""Parameters and values as documents have them: names of types are not looked up yet."""
