"""The nodes that may cause commands, as the master knows them."""
from __future__ import annotations

from typing import Container, Iterable, Sequence

Nodes = Iterable[Sequence]      # each topic with the names of its nodes, as returned by the master's getSystemState


class Graph:
    """The names of nodes when the master was last asked."""

    def __init__(self) -> None:
        self.registered: set[str] = set()   # publishers of commands
        self.on_clock: set[str] = set()     # those that also subscribe to the clock
        self.similar: set[str] = set()      # publishers of any message of the type of commands
        self.needed: set[str] = set()       # nodes whose messages cause commands
        # subscribers to messages of this type: a relay publishes, and so becomes a source, only after its first message
        self.relays: set[str] = set()
        self.sources: list[str] = []        # nodes whose messages may cause a command, nearest last

    def update(self, publishers: Nodes, subscribers: Nodes, topics: set[str], others: set[str], clock: str,
               own_name: str) -> set[str]:
        """Store an answer of the master; return the relays that have begun to publish commands. topics: of the
        commands; others: topics of the same type; clock: topic of the clock."""
        self.registered = names_of(topics, publishers)
        self.on_clock = self.registered & names_of({clock}, subscribers)
        self.similar = names_of(topics | others, publishers)
        self.needed = set(sources_of(topics, publishers, subscribers))
        new = self.relays & self.registered
        sources = sources_of(topics | others, publishers, subscribers)
        self.relays = names_of(others - topics, subscribers) - set(sources)
        self.sources = [each for each in (*reversed(sources), *sorted(self.relays)) if each != own_name]
        return new


def names_of(topics: Container[str], nodes: Nodes) -> set[str]:
    """Return the names of the nodes of some topics."""
    return {name for topic, names in nodes if topic in topics for name in names}


def sources_of(topics: Container[str], publishers: Nodes, subscribers: Nodes) -> list[str]:
    """Return the names of all nodes whose messages may cause a message on one of the topics, nearest first."""
    found: list[str] = []
    new = names_of(topics, publishers)
    while new:
        found += sorted(new)
        new = names_of({each for each, names in subscribers if new & set(names)}, publishers) - set(found)
    return found
