"""What a schema cannot say. Every module here has `check(program) -> Iterator[Diagnostic]`; `pipeline` calls them all."""
