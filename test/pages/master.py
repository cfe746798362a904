"""Asks a ROS master whether a program started in a terminal is up."""
import re
from xmlrpc.client import ServerProxy

# roslaunch lists its nodes by namespace, and then reports each process that it starts
LISTED = re.compile(r'  (?P<namespace>/\S*)|    (?P<node>\S+) \(\S+/\S+\)')
STARTED = re.compile(r'process\[(?!master\]|rosout-)\S+: started with pid ')
NOT_DISPLAYS = ('/tf', '/tf_static', '/clock')      # RViz subscribes to these without any display


class Master:
    """A ROS master, which may not be running."""

    def __init__(self, uri):
        self.uri = uri

    def registrations(self):
        """Sets of (node, topic) of publishers and of subscribers, and of (node, service). Empty without a master."""
        try:
            with ServerProxy(self.uri) as proxy:
                kinds = proxy.getSystemState('/pages')[2]
        except OSError:
            kinds = [], [], []
        return [{(node, name) for name, nodes in kind for node in nodes} for kind in kinds]

    def nodes(self):
        """Names of all nodes."""
        return {node for kind in self.registrations() for node, _ in kind}

    def is_up(self, before, lines):
        """Whether the nodes of a command are registered.

        before: the nodes before the command was typed. lines: its output. For roslaunch, all nodes that it lists must
        be registered; for other commands, any new node counts.
        """
        new = self.nodes() - before
        if any(node.startswith('/rviz') for node in new):
            return self.rviz_is_up(new)
        nodes = listed(lines)
        # nodes with these names may remain from another launch, so all of them must also have been started
        started = sum(bool(STARTED.match(line)) for line in lines)
        return started >= len(nodes) and nodes <= self.nodes() if nodes else bool(new)

    def rviz_is_up(self, nodes):
        """Whether an RViz among these nodes has loaded its file and shows a topic; without a file it starts empty."""
        _, subscribers, services = self.registrations()
        return (any(node in nodes and service.endswith('/reload_shaders') for node, service in services) and
                any(node in nodes and node.startswith('/rviz') and topic not in NOT_DISPLAYS
                    for node, topic in subscribers))


def listed(lines):
    """The nodes in roslaunch's summary."""
    namespace, nodes = '', set()
    for match in filter(None, map(LISTED.fullmatch, lines)):
        if match['namespace']:
            namespace = match['namespace'].rstrip('/')
        else:
            nodes.add(f"{namespace}/{match['node']}")
    return nodes
