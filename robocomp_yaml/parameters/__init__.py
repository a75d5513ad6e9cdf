"""All about parameters: what documents say of them, their types, their values, and what is made of these.

Two judges give the same verdict on a value: the JSON Schema made by `schema` (the gate, and what editors use), and
`verdict.judge`, which knows places and words. What components decide by the same code is in `semantics`.
"""
