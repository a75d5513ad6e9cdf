"""`rcyaml manager`: a network, seen and changed in a browser, over the library that the command line uses.

Only the command imports this package: it needs Starlette and uvicorn.
"""
