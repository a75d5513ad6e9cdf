"""The language server: `session` knows documents and diagnostics, `server` the protocol, `features` what is done with
the messages of an editor. Only `rcyaml lsp` imports it."""
