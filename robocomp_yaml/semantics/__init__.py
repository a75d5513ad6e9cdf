# Part of rcyaml and of the components that it makes. Do not edit a copy: the next compile overwrites it.
"""What texts, values, constraints and tables mean: the same code in the compiler and in generated components.

The package needs only the standard library of Python 3.9, imports only itself, and is copied unchanged into each
component in Python. Code that uses Ice or Qt is beside it in the component. Regular expressions are plain strings:
`re` compiles and caches one at its first use, and most runs of the compiler use few.
"""
