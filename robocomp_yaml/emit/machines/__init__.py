"""Lowers state machines: to tables, and to views for templates."""
