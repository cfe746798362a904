"""A running base finds out from the master whether its model is shown, by one node, with its own joint states."""
from types import SimpleNamespace

import pytest
import rospy

from rbx1_nav.base import model_check as module
from rbx1_nav.base.robot_parameters import read_robot

URDF = '''<robot name="a"><link name="base_footprint"/><link name="l"/><link name="r"/>
<joint name="base_l_wheel_joint" type="continuous"><parent link="base_footprint"/><child link="l"/></joint>
<joint name="base_r_wheel_joint" type="continuous"><parent link="base_footprint"/><child link="r"/></joint></robot>'''
OWN, OTHER = '/r1/joint_states', '/r2/joint_states'


@pytest.fixture(name='check')
def fixture_check(monkeypatch):
    """A ModelCheck; check.publishers and check.subscribers: (topic: nodes) that the master reports."""
    class Master:
        def __init__(self, _):
            pass

        def __enter__(self):
            return self

        def __exit__(self, *_):
            pass

        def call(self, method, *_):
            return {'searchParam': '/robot_description', 'getParam': check.urdf,
                    'getSystemState': (list(check.publishers.items()), list(check.subscribers.items()), []),
                    'getTopicTypes': [(OWN, 'sensor_msgs/JointState'), (OTHER, 'sensor_msgs/JointState'),
                                      ('/r1/scan', 'sensor_msgs/LaserScan')]}[method]
    monkeypatch.setattr(module, 'Server', Master)
    monkeypatch.setattr(module, 'find_prefix', lambda: '')
    monkeypatch.setattr(rospy, 'get_name', lambda: '/arbotix')
    robot = read_robot({'controllers': {'base': {
        'type': 'diff_controller', 'base_width': 0.4, 'base_frame_id': 'base_footprint'}}})
    publisher = SimpleNamespace(robot=robot, joint_states=SimpleNamespace(resolved_name=OWN))
    check = module.ModelCheck(publisher, ('controllers/base/base_frame_id', 'controllers/base'),
                              SimpleNamespace(add=lambda *_: None))
    check.urdf = URDF
    check.publishers = {OWN: ['/arbotix'], '/tf': ['/arbotix', '/state']}
    check.subscribers = {OWN: ['/state'], OTHER: ['/neighbor']}
    return check


def test_a_model_that_belongs_to_its_base(check):
    assert check.find() == [] and check.state == 'Consistent'


def test_a_text_that_is_no_model_is_named(check):
    check.urdf = '<robot'
    assert check.find()[0].startswith('/robot_description: ')


def test_the_joint_states_of_another_namespace_do_not_count(check):
    check.subscribers = {OTHER: ['/state']}
    check.model = 'a.urdf'
    assert check.find() == ['robot_description: expected a robot_state_publisher that shows a.urdf, but none is '
                            'running: its last lines give the reason'] and check.state == 'No robot_state_publisher'


def test_two_nodes_that_publish_the_links(check):
    check.subscribers[OWN] = ['/state', '/second']
    check.publishers['/tf_static'] = ['/second']
    assert check.find()[0].startswith('robot_description: /second and /state publish the links')


def test_joints_that_another_node_publishes_are_asked_for(check, monkeypatch):
    heard = []

    def listen(topic, nodes):
        heard.append((topic, nodes))
        return module.Published({'/arm': {'base_l_wheel_joint'}}, set())
    monkeypatch.setattr(module, 'listen', listen)
    check.publishers[OWN].append('/arm')
    problem, = check.find()
    assert heard == [(OWN, {'/arm'})] and '/arm and the base publish base_l_wheel_joint' in problem


def test_a_problem_is_logged_once_and_its_end_too(check, monkeypatch):
    log = []
    monkeypatch.setattr(rospy, 'logwarn', lambda form, text: log.append(text))
    monkeypatch.setattr(rospy, 'loginfo', lambda form, text: log.append(f'resolved {text}'))
    for found in [], ['a'], ['a', 'b'], ['b'], []:
        check.report(found)
    assert log == ['a', 'b', 'resolved a', 'resolved b']
