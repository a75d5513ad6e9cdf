"""The engine for several machines: IceGrid starts, watches and ends processes, and this package adds what it lacks."""

import robocomp_yaml.wire  # noqa: F401 - it knows where Ice is
