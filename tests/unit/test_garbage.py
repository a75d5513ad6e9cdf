"""When garbage is collected."""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterator

import pytest

from robocomp_yaml.garbage import collect_often, collect_seldom


class Cycle:
    """Only the collector frees it."""

    def __init__(self) -> None:
        self.myself = self


@pytest.fixture
def collector() -> Iterator[None]:
    before = gc.get_threshold()
    gc.collect()
    yield
    gc.set_threshold(*before)
    gc.unfreeze()


@pytest.mark.usefixtures("collector")
@pytest.mark.parametrize(("when", "least", "most"), [(collect_seldom, 50_000, 50_000), (collect_often, 0, 10_000)])
def test_garbage_that_is_kept(when: Callable[[], None], least: int, most: int) -> None:
    when()
    for _ in range(50_000):
        Cycle()
    assert least <= sum(type(one) is Cycle for one in gc.get_objects()) <= most
