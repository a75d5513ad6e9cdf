"""The diagnostics of slips in code."""

from __future__ import annotations

from robocomp_yaml.diag.codes import usage as codes
from robocomp_yaml.diag.diagnostic import Diagnostic
from robocomp_yaml.diag.fix import Edit, Fix
from robocomp_yaml.diag.suggest import did_you_mean
from robocomp_yaml.emit.usage import code
from robocomp_yaml.emit.usage.code import Slip
from robocomp_yaml.emit.usage.values import unknown

_INSTEAD = {
    code.ASYNC: "remove `async`: Ice has a thread for each call",
    code.YIELDS: "return a list of the values",
    code.PROPERTY: "remove the decorator",
    code.STATIC: "remove `@staticmethod`, or the parameter self",
    code.VALUE: "define a method",
}


def of_slip(slip: Slip) -> Diagnostic:
    match slip.kind:
        case code.WITHOUT_SELF:
            hint = f"write {slip.meant}"
            fix = Fix(hint, (Edit(slip.word.span, slip.meant),), True)
            return codes.WITHOUT_SELF.at(slip.word.span, name=slip.word.text, hint=hint, fixes=(fix,))
        case code.NO_SELF:
            return codes.NO_SELF.at(slip.word.span, name=slip.word.text, hint="its first parameter must be self")
        case code.NOT_CALLED:
            return codes.NOT_CALLED.at(slip.word.span, name=slip.word.text, hint=f"write {slip.word.text}(…)")
        case code.UNDEFINED if slip.meant:
            return codes.UNDEFINED.at(slip.word.span, name=slip.word.text, hint=f"write `{slip.meant}`")
        case code.UNDEFINED:
            near = did_you_mean(slip.word.text, slip.known)
            return unknown(codes.UNDEFINED, slip.word, near.meant, otherwise="", safe=False)
        case code.REPEATED:
            hint = "rename one of the two"
            return codes.REPEATED.at(slip.word.span, name=slip.word.text, line=int(slip.meant), hint=hint)
        case code.NO_INIT:
            return codes.NO_INIT.at(slip.word.span, hint="call super().__init__ with its arguments first")
        case code.NO_RESULT:
            return codes.NO_RESULT.at(slip.word.span, name=slip.word.text)
        case code.ARROW:
            hint = f"a proxy is a pointer: write {slip.meant}"
            return codes.UNKNOWN_MEMBER.at(slip.word.span, struct="the pointer", name=slip.word.text, hint=hint)
        case code.NO_METHOD:
            hint = _INSTEAD[slip.meant]
            return codes.NO_METHOD.at(slip.word.span, name=slip.word.text, form=slip.meant, hint=hint)
    meant = did_you_mean(slip.word.text, slip.known, otherwise=f"it has {', '.join(slip.known)}")
    return unknown(codes.NOT_GENERATED, slip.word, meant.meant, otherwise=meant.text, safe=meant.safe)
