"""Components built: by what their languages need for it, and whether they are what they are made of.

A language that has a part `building` says how many components of it are built at once; of any other one, the commands
are run that its record names, component by component.
"""
