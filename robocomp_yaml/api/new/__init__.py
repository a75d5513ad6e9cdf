"""New documents of all kinds, which check and compile at once, with comments that explain them.

An interface goes to the first interfaces folder of the workspace, a component to a folder of `components/` with its
name in lower case, parameters beside their component, a deployment to `deployments/`.
"""
