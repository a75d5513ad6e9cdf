"""Lowers a component for all languages: to frozen views with names that do not clash.

A language sets how it spells things (`ports.PortSpelling`, `parameters.Types`, `kinds.Builders`), and its templates
render the views.
"""
