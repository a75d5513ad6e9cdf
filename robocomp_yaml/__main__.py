"""`python -m robocomp_yaml` is `rcyaml`."""

from robocomp_yaml.cli import main

main()
