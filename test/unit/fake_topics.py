"""Publishers, subscribers and services of a node that is not connected to a master."""
import rospy


class Topic:
    """A publisher with a subscriber, a subscriber or a service; `sent` has its messages, `callback` receives them."""

    connections = 1

    def __init__(self, name, _=None, callback=None, *__, **___):
        self.name, self.sent, self.callback = name, [], callback
        self.resolved_name = rospy.names.resolve_name(name)

    def get_num_connections(self):
        return self.connections

    def publish(self, message=None):
        self.sent.append(message)

    def unregister(self):
        self.callback = None
    shutdown = unregister


def replace_topics(monkeypatch):
    """Let rospy create Topics; returns the latest one of each name."""
    topics = {}

    def create(name, *rest, **_):
        topics[name] = Topic(name, *rest)
        return topics[name]
    for kind in 'Publisher', 'Subscriber', 'Service':
        monkeypatch.setattr(rospy, kind, create)
    return topics
