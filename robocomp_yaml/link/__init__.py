"""Documents joined into one program: workspaces, imports, and what each name refers to."""
