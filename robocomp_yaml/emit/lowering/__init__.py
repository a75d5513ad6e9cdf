"""What a component comes to in code, whatever the language: frozen views with names that do not clash.

A language says how it spells things (`ports.Spelling`, `parameters.Types`, `kinds.Builders`), and its templates show
what comes back.
"""
