"""Of several nodes that publish a topic, one is accepted until it disconnects or falls silent."""
from types import SimpleNamespace

import rospy

from rbx1_nav.filter.one_sender import OneSender


def test_another_node_is_accepted_when_the_first_is_silent_or_gone(monkeypatch):
    one, other = dict(callerid='/one'), dict(callerid='/other')
    warnings, restarts = [], []
    sender = OneSender('odom', 2.0, warnings.append, restarts.append)
    monkeypatch.setattr(rospy.rostime, '_rostime_initialized', True)

    def accepts(header, now, connected=(one, other)):
        """Return whether a message is accepted at a time, s."""
        monkeypatch.setattr(rospy.rostime, '_rostime_current', rospy.Time.from_sec(now))
        connections = [SimpleNamespace(header=each) for each in connected]
        return sender.accepts(header, SimpleNamespace(impl=SimpleNamespace(connections=connections)))
    # the second node is accepted 2.25 s after the last message of the first, which has not moved on by being ignored
    assert [accepts(one, 10.0), accepts(other, 10.0), accepts(one, 10.5), accepts(other, 12.5), accepts(other, 12.75),
            accepts(one, 13.0)] == [True, False, True, False, True, False]
    assert warnings[0] == '/odom: messages from /other ignored: /one also publishes this topic' and len(warnings) == 3
    # gone, before the time, and while the subscriber is being created
    assert accepts(one, 13.0, (one,)) and accepts(other, 12.5) and sender.accepts(dict(other), None)
    assert restarts == ['/one', '/other', '/one', '/other', '/other'] and len(warnings) == 3
