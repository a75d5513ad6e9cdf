"""Did you mean …? Suggests at most one candidate, as a hint with an edit."""

from __future__ import annotations

from collections.abc import Container, Iterable

from robocomp_yaml.diag.fix import Hint


def suggest(word: str, candidates: Iterable[str]) -> str | None:
    """The candidate that is most similar to `word`: one that differs only in case, or the nearest spelling; None if no
    candidate is similar. Never the word itself, which would not fix anything."""
    known = [candidate for candidate in dict.fromkeys(candidates) if candidate != word]
    for candidate in known:
        if candidate.lower() == word.lower():
            return candidate
    from difflib import get_close_matches  # needed only for errors

    near = get_close_matches(word, known, n=1, cutoff=0.6)
    if near:
        return near[0]
    folded = {candidate.lower(): candidate for candidate in known}
    if word == word.lower() and list(folded) == known:
        return None  # the second search would have the same candidates
    near = get_close_matches(word.lower(), folded, n=1, cutoff=0.7)
    return folded[near[0]] if near else None


def did_you_mean(
    word: str, known: Iterable[str], given: Container[str] = (), *, otherwise: str = "", open_: bool = False
) -> Hint:
    """A hint at the most similar known name, or `otherwise`. Names that are already `given` in the same list or mapping
    are not suggested, because a second one would be an error. The fix is safe if exactly one known name differs only in
    case, unless there may be further names (`open_`)."""
    known = list(known)
    if meant := suggest(word, (name for name in known if name not in given)):
        alike = {name for name in known if name.lower() == word.lower()} - {word}
        return meaning(word, meant, safe=not open_ and alike == {meant})
    if meant := suggest(word, (name for name in known if name in given)):
        return Hint(f"'{meant}' is already present")
    return Hint(otherwise)


def meaning(word: str, meant: str, *, more: str = "", safe: bool = False) -> Hint:
    """The hint to replace `word` at the diagnostic's location by `meant`; `more` is a remark on it."""
    return Hint(f"did you mean '{meant}'{more}?", word, meant, safe)


def likeness(one: str, other: str) -> float:
    """How similar two words are, from 0 to 1, whatever their case."""
    from difflib import SequenceMatcher  # needed only for errors

    return SequenceMatcher(None, one.lower(), other.lower()).ratio()


def is_typing_error(word: str, meant: str) -> bool:
    """Whether at most two letters differ. Names of one kind may be similar without being mistaken for each other."""
    return round((1 - likeness(word, meant)) * (len(word) + len(meant)) / 2) <= 2


def hint_for_key(word: str, known: Iterable[str], present: Container[str]) -> Hint:
    """The hint for an unknown key: a similar known key, or all keys that are allowed and not present."""
    if word == "<<":
        return Hint("YAML 1.2 has no merge keys: write the keys themselves")
    known = list(known)
    free = [key for key in known if key not in present]
    return did_you_mean(word, known, present, otherwise=f"known keys: {', '.join(free[:20])}" if free else "")
