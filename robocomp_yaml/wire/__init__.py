"""IDSL interfaces over Ice without generated code: data of documents to Ice values and back, clients, servants."""

from robocomp_yaml.wire import debians_ice

debians_ice.offer()  # before any module imports Ice
