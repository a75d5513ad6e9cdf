"""Edits of documents as data: each is a small change of a deployment or a component, made in the document's text."""
