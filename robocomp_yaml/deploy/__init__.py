"""Networks are started, supervised and stopped: by one plan, which an engine carries out."""
