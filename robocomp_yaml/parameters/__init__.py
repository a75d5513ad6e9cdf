"""All about parameters: what documents say of them, their types, their values, and what is made of these.

From the bottom to the top, each part using those before it:

    specification  a document as written             patterns     what texts may be
    types          resolved: every limit joined      kinds        the same as components have them
    defaults       what there is when nobody gives a value
    spelling       references of documents, rows and keys of properties by their types
    documents      of parameters and of values, as the linker joined them
    hidden         which values are secret           words        types and parameters in words
    verdict        the judge: what is wrong with a value, in words, at its place
    expressions    constraints: typed, evaluated
    resolution     from `specification` to `types`
    examples       values that fit, and first documents
    schema         JSON Schemas for editors and tools, and the gate that they are
    layers         documents merged, judged and completed: the values in effect
    writing        those as properties, TOML and reference
    editing        those looked at, and changed in their document

The gate says whether values are right, fast; where they are not, the judge says why. Cerberus completes what is given.
Tests hold gate, judge, the types of components (`kinds`) and Cerberus's own verdict against each other. What texts,
limits and constraints mean is shared with components, in `semantics`.
"""
