"""The bases that the master lists, and the commands that a base has not followed."""
from types import SimpleNamespace
from xmlrpc.client import Fault

from rospy.impl.masterslave import ROSHandler

from rbx1_nav.base.refusals import Refusals, ask_refusals
from rbx1_nav.base.running_bases import namespaces_of_bases, private_namespace

PUBLISHERS = {'/odom': ['/arbotix'], '/r1/odom': ['/fleet'], '/r2/odom': ['/fleet'],
              '/r2/cmd_vel': ['/r2/out_and_back']}
SUBSCRIBERS = {'/cmd_vel': ['/arbotix', '/recorder'], '/r1/cmd_vel': ['/fleet'], '/r2/cmd_vel': ['/fleet'],
               '/r3/cmd_vel': ['/recorder'], '/odom': ['/recorder']}


def test_a_base_publishes_odometry_and_subscribes_to_commands():
    found = namespaces_of_bases(PUBLISHERS, SUBSCRIBERS, ['/odom', '/r1/odom', '/r2/odom'])
    assert found == {'/': {'/arbotix'}, '/r1': {'/fleet'}, '/r2': {'/fleet'}}


def test_private_names_of_a_fleet_are_those_of_its_robots():
    parameters = {'/fleet/robots'}
    master = SimpleNamespace(call=lambda _, key: key in parameters)
    assert private_namespace('/fleet', '/r1/odom', master) == '/r1/arbotix'
    assert private_namespace('/r1/arbotix', '/r1/odom', master) == '/r1/arbotix'
    assert private_namespace('/turtlebot_node', '/odom', master) == '/turtlebot_node'


def test_each_sender_is_told_its_own_refusals():
    refusals, calls = Refusals(), []
    for sender, reason, refused in ('/a', 'docked', True), ('/b', 'reset', True), ('/a', 'one\nlate', False):
        refusals.add(sender, reason, refused)
    server = SimpleNamespace(call=lambda method, exact: getattr(ROSHandler, method)(None, '/a', exact)[2])
    assert ask_refusals(server, False) == (1, 'docked') and ask_refusals(server, True) == (2, 'onelate')
    assert refusals.count == 2
    assert getattr(ROSHandler, 'getRefusals')(None, '/c') == (1, '', [0, ''])

    def call(method, *_):
        calls.append(method)
        if method == 'getRefusals':     # another node has no such method
            raise Fault(1, '')
    assert ask_refusals(SimpleNamespace(call=call), True) == (None, '') and calls[1:] == ['getPid']
