"""1 % of the bytes from an emulated Create or Create 2 are corrupted for a whole run."""
import support
from driven import CHI_SQUARE, IDEAL, DrivenRobot

FAULT = '1 % of the bytes from a Create 2 or a Create are flipped, dropped or duplicated during the exercise'
PROMISE = ('Create 2: the final odometry is within 5 cm of the truth; Create: the covariance covers the error; lost '
           'replies are counted')
FULL, SHORT = 10, 0
ROOT = ALONE = False

LIMIT = 0.05        # m


def check_create_2(row, robot):
    """A corrupted reading is corrected by the next one."""
    x, y, _ = robot.error()
    row.figure('Create 2: error (m)', (x * x + y * y) ** 0.5)
    row.figure('Create 2: lost replies', robot.value('Serial line', 'Lost replies'))
    row.figure('Create 2: implausible readings', robot.value('Serial line', 'Implausible readings'))
    assert (x * x + y * y) ** 0.5 < LIMIT, (x, y)
    assert int(robot.value('Serial line', 'Lost replies')) > 10


def check_create(row, robot):
    """Some corrupted replies are not noticed."""
    x, y, _ = robot.error()
    error = robot.normalized_error()
    row.figure('Create: error (m)', (x * x + y * y) ** 0.5)
    row.figure('Create: normalized squared error', error)
    assert error < CHI_SQUARE, f'squared error {error:.1f} of {robot.error()}'
    assert int(robot.value('Serial line', 'Lost replies')) > 10


def run(row):
    """See FAULT."""
    row.roscore()
    support.init_node('faults')
    for index in range(row.times):
        robot_type, check = [('create2', check_create_2), ('create', check_create)][index % 2]
        seed = row.random.randrange(10 ** 6)
        with row.case('%s, seed %d' % (robot_type, seed)) as case:
            robot = DrivenRobot(case, robot_type, {'corruption': 0.01, 'seed': seed}, **IDEAL)
            driver = row.node('timed_out_and_back.py')
            assert driver.wait() == 0, driver.output
            check(row, robot)
