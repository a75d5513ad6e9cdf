"""IDSL interfaces over Ice without generated code: data of documents to Ice values and back, clients, servants."""
