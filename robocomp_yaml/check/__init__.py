"""What a schema cannot say: every module here has `check(program) -> Iterator[Diagnostic]`."""
