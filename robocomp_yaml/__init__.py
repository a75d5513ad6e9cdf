"""rcyaml: the configuration compiler for component-based robotics."""

__version__ = "0.1.0"
