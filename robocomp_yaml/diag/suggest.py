"""Did you mean …? One answer, or none."""

from __future__ import annotations

from collections.abc import Iterable


def suggest(word: str, candidates: Iterable[str]) -> str | None:
    """The candidate that `word` was most probably meant to be: the same but for case, else the nearest spelling."""
    known = list(dict.fromkeys(candidates))
    for candidate in known:
        if candidate.lower() == word.lower() and candidate != word:
            return candidate
    from difflib import get_close_matches  # only when there is something wrong

    near = get_close_matches(word, known, n=1, cutoff=0.6)
    if near:
        return near[0]
    folded = {candidate.lower(): candidate for candidate in known}
    near = get_close_matches(word.lower(), folded, n=1, cutoff=0.7)
    return folded[near[0]] if near else None
