"""All about parameters: what documents say of them, their types, their values, and what is made of these.

Two judges give the same verdict on a value: the JSON Schema made by `json_schema` (the gate, and what editors use) and
`verdict.judge`, which knows places and words. So do the types of components
(`kinds`), and Cerberus, which the tests ask.
"""
