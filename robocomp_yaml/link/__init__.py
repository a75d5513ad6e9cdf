"""Links documents to one program: workspaces, imports, and the definition of each name."""
