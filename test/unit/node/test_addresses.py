"""A wrong ROS_MASTER_URI, ROS_IP or ROS_HOSTNAME is one line, before a node waits."""
import sys

import pytest
import rospy

from rbx1_nav.node.addresses import check_master_uri, check_own_address
from rbx1_nav.node.private_parameters import find_problem


@pytest.fixture(autouse=True)
def fixture_environment(monkeypatch):
    for name in 'ROS_IP', 'ROS_HOSTNAME', 'ROS_IPV6':
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(rospy.core, 'configure_logging', lambda _: None)
    monkeypatch.setattr(sys, 'argv', ['/nodes/drive.py'])


@pytest.mark.parametrize('uri', ['localhost:11311', 'http://localhost:99999', 'http://:11311', 'http://localhost'])
def test_an_address_of_no_master(monkeypatch, capsys, uri):
    monkeypatch.setenv('ROS_MASTER_URI', uri)
    with pytest.raises(SystemExit) as exit:
        check_master_uri()
    assert exit.value.code == 2 and capsys.readouterr().err == (
        f'drive.py: error: ROS_MASTER_URI: {uri!r}: expected http://HOST:PORT, such as http://localhost:11311\n')


@pytest.mark.parametrize('uri', ['http://localhost:11311', 'http://192.168.1.5:11311/', 'http://[::1]:11311'])
def test_an_address_of_a_master(monkeypatch, uri):
    monkeypatch.setenv('ROS_MASTER_URI', uri)
    check_master_uri()


# 203.0.113.0/24 is for documents (RFC 5737), and no name ends in .invalid (RFC 2606)
@pytest.mark.parametrize('name, value', [('ROS_IP', '203.0.113.7'), ('ROS_HOSTNAME', 'robot.invalid'),
                                         ('ROS_IP', '0.0.0.0')])
def test_an_own_address_at_which_this_computer_cannot_be_reached(monkeypatch, name, value):
    monkeypatch.setenv(name, value)
    monkeypatch.setattr('rbx1_nav.node.addresses.TIMEOUT', 0.05)
    with pytest.raises(rospy.ROSException, match=f'^{name}: {value}: expected an address at which this computer '):
        check_own_address('/drive')


@pytest.mark.parametrize('name, value', [('ROS_IP', '127.0.0.1'), ('ROS_HOSTNAME', 'localhost')])
def test_an_own_address(monkeypatch, name, value):
    monkeypatch.setenv(name, value)
    check_own_address('/drive')


def test_a_name_of_a_node():
    assert find_problem('__name:=foo bar', []).startswith('expected a name')
    assert find_problem('__name:=/foo', []) and find_problem('__name:=', [])
    assert find_problem('__name:=foo_2', []) is None and find_problem('__ns:=/a/b', []) is None
    for name in 'foo bar', '/a//b', '~a', '9':
        assert find_problem(f'__ns:={name}', []).startswith('expected a namespace')
