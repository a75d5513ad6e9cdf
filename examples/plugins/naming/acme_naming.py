"""The names of components at Acme."""

from robocomp_yaml.api.plugins import Family, Hint

PAGE = Family("""
## ACME001

*warning*

```message
the name of component {name} does not follow Acme's rule
```

At Acme the name of a component ends in `Comp`, so that components and interfaces can be distinguished in logs.

Wrong:

```yaml speech.cdsl.yaml
component: Speech
language: python
```

Right:

```yaml speech.cdsl.yaml
component: SpeechComp
language: python
```

Both beside:

```yaml rcyaml.yaml
plugins: [acme-naming]
```
""")
OTHER_NAME = PAGE.code("ACME001")

KIND = "cdsl"


def check(program):
    for linked in program.components.values():
        component = linked.component
        if not component.name.endswith("Comp"):
            better = f"{component.name}Comp"
            yield OTHER_NAME.at(
                component.span, name=component.name, hint=Hint(f"rename it to {better}", component.name, better)
            )
