"""Publishers, subscribers and services of a node that is not connected to a master."""
import rospy


class Topic:
    """A publisher with a subscriber, a subscriber or a service; `sent` has its messages."""

    connections = 1

    def __init__(self, name, *_, **__):
        self.name, self.sent = name, []
        self.resolved_name = rospy.names.resolve_name(name)

    def get_num_connections(self):
        return self.connections

    def publish(self, message=None):
        self.sent.append(message)


def replace_topics(monkeypatch):
    """Let rospy create Topics."""
    for name in 'Publisher', 'Subscriber', 'Service':
        monkeypatch.setattr(rospy, name, Topic)
