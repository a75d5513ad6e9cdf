"""The engine of several machines: IceGrid starts, watches and ends the processes; what it lacks is added here."""
