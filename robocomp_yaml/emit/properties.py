"""`source.properties` by its former name."""

from robocomp_yaml.source.properties import (
    Entry as Entry,
    Properties as Properties,
    entry_line as entry_line,
    read as read,
    unquoted as unquoted,
    unwritable as unwritable,
)
