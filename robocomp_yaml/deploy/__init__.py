"""Networks started, watched and stopped: one plan, and engines that carry it out."""
