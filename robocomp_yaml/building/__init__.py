"""Building components as their languages need it, and whether they are up to date.

A language with a part `building` builds several components at once. For any other language, the commands of its record
are run, component by component.
"""
