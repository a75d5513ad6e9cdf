"""The engine for several machines: IceGrid starts, watches and ends processes, and this package adds what it lacks."""
