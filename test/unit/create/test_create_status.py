"""/diagnostics reports the status of each type of robot."""
from types import SimpleNamespace

from diagnostic_updater import DiagnosticStatusWrapper
import pytest

from driven_create import DrivenCreate
from rbx1_nav.ros.base.create_status import CreateStatus


def statuses(driven):
    """Return {title: DiagnosticStatus} of a DrivenCreate."""
    functions = {}
    updater = SimpleNamespace(setHardwareID=lambda _: None, add=functions.__setitem__, force_update=lambda: None)
    link = SimpleNamespace(path='/dev/ttyUSB0', problem='', adapter='', baud=driven.driver.baud, changes=0)
    status = CreateStatus(updater, driven.driver, link, SimpleNamespace(diagnose=lambda _: None))
    status.update()
    return {title: function(DiagnosticStatusWrapper()) for title, function in functions.items()}


@pytest.mark.parametrize('robot, baud', [('create', 57600), ('create2', 115200), ('create2', 19200)])
def test_each_robot_has_a_status_at_each_rate(robot, baud):
    driven = DrivenCreate(robot, baud=baud)
    driven.line.baud = baud
    driven.connect()
    driven.run(3)
    found = statuses(driven)
    values = {each.key: each.value for each in found['Base'].values}
    assert found['Base'].message == 'Stationary' and values['Robot type'] == robot
    # only a Create may lose fractions of a degree
    assert ('Fractions of a degree' in values) == ('Gyro' in found) == (robot == 'create')
