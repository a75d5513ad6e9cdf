"""What components are called at Acme."""

from robocomp_yaml.api.plugins import Family, Hint

PAGE = Family("""
## ACME001

*warning*

```message
component {name} is called otherwise than Acme's components
```

At Acme the name of a component ends in `Comp`, so that logs show what is a component and what is an interface.

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
                component.span, name=component.name, hint=Hint(f"call it {better}", component.name, better)
            )
