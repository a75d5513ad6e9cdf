"""A network as an outline: the hosts with their processes."""


def draw(picture):
    lines = [f"# {picture.name}"]
    for box in picture.boxes:
        lines.append(f"- {box.title}")
        lines += [f"  - {node.title}" for node in picture.inside(box.name)]
    return "\n".join(lines) + "\n"
