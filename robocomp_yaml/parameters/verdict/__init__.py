"""Problems of values, and of parameters themselves."""
