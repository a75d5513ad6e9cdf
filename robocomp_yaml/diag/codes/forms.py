"""RC25xx: forms, the windows of components."""

from __future__ import annotations

from robocomp_yaml.diag.code import Code

_HEAD = "component: SpeechComp\nlanguage: python\n"
_WINDOW = f"{_HEAD}gui: {{toolkit: qt, base: QWidget}}\n"
_FORM = (
    '<?xml version="1.0" encoding="UTF-8"?>\n<ui version="4.0">\n <class>guiDlg</class>\n'
    ' <widget class="QWidget" name="guiDlg"/>\n</ui>\n'
)
_RIGHT = {"speech.cdsl.yaml": _WINDOW, "src/mainUI.ui": _FORM}

NOT_A_FORM = Code(
    "RC2501",
    "error",
    "this is no form of Qt: {reason}",
    "`gui:` promises a window, and `src/mainUI.ui` describes it, as Qt Designer writes it. `rcyaml compile` writes a "
    "first one where there is none.",
    {**_RIGHT, "src/mainUI.ui": _FORM.replace("</ui>", "")},
    _RIGHT,
)
REFUSED = Code(
    "RC2502",
    "error",
    "a form has no {what}, and this one is not read",
    "What declares entities may say things that stand in no line of the file, or in other files. Qt Designer writes no "
    "such thing.",
    {**_RIGHT, "src/mainUI.ui": _FORM.replace("<ui", '<!DOCTYPE ui [<!ENTITY e "e">]>\n<ui')},
    _RIGHT,
)
NO_DIALOG = Code(
    "RC2503",
    "error",
    "the form's class is {found}, and must be guiDlg",
    "Generated code looks for the class `Ui_guiDlg`, as RoboComp's does: the form's `<class>` and its outermost widget "
    "are called `guiDlg`.",
    {**_RIGHT, "src/mainUI.ui": _FORM.replace("guiDlg", "Form")},
    _RIGHT,
)
OTHER_BASE = Code(
    "RC2504",
    "error",
    "the form is a {found}, and the component's window a {base}",
    "The outermost widget of `src/mainUI.ui` must be what `gui:` says, or a plain QWidget.",
    {**_RIGHT, "src/mainUI.ui": _FORM.replace("QWidget", "QMainWindow")},
    _RIGHT,
)
