"""Stop shuts down the nodes that publish the topic of the commands, under the name to which it is remapped."""
import time

import rospy

from rbx1_nav.ros.web import system as module
from rbx1_nav.ros.web.state import PageState

LIMIT = 60      # s, after which a wait fails
PUBLISHERS = [['/cmd_vel', ['/stranger']], ['/other/cmd_vel', ['/driver', '/unnamed']]]


def test_stop_shuts_down_the_drivers_of_the_remapped_topic(monkeypatch):
    shut_down = []

    def call(uri, method, *arguments):
        if method == 'getSystemState':
            return PUBLISHERS, [], []
        if method == 'lookupNode':
            return f'uri of {arguments[0]}'
        shut_down.append((uri, method))
        return None
    monkeypatch.setattr(rospy.names, '_resolved_mappings', {'/cmd_vel': '/other/cmd_vel'})
    monkeypatch.setattr(rospy, 'get_name', lambda: '/unnamed')
    monkeypatch.setattr(module, 'call', call)
    system = module.System(PageState())
    system.shut_down_drivers()
    end = time.monotonic() + LIMIT
    while system.pending:
        assert time.monotonic() < end
        time.sleep(0.002)
    assert shut_down == [('uri of /driver', 'shutdown')] and system.take_shut_down() == (['/driver'], [])
