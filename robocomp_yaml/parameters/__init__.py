"""Parameters: their specification, their types, their values, and what is generated from these.

From the bottom to the top, each part uses those above it in this list:

    specification  a document as written             patterns     patterns of texts
    types          resolved types with all limits    kinds        the same types as components have them
    defaults       the values that no document sets
    spelling       references in documents, and rows and keys of properties by their types
    documents      linked documents of parameters and of values
    hidden         secret values                     words        types and parameters in words
    verdict        the judge: the problems of a value, as diagnostics
    expressions    constraints: their types and values
    resolution     from `specification` to `types`
    examples       examples of values, and first documents
    json_schema    JSON Schemas for editors and tools, and the validator
    layers         documents merged, judged and completed: the effective values
    writing        effective values as properties and TOML, and the reference of parameters
    editing        effective values with their origin, and edits of their documents

The validator is a compiled schema that decides fast whether values are valid; if they are not, the judge reports why.
Cerberus completes records. Tests compare the validator, the judge, the types of components (`kinds`) and Cerberus's own
verdict. The meaning of texts, limits and constraints is in `semantics`, which components share.
"""
