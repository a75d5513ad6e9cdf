from robocomp_yaml.diag.suggest import suggest as suggest
