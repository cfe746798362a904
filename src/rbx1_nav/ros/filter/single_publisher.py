"""Listens to one of several nodes that publish the same topic."""
import rospy


class OneSender:
    """Decides whose messages count: those of the first node, until it has gone or fallen silent."""

    def __init__(self, topic, silence, warn, restart):
        """topic: name; silence: s, after which another node may follow; warn(text): logs a warning; restart(name):
        called before the first message of a node counts."""
        self.topic = rospy.resolve_name(topic)
        self.silence = silence
        self.warn = warn
        self.restart = restart
        self.header = None      # the header of its connection
        self.heard = None       # rospy.Time when its last message arrived

    def accepts(self, header, connections, now):
        """Whether a message counts that came by the connection with this header, among rospy's present connections."""
        if header is not self.header and any(connection.header is self.header for connection in connections) and (
                0 <= (now - self.heard).to_sec() <= self.silence):
            self.warn('%s: messages of %s ignored: %s publishes it too'
                      % (self.topic, header['callerid'], self.header['callerid']))
            return False
        if header is not self.header:
            self.restart(header['callerid'])
        self.header, self.heard = header, now
        return True
