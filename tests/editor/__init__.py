"""Tests in the real editor server; a package, so that its conftest does not shadow that of all tests."""
