"""Walks of directed graphs: their order, circles, and chains that no recursion could follow."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from robocomp_yaml import digraph

LONG = 20_000
CHAIN = {number: [number + 1] for number in range(LONG)} | {LONG: []}

graphs = st.dictionaries(st.integers(0, 8), st.lists(st.integers(0, 8), max_size=4)).map(
    lambda graph: graph | {other: [] for others in graph.values() for other in others if other not in graph}
)


def test_the_nearest_are_reached_first() -> None:
    graph = {"a": "bc", "b": "d", "c": "ad", "d": "b"}
    assert list(digraph.reachable("a", graph.__getitem__)) == ["a", "b", "c", "d"]
    assert list(digraph.reachable("db", graph.__getitem__)) == ["d", "b"]
    assert not digraph.reachable("", graph.__getitem__)


def test_inner_ones_come_first_in_the_order_they_are_named() -> None:
    graph = {"a": "bc", "b": "d", "c": "d", "d": ""}
    assert list(digraph.postorder("a", graph.__getitem__)) == ["d", "b", "c", "a"]
    assert list(digraph.postorder("cab", graph.__getitem__)) == ["d", "c", "b", "a"]


def test_a_circle_ends_where_it_began() -> None:
    assert list(digraph.postorder("a", {"a": "b", "b": "c", "c": "a"}.__getitem__)) == ["c", "b", "a"]


def test_long_chains() -> None:
    assert len(digraph.reachable([0], CHAIN.__getitem__)) == LONG + 1
    assert next(digraph.postorder([0], CHAIN.__getitem__)) == LONG
    assert digraph.cyclic_components(CHAIN) == [] and digraph.generations(CHAIN) == [
        (number,) for number in range(LONG, -1, -1)
    ]
    (knot,) = digraph.cyclic_components(CHAIN | {LONG: [0]})
    assert digraph.cycle_through(CHAIN | {LONG: [0]}, knot, 7)[:2] == [7, 8] and len(knot) == LONG + 1


def test_a_circle_goes_by_the_first_that_follows_and_the_shortest_way_back() -> None:
    graph = {"a": "ba", "b": "ca", "c": "a", "d": "a", "e": "e"}
    knots = digraph.cyclic_components(graph)
    assert sorted(map(sorted, knots)) == [["a", "b", "c"], ["e"]]
    assert digraph.cycle_through(graph, {"a", "b", "c"}, "a") == ["a", "b"]
    assert digraph.cycle_through(graph, {"a", "b", "c"}, "c") == ["c", "a", "b"]
    assert digraph.cycle_through(graph, {"e"}, "e") == ["e"]


@given(graphs)
def test_waves_and_knots_agree_of_whether_there_is_a_circle(graph: dict[int, list[int]]) -> None:
    waves, knots = digraph.generations(graph), digraph.cyclic_components(graph)
    assert (waves is None) == bool(knots)
    for knot in knots:
        for start in knot:
            around = digraph.cycle_through(graph, knot, start)
            assert len(set(around)) == len(around) and around[0] == start
            assert all(after in graph[one] for one, after in zip(around, [*around[1:], start], strict=True))
    if waves is not None:
        level = {node: number for number, wave in enumerate(waves) for node in wave}
        assert all(level[other] < level[node] for node, others in graph.items() for other in others)
        order = list(digraph.postorder(graph, graph.__getitem__))
        assert all(order.index(other) < order.index(node) for node, others in graph.items() for other in others)
