#!/usr/bin/python3
"""Prints the running system as Mermaid text: the graph of nodes and topics, and the tree of tf2 frames."""
import argparse
import re
import socket
import time

import rosgraph
import rospy
import tf2_ros
import yaml

LOGGING = {'/rosout', '/rosout_agg'}    # the node of this name, and the topics that all nodes publish
# suffix that roslaunch, rospy and roscpp append to an anonymous name: host, process id, random number or time
ANONYMOUS = re.compile(r'(_%s)?(_\d+)?_\d{9,}$' % re.sub(r'\W', '_', socket.gethostname()))


def plain(node):
    """Return the name of a node without the suffix that makes it anonymous."""
    return ANONYMOUS.sub('', node)


def identifier(kind, name):
    """Return a name that Mermaid can use. A node, a topic and a frame with the same name get different identifiers."""
    return '%s_%s' % (kind, re.sub(r'\W', '_', name.lstrip('/')))


def node_graph(publishers, subscribers, hidden):
    """Return the graph as Mermaid text.

    publishers, subscribers: lists of [topic, names of nodes], as returned by the master's getSystemState; hidden: names
    of nodes to leave out.
    """
    shapes, arrows = set(), set()
    for pairs, arrow in ((publishers, '{0} --> {1}'), (subscribers, '{1} --> {0}')):
        for topic, nodes in pairs:
            if topic in LOGGING:
                continue
            for node in map(plain, set(nodes) - LOGGING - set(hidden)):
                ids = identifier('node', node), identifier('topic', topic)
                shapes.update((f'{ids[0]}(["{node}"])', f'{ids[1]}["{topic}"]'))
                arrows.add(arrow.format(*ids))
    return '\n    '.join(['flowchart LR'] + sorted(shapes) + sorted(arrows))


def frame_tree(frames):
    """Return the tree as Mermaid text, each transform with its publishing node. frames: all_frames_as_yaml() of tf2."""
    tree = yaml.safe_load(frames) or {}
    names = set(tree).union(frame['parent'] for frame in tree.values())
    shapes = [f"{identifier('frame', name)}[\"{name}\"]" for name in sorted(names)]
    arrows = ['%s -->|"%s"| %s' % (identifier('frame', frame['parent']), plain(frame['broadcaster']),
                                   identifier('frame', name)) for name, frame in sorted(tree.items())]
    return '\n    '.join(['flowchart LR'] + shapes + arrows)


class RunningSystem:
    """Reads the state of the master and listens to /tf. Requires an initialized node."""

    def __init__(self):
        self.master = rosgraph.Master(rospy.get_name())
        self.buffer = tf2_ros.Buffer()
        self.listener = tf2_ros.TransformListener(self.buffer)

    def draw(self):
        """Return both diagrams as Mermaid texts."""
        publishers, subscribers, _ = self.master.getSystemState()
        return node_graph(publishers, subscribers, [rospy.get_name()]), frame_tree(self.buffer.all_frames_as_yaml())


def main():
    """Print both diagrams as Markdown blocks."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('seconds', type=float, nargs='?', default=3.0, help='how long to listen to /tf; default: 3')
    seconds = parser.parse_args().seconds
    rospy.init_node('graph', anonymous=True, disable_rostime=True)
    system = RunningSystem()
    time.sleep(seconds)
    for picture in system.draw():
        print(f'```mermaid\n{picture}\n```\n')


if __name__ == '__main__':
    main()
