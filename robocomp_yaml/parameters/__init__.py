"""All about parameters: what documents say of them, their types, their values, and what is made of these.

Three judges give the same verdict on a value: the JSON Schema made by `json_schema` (the gate, and what editors use),
Cerberus with the rules of `layers.rules` (which also fills defaults in), and `verdict.judge`, which knows places and
words.
"""
