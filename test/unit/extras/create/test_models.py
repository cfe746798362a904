"""A model of robot is one entry: what it has decides how it is found, queried, driven and refused."""
import importlib

import pytest

from rbx1_nav.extras.create import create_parameters, protocol
from rbx1_nav.extras.create.protocol import CREATE, CREATE_2, FULL, MODELS, PASSIVE, SAFE
from rbx1_nav.node.config import ConfigError

import driven_create
from driven_create import DrivenCreate, started

# no encoders, gyro board and full mode; another width and rate
MULE = CREATE._replace(
    name='mule', baud=38400, wheel_separation=0.4, has_gyro_board=False, mode_plus_one=True,
    commands={opcode: each for opcode, each in CREATE_2.commands.items() if each.name != 'full'})


@pytest.fixture(name='mule')
def add_a_model(monkeypatch):
    """Add the entry."""
    monkeypatch.setitem(MODELS, MULE.name, MULE)
    monkeypatch.setattr(driven_create, 'read_settings', importlib.reload(create_parameters).read_settings)
    yield
    monkeypatch.undo()
    importlib.reload(create_parameters)


def check_it_drives(driven, model):
    """Drive in an arc, and check the odometry and the last stop."""
    assert driven.driver.model is model and driven.driver.supervisor.in_control and driven.robot.mode == SAFE
    driven.drive(0.2, 0.5, 2)
    assert driven.speeds == (round(200 - 250 * model.wheel_separation), round(200 + 250 * model.wheel_separation))
    driven.command_zero()
    driven.run(1)
    assert driven.pose == pytest.approx(driven.truth, abs=0.03)
    driven.driver.leave(driven.now)
    driven.run(0.1)
    assert driven.driver.left and driven.robot.mode == PASSIVE and not driven.robot.programs_started


def test_a_new_model_is_one_entry(mule):
    driven = started('mule', 3)
    assert driven.log == ['Connected to a mule at 38400 baud', 'The robot is in safe mode']
    check_it_drives(driven, MULE)


@pytest.mark.parametrize('name, value, text', [
    ('has_gyro', True, 'expected false, because a mule has no analog input'),
    ('operation_mode', FULL, 'expected another mode, because a mule has no full mode')])
def test_what_a_model_lacks_is_refused(mule, name, value, text):
    with pytest.raises(ConfigError, match=f'{name}: {value}: {text}'):
        driven_create.read_settings({'robot_type': 'mule', name: value})


def test_a_roomba_600_with_wi_fi_is_driven_by_its_name_and_found_as_a_create_2():
    check_it_drives(started('roomba600_wifi', 3), protocol.ROOMBA_600_WIFI)
    driven = DrivenCreate('auto', robot='roomba600_wifi', oi_mode_workaround=True)
    driven.connect()
    driven.run(3)
    check_it_drives(driven, CREATE_2)
