"""The documents as typed, immutable objects.

The model knows nothing of YAML's syntax, of middleware or of target languages. Names are as the author wrote them;
references (`TypeRef`, `Use`) are resolved by `link`, not here. Spans take no part in equality.
"""
