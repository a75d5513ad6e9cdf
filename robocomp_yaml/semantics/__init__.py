# Part of rcyaml and of the components that it makes. Do not edit a copy: the next compile overwrites it.
"""What texts, values, constraints and tables mean: one code for the compiler and for the components that it makes.

It needs the standard library of Python 3.9 alone, imports nothing but itself, and is copied into each component in
Python as it stands. What touches Ice or Qt stands beside it there.
"""
