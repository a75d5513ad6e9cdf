"""`ports: {from: 12000, to: 12999}`: the range of default TCP ports, in `rcyaml.yaml` and in deployments."""

from __future__ import annotations

from robocomp_yaml.diag.codes import emitting as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.model.located import Spanned
from robocomp_yaml.source.tree import Mapping, Node, Scalar


class PortRange(Spanned, frozen=True):
    """TCP ports from `first` to `last`, both included. `span` is that of the key in the document."""

    first: int
    last: int

    @property
    def count(self) -> int:
        return self.last - self.first + 1

    @property
    def is_empty(self) -> bool:
        return self.last < self.first

    def fault(self) -> Diagnostic:
        """The diagnostic of an empty range."""
        hint = f"write {{from: {self.last}, to: {self.first}}}"
        return codes.RANGE_EMPTY.at(self.span, first=self.first, last=self.last, hint=hint)

    def __str__(self) -> str:
        return f"{self.first}–{self.last}"


def port_range(root: Node | None) -> PortRange | None:
    """The range under `ports:` of a document that fits its schema; None if it is not set."""
    node = root.get("ports") if isinstance(root, Mapping) else None
    if not isinstance(node, Mapping):
        return None
    first, last = (node.get(key) for key in ("from", "to"))
    if not isinstance(first, Scalar) or not isinstance(last, Scalar):
        return None
    return PortRange(int(first.data), int(last.data), span=node.span)  # type: ignore[call-overload]
