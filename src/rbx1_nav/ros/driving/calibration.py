"""What the calibration scripts read from the master, and keep there: the base's factors, and the last run."""
from __future__ import annotations

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from rosgraph.names import is_legal_name
import rospy

from rbx1_nav.config import ConfigError, Section, YamlValue, show
from rbx1_nav.parameters import custom, frame, number
from rbx1_nav.robot.calibration import MAX_FACTOR


def check_node_name(value: YamlValue) -> str:
    """The value of ~base_node, the name of a node. Raises ConfigError."""
    if not (isinstance(value, str) and value and is_legal_name(value)):
        raise ConfigError(f'base_node: {show(value)}: expected the name of a node')
    return value


# of both scripts
PARAMETERS = (
    number('rate', 50, 'Hz', 'commands per second', 2, 1000),
    frame('odom_frame', 'odom', 'frame of the odometry'),
    frame('base_frame', None, 'frame of the robot', shown='base_footprint or base_link, whichever exists'),
    custom('base_node', 'turtlebot_node', 'node whose parameters are calibrated', check_node_name))


class Diagnosis:
    """Listens for what a base says of one of its parts in /diagnostics."""

    def __init__(self, base_node: str, part: str) -> None:
        """base_node: the name of a node; part: Base, Gyro, or the like."""
        self.name = f"{rospy.resolve_name(base_node).lstrip('/')}: {part}"
        self.last: DiagnosticStatus | None = None       # None before there is one
        rospy.Subscriber('/diagnostics', DiagnosticArray, self._on_diagnostics)

    def _on_diagnostics(self, message: DiagnosticArray) -> None:
        self.last = next((status for status in message.status if status.name == self.name), self.last)

    def value(self, key: str) -> str | None:
        """The last value with this key, a text; None if there is none."""
        return next((each.value for each in self.last.values if each.key == key), None) if self.last else None

    @property
    def error(self) -> str:
        """The message of the last status if that is an error, else ''."""
        return self.last.message if self.last and self.last.level == DiagnosticStatus.ERROR else ''


def factor_in_force(base_node: str, key: str, default: float | None = 1.0) -> float | None:
    """The correction factor `key` among the parameters of the base's node; its default if it is not set.

    Raises ROSException if it is no such factor.
    """
    name = rospy.resolve_name(base_node)
    values = rospy.get_param(name, None)
    if not isinstance(values, dict):
        rospy.logwarn('%s has no parameters: the default is assumed for %s. _base_node:=NAME names the node of '
                      'another base',
                      name, key)
        return default
    if key not in values:
        return default
    return _number(Section(values, name), key, 1 / MAX_FACTOR, MAX_FACTOR, 'the factor that the base uses now')


def save_run(name: str, run: dict[str, float]) -> None:
    """Keep what a run reported, a mapping: the result may be measured later, or told from another terminal."""
    try:
        rospy.set_param(_stored(name), run)
    except OSError as error:
        rospy.logwarn('The master does not answer, and does not keep this run: %s', error)


def forget_run(name: str) -> None:
    """Forget the last run: another one begins, and may be interrupted."""
    if rospy.has_param(_stored(name)):
        rospy.delete_param(_stored(name))


def load_run(name: str, *keys: str) -> dict[str, float]:
    """What the last run reported: a mapping with at least these keys. Raises ROSException if there is none."""
    run = rospy.get_param(_stored(name), None)
    if not isinstance(run, dict):
        raise rospy.ROSException(f'{rospy.resolve_name(_stored(name))}: missing: expected a run before this one, '
                                 'without '
                                 '_measured:=, that was not interrupted')
    section = Section(run, rospy.resolve_name(_stored(name)))
    return {key: _number(section, key, -1e6, 1e6) for key in {*keys, *run}}


def take_measured() -> object:
    """The parameter ~measured, or None. It is removed from the master: the next run has another result."""
    measured = rospy.get_param('~measured', None)
    if measured is not None:
        rospy.delete_param('~measured')
    return measured


def _stored(name: str) -> str:
    # not private: the master would then list it among the parameters that an earlier command has left
    return 'last_calibration/' + name


def _number(section: Section, key: str, low: float, high: float, what: str = 'a number') -> float:
    try:
        return section.number(key, low, high, what=what)
    except ConfigError as error:
        raise rospy.ROSException(str(error)) from None
