"""Algorithms on directed graphs: order, cycles, and chains that are too long for recursion."""

from __future__ import annotations

from robocomp_yaml import digraph

LONG = 1_500  # more than the interpreter recurses
CHAIN = {number: [number + 1] for number in range(LONG)} | {LONG: []}


def test_breadth_first_order() -> None:
    graph = {"a": "bc", "b": "d", "c": "ad", "d": "b"}
    assert list(digraph.reachable("a", graph.__getitem__)) == ["a", "b", "c", "d"]
    assert list(digraph.reachable("db", graph.__getitem__)) == ["d", "b"]
    assert not digraph.reachable("", graph.__getitem__)


def test_preorder_of_trees() -> None:
    trees = {"a": "bc", "b": "d", "c": "de", "d": "", "e": ""}
    assert list(digraph.preorder("eab", trees.__getitem__)) == ["e", "a", "b", "d", "c", "d", "e", "b", "d"]
    assert len(list(digraph.preorder([0], CHAIN.__getitem__))) == LONG + 1


def test_postorder_in_the_order_of_successors() -> None:
    graph = {"a": "bc", "b": "d", "c": "d", "d": ""}
    assert list(digraph.postorder("a", graph.__getitem__)) == ["d", "b", "c", "a"]
    assert list(digraph.postorder("cab", graph.__getitem__)) == ["d", "c", "b", "a"]


def test_postorder_of_a_cycle() -> None:
    assert list(digraph.postorder("a", {"a": "b", "b": "c", "c": "a"}.__getitem__)) == ["c", "b", "a"]


def test_long_chains() -> None:
    assert len(digraph.reachable([0], CHAIN.__getitem__)) == LONG + 1
    assert next(digraph.postorder([0], CHAIN.__getitem__)) == LONG
    assert digraph.cyclic_components(CHAIN) == [] and digraph.generations(CHAIN) == [
        (number,) for number in range(LONG, -1, -1)
    ]
    (component,) = digraph.cyclic_components(CHAIN | {LONG: [0]})
    assert digraph.cycle_through(CHAIN | {LONG: [0]}, component, 7)[:2] == [7, 8] and len(component) == LONG + 1


def test_a_cycle_by_the_first_successor_and_the_shortest_path_back() -> None:
    graph = {"a": "ba", "b": "ca", "c": "a", "d": "a", "e": "e"}
    components = digraph.cyclic_components(graph)
    assert sorted(map(sorted, components)) == [["a", "b", "c"], ["e"]]
    assert digraph.cycle_through(graph, {"a", "b", "c"}, "a") == ["a", "b"]
    assert digraph.cycle_through(graph, {"a", "b", "c"}, "c") == ["c", "a", "b"]
    assert digraph.cycle_through(graph, {"e"}, "e") == ["e"]
