"""Random graphs are ordered: their generations, the processes of a deployment, and those that are waited for."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from robocomp_yaml import digraph
from robocomp_yaml.deploy.plan import in_order
from robocomp_yaml.diag.span import Span
from robocomp_yaml.network.order import AFTER, Dependence, ordered

graphs = st.dictionaries(st.integers(0, 8), st.lists(st.integers(0, 8), max_size=4)).map(
    lambda graph: graph | {other: [] for others in graph.values() for other in others if other not in graph}
)


@given(graphs)
def test_generations_and_components_agree_whether_there_is_a_cycle(graph: dict[int, list[int]]) -> None:
    generations, components = digraph.generations(graph), digraph.cyclic_components(graph)
    assert (generations is None) == bool(components)
    for component in components:
        for start in component:
            around = digraph.cycle_through(graph, component, start)
            assert len(set(around)) == len(around) and around[0] == start
            assert all(after in graph[one] for one, after in zip(around, [*around[1:], start], strict=True))
    if generations is not None:
        level = {node: number for number, generation in enumerate(generations) for node in generation}
        assert all(level[other] < level[node] for node, others in graph.items() for other in others)
        order = list(digraph.postorder(graph, graph.__getitem__))
        assert all(order.index(other) < order.index(node) for node, others in graph.items() for other in others)


@given(st.dictionaries(st.integers(0, 12), st.lists(st.integers(0, 12), max_size=4)))
def test_random_graphs_are_ordered(graph: dict[int, list[int]]) -> None:
    after = {str(name): [str(other) for other in others] for name, others in graph.items()}
    order = in_order(after)
    assert sorted(order) == sorted(after)
    if not _has_cycle(after):
        for name, others in after.items():
            assert all(order.index(other) < order.index(name) for other in others if other in after)


def _has_cycle(after: dict[str, list[str]]) -> bool:
    """By removing names that are after no remaining one."""
    left = dict(after)
    while free := [name for name, others in left.items() if not set(others) & set(left)]:
        for name in free:
            del left[name]
    return bool(left)


names = st.sampled_from("abcdefgh")
dependences = st.tuples(names, names, st.sampled_from(["wait", "fail", "ignore", AFTER])).map(
    lambda drawn: Dependence(
        drawn[0], drawn[1], drawn[2].replace(AFTER, ""), AFTER if drawn[2] == AFTER else "Proxy", Span("x", 1)
    )
)


@given(st.lists(dependences, max_size=30))
def test_every_network_is_ordered(needs: list[Dependence]) -> None:
    waves, after, told = ordered("abcdefgh", needs)
    wave = {name: number for number, names in enumerate(waves) for name in names}
    assert sorted(wave) == list("abcdefgh")
    assert all(wave[target] < wave[source] for source, targets in after.items() for target in targets)
    assert all(not targets or any(wave[t] == wave[name] - 1 for t in targets) for name, targets in after.items())
    kept = {(source, target) for source, targets in after.items() for target in targets}
    dropped = {(one.source, one.target) for one in needs} - kept
    assert bool(dropped) == bool(told)
    assert ordered("abcdefgh", needs) == (waves, after, told)
