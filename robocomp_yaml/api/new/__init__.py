"""A new document of any kind, which already checks and compiles, commented as a tutorial: where it goes, and its text.

An interface goes to the workspace's first folder of interfaces, a component to `components/` and a folder of its own,
which bears its name in lower case; parameters go beside their component, a deployment to `deployments/`. The functions
raise Refused for what cannot be.
"""
