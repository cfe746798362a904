"""Each file in nodes/ runs its main() when it is started, and the nodes of bases pass their parameters on."""
import glob
import os
import runpy
import sys
from types import SimpleNamespace

import pytest
import rospy

from rbx1_nav.driving import script
from rbx1_nav.node import life
from loaded_nodes import ROOT, load, without_master


@pytest.mark.parametrize('path', sorted(glob.glob(os.path.join(ROOT, 'nodes', '*.py'))), ids=os.path.basename)
def test_a_file_that_is_started(monkeypatch, capsys, path):
    calls = []

    def interrupted(*_, **__):
        raise rospy.ROSInterruptException()
    monkeypatch.setattr(sys, 'argv', [path, '--help'])
    monkeypatch.setattr(life, 'run', lambda main: calls.append(main.__name__))
    monkeypatch.setattr(rospy, 'loginfo', calls.append)
    monkeypatch.setattr(rospy, 'init_node', interrupted)
    monkeypatch.setattr(script, 'start_node', interrupted)
    try:
        runpy.run_path(path, run_name='__main__')
        assert calls == ['main'] or calls[0].endswith('terminated.')
    except SystemExit as exit:
        assert ''.join(capsys.readouterr()).lstrip('\n').find('usage: ') >= 0 and exit.code in (0, 2)


@pytest.mark.parametrize('name, clock', [('fake_base', 'wall'), ('turtlebot_node', 'wall'), ('turtlebot_node', 'sim')])
def test_a_base_gets_its_parameters_and_frames(monkeypatch, name, clock):
    module, made, params = load(name), [], dict(controllers=dict(base=dict(type='diff_controller', base_width=0.3)),
                                                surface='low_ply_carpet', seed=4)
    if name == 'turtlebot_node':
        params = dict(port='/dev/ttyS5')
        monkeypatch.setattr(rospy.rostime, 'is_wallclock', lambda: clock == 'wall')
    _, log = without_master(monkeypatch, **params)
    base = SimpleNamespace(start=lambda: log.append('started'), step=lambda: log.append('step'), run=lambda: params,
                           publisher='publisher', diagnostics=SimpleNamespace(updater='updater'))
    monkeypatch.setattr(module, 'ModelCheck', lambda publisher, keys, diagnostics: SimpleNamespace(
        start=lambda: log.append((publisher, *keys, diagnostics))))
    for part in 'SimulatedRobot', 'CreateBase':
        monkeypatch.setattr(module, part, lambda *arguments: made.append(arguments) or base, raising=False)
    monkeypatch.setattr(module, 'resolve_frame', 'robot7/{}'.format)
    monkeypatch.setattr(module, 'read_clock', lambda rate: SimpleNamespace(run=lambda step: step()), raising=False)
    monkeypatch.setattr(rospy, 'get_param', lambda *_: params)
    assert module.main() == (clock == 'sim')
    if clock == 'sim':
        assert not made and log[-1][1].startswith('/use_sim_time: true: expected false')
    elif name == 'fake_base':
        robot, surface, seed, *_ = made[0]
        assert (robot.odom_frame_id, surface.name, seed) == ('robot7/odom', 'low_ply_carpet', 4)
        key = 'controllers/base'
        assert log[-3:] == [('publisher', f'{key}/base_frame_id', key, base.diagnostics), 'started', 'step']
    else:
        assert log[-1] == ('publisher', 'base_frame', '', 'updater')
        assert made[0][0].port == '/dev/ttyS5' and made[0][1].odom_frame_id == 'robot7/odom'
        params.clear()      # a robot that is not found
        assert module.main() == 1
