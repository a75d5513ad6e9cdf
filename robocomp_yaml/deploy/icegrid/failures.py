"""The errors of a session with IceGrid. They are apart from it, because it imports Ice, which takes a moment."""


class GridFailed(Exception):
    """A call of IceGrid failed; the text is the reason."""


class Unreachable(GridFailed):
    """The registry or a node does not answer."""
