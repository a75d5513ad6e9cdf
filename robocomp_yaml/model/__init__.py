"""The documents as typed, immutable objects.

The model knows nothing of YAML's syntax, of middleware or of target languages. Names are as the author wrote them;
references (`TypeRef`, `Use`) are resolved by `link`, not in this package. Spans are ignored when values are compared.
"""
