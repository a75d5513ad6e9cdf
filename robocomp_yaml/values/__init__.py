"""Values of parameters: judged, normalized, layered, and turned into Ice properties and back.

Three judges give the same verdict on a value: the JSON Schema made by `json_schema` (the gate, and what editors use),
Cerberus with the rules of `rules` (which also fills defaults in), and `judge`, which knows places and words.
"""
