"""Did you mean …? One answer, or none: the words of the hint, and the edit that does what it says."""

from __future__ import annotations

from collections.abc import Container, Iterable

from robocomp_yaml.diag.fix import Hint


def suggest(word: str, candidates: Iterable[str]) -> str | None:
    """The candidate that `word` was most probably meant to be: the same but for case, else the nearest spelling. Never
    the word itself: a hint that says what stands there mends nothing."""
    known = [candidate for candidate in dict.fromkeys(candidates) if candidate != word]
    for candidate in known:
        if candidate.lower() == word.lower():
            return candidate
    from difflib import get_close_matches  # only when there is something wrong

    near = get_close_matches(word, known, n=1, cutoff=0.6)
    if near:
        return near[0]
    folded = {candidate.lower(): candidate for candidate in known}
    if word == word.lower() and list(folded) == known:
        return None  # which would look among the same once more
    near = get_close_matches(word.lower(), folded, n=1, cutoff=0.7)
    return folded[near[0]] if near else None


def did_you_mean(
    word: str, known: Iterable[str], given: Container[str] = (), *, otherwise: str = "", open_: bool = False
) -> Hint:
    """A hint at what was meant, `otherwise` where nothing is near; `given` stand in the same list or mapping already,
    where a second one would be the next error. What differs only in case from a single known name means that, unless
    there can be more names than those that are known (`open_`)."""
    known = list(known)
    if meant := suggest(word, (name for name in known if name not in given)):
        alike = {name for name in known if name.lower() == word.lower()} - {word}
        return meaning(word, meant, safe=not open_ and alike == {meant})
    if meant := suggest(word, (name for name in known if name in given)):
        return Hint(f"'{meant}' is there already")
    return Hint(otherwise)


def meaning(word: str, meant: str, *, more: str = "", safe: bool = False) -> Hint:
    """The hint that `word`, which stands at the diagnostic's place, should be `meant`; `more` is said of it."""
    return Hint(f"did you mean '{meant}'{more}?", word, meant, safe)


def hint_for_key(word: str, known: Iterable[str], given: Container[str]) -> Hint:
    """What to say of a key that means nothing: which one was meant, perhaps beside it, or which there can be."""
    if word == "<<":
        return Hint("YAML 1.2 has no merge keys: write the keys themselves")
    known = list(known)
    free = [key for key in known if key not in given]
    return did_you_mean(word, known, given, otherwise=f"there can be: {', '.join(free[:20])}" if free else "")
