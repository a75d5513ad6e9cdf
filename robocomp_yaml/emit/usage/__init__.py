"""How the user's code uses the generated worker, and whether the worker has what the code uses."""
