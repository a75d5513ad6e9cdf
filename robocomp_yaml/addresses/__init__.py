"""Where components are: TCP ports, own endpoints and proxies, and which components implement an interface."""
