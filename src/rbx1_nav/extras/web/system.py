"""The running system: what its topics and the master report of the base, its surface and the driving nodes.

The load from each topic is bounded.
"""
from __future__ import annotations

from collections import deque
from threading import Event, Lock, Thread
import time
from typing import Any, Callable, Mapping, Sequence

from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
import rosgraph
from rosgraph_msgs.msg import Log
import rospy
from std_msgs.msg import Empty
from std_srvs.srv import Empty as EmptyService

from rbx1_nav.base import messages
from rbx1_nav.base.running_bases import private_namespace
from rbx1_nav.base.surfaces import known_surfaces
from rbx1_nav.extras.web.choices import DEFAULTS, SCRIPTS
from rbx1_nav.extras.web.hand_drive import COMMANDS
from rbx1_nav.extras.web.state import BY_HAND, REST, PageState, PoseAndSpeed
from rbx1_nav.node import life, resources
from rbx1_nav.node.master import Server, call

TOPICS = {'truth': 'ground_truth', 'odometry': 'odom', 'estimate': 'odom_ekf'}
MIN_PERIOD = 0.02   # s: only the latest of the messages that arrive in this time is read
REST_PERIOD = 0.1   # s: further time between the poses of a robot that rests; until a command, which moves it, arrives
REST_TIME = 1.0     # s without a motion or a command to move, after which the robot rests
COMMAND_PERIOD = 0.01   # s; short, because a driving script detects a subscriber that does not read
BUFFER = 2 ** 20    # bytes: more than arrives in MIN_PERIOD at 50 times real time
PERIOD = 2.0        # s
RESET_TIMEOUT = 5.0  # s


def subscribe(topic: str, kind: type, callback: Callable[..., None], args: Any = None,
              queue_size: int = 1) -> rospy.Subscriber:
    """Subscribe to a topic. The callbacks may sleep: rospy has one thread for each connection, and drops messages
    that are not read in time, so neither other topics nor the publishers are delayed."""
    return rospy.Subscriber(topic, kind, callback, args, queue_size=queue_size, buff_size=BUFFER, tcp_nodelay=True)


class System:
    """Subscribes to the topics, queries the master once per PERIOD, and updates the state of the page."""

    def __init__(self, state: PageState, namespace: str = '', choices: Sequence[str] = ()) -> None:
        """namespace: of the robot, with a slash at the end, '' for the namespace of this node; choices: what a learner
        can choose, see choices.py."""
        self.state = state
        self.namespace = namespace
        self.choices = choices
        self.surfaces = known_surfaces(resources.surfaces())
        state.set_status(choices=choices, surfaces=self.surfaces, **DEFAULTS)
        self.lock = Lock()
        self.drawn: tuple[str, str] | None = None   # surface and seed, from /diagnostics
        self.base: str | None = None    # the node that publishes the odometry
        self.connections: deque[object] = deque(maxlen=10)  # the latest ones to publishers of odometry
        self.truth: str | None = None   # the node that publishes the ground truth
        self.private = ''       # namespace of the base that publishes the odometry
        self.reset_service = ''     # '' if there is none
        self.searching = False      # whether the master is being asked for driving nodes
        self.shutting_down: set[str] = set()    # nodes that have not answered yet
        self.stopped: set[str] = set()
        self.silent: set[str] = set()
        self.moving = Event()
        self.moved = 0.0        # s, monotonic clock
        self.thread = Thread(target=self._run, daemon=True)

    def start(self) -> None:
        """Subscribe to the topics, and start the thread."""
        for source, topic in TOPICS.items():
            subscribe(f'{self.namespace}{topic}', Odometry, self.on_odometry, source)
        self.commands = subscribe(f'{self.namespace}{COMMANDS}', Twist, self.on_command)
        subscribe(f'{self.namespace}reset_odometry', Empty, self.on_reset)
        subscribe('/diagnostics', DiagnosticArray, self.on_diagnostics, queue_size=5)
        # the log of all nodes, over one connection to rosout instead of one to each node
        subscribe('/rosout_agg', Log, self.on_log, queue_size=50)
        self.thread.start()

    def on_odometry(self, message: Odometry, source: str) -> None:
        pose, twist = message.pose.pose, message.twist.twist
        sender = message._connection_header['callerid']
        if source == 'odometry':
            self.base = sender
            connection = message._connection_header     # one object per connection
            if all(connection is not each for each in self.connections):
                self.connections.append(connection)
                self.state.connected()
        elif source == 'truth':
            self.truth = sender
        self.state.move(source, PoseAndSpeed(
            message.header.stamp.to_sec(), (pose.position.x, pose.position.y, messages.yaw_of(pose.orientation)),
            twist.linear.x, twist.angular.z), time.monotonic())
        self._note_motion(max(abs(twist.linear.x), abs(twist.angular.z)) > REST)
        time.sleep(MIN_PERIOD)
        self.moving.wait(REST_PERIOD)

    def _note_motion(self, moves: bool) -> None:
        now = time.monotonic()
        if moves:
            self.moved = now
            self.moving.set()
        elif now - self.moved > REST_TIME:
            self.moving.clear()

    def on_command(self, twist: Twist) -> None:
        sender = twist._connection_header['callerid']
        self.state.command(twist.linear.x, twist.angular.z, BY_HAND if sender == rospy.get_name() else sender,
                           time.monotonic())
        if twist.linear.x or twist.angular.z:
            self._note_motion(True)
        time.sleep(COMMAND_PERIOD)

    def on_reset(self, _: Empty) -> None:
        self.state.reset(time.monotonic())

    def on_diagnostics(self, array: DiagnosticArray) -> None:
        """Process the diagnostics of a base, which arrive once per second."""
        namespace = (self.namespace or rospy.get_namespace()).rstrip('/')
        for status in array.status:
            if f"/{status.name.rpartition('/')[0]}".rstrip('/') != namespace:
                continue        # it belongs to another robot
            values = {each.key: each.value for each in status.values}
            if 'Surface' in values and 'Seed' in values:
                self.drawn = values['Surface'], values['Seed']
                self.state.set_status(surface=values['Surface'], seed=values['Seed'])
        time.sleep(MIN_PERIOD)

    def on_log(self, line: Log) -> None:
        if line.level >= Log.INFO:
            self.state.log_line(line.level, line.header.stamp.to_sec(), line.name, line.msg)
        time.sleep(MIN_PERIOD)

    @property
    def simulated(self) -> bool:
        """Whether messages arrive on ground_truth, which only a simulated robot has."""
        return self.state.hears('truth')

    def _run(self) -> None:
        server = Server(rosgraph.get_master_uri())
        while not life.end_requested.is_set():
            try:
                self._ask(server)
            except Exception:
                self.state.set_status(master='silent')
            end = time.monotonic() + PERIOD
            while time.monotonic() < end and not life.end_requested.is_set():
                life.sleep(end - time.monotonic())

    def _ask(self, master: Server) -> None:
        _, subscribers, offered = master.call('getSystemState')
        # a master that was restarted does not know the nodes of the old one, and no node can join it later
        known = any(rospy.get_name() in names for _, names in subscribers)
        self.state.set_status(master='' if known else 'restarted')
        services = {name for name, _ in offered}
        base = self.base if self.state.hears('odometry') else None
        odom = rospy.resolve_name(f'{self.namespace}odom')
        self.private = private = private_namespace(base, odom, master) if base else ''
        name = f'{private}/reset'
        self.reset_service = name if base and name in services else ''
        self.state.set_status(base=base or '', simulated=self.simulated,
                              can_reset=bool(self.simulated and self.reset_service))
        values: dict[str, Any] = {'surface': '', 'seed': '', 'simulated_time': False}
        if base:
            values['simulated_time'] = bool(master.param('/use_sim_time', False))
        if not (self.simulated and self.truth):
            self.drawn = None
        elif self.drawn and self.truth == base:     # the base itself has reported them
            del values['surface'], values['seed']
        else:
            private = private_namespace(self.truth, odom, master)
            values['surface'] = str(master.param(f'{private}/surface', 'ideal')).rpartition('/')[2]
            values['seed'] = str(master.param(f'{private}/seed', 'random'))
        scripts = master.param(self._of_scripts(''), {})
        for choice, name in SCRIPTS.items():
            values[choice] = scripts.get(name, DEFAULTS[choice])
        self.state.set_status(**values)

    def _of_scripts(self, name: str) -> str:
        """Return the full name of a parameter of the driving scripts."""
        return str(rospy.resolve_name(f'{self.namespace}out_and_back/{name}'))

    def choose(self, name: str, value: str | float) -> None:
        """Set the parameter of a choice. Raises OSError and the exceptions of xmlrpc."""
        key = self._of_scripts(SCRIPTS[name]) if name in SCRIPTS else f'{self.private}/{name}'
        if value == DEFAULTS.get(name):     # a script warns of parameters of earlier runs
            call(rosgraph.get_master_uri(), 'deleteParam', key)
        else:
            call(rosgraph.get_master_uri(), 'setParam', key, value)
        if name in SCRIPTS:
            self.state.set_status(**{name: value})

    def reset(self) -> None:
        """Put a simulated robot back at its start. Raises ROSException or rospy.ServiceException."""
        if not self.reset_service:
            raise rospy.ROSException('the base has no reset service')
        rospy.wait_for_service(self.reset_service, RESET_TIMEOUT)
        rospy.ServiceProxy(self.reset_service, EmptyService)()

    def forget_frame(self) -> None:
        """Delete the parameter of a run that the page has started, so that it does not affect later runs."""
        call(rosgraph.get_master_uri(), 'deleteParam', self._of_scripts('odom_frame'))

    @property
    def pending(self) -> bool:
        """Whether nodes are still being shut down."""
        with self.lock:
            return self.searching or bool(self.shutting_down)

    def shut_down_drivers(self) -> None:
        """Shut down all other nodes that publish the commands, as `rosnode kill` does. Does not wait for them."""
        self.searching = True
        Thread(target=self._shut_down_drivers, daemon=True).start()

    def _shut_down_drivers(self) -> None:
        # without the master, those that are connected
        self._shut_down({each.callerid_pub: each.endpoint_id for each in self.commands.impl.connections})
        try:
            publishers, _, _ = call(rosgraph.get_master_uri(), 'getSystemState')
            topic = rospy.resolve_name(f'{self.namespace}{COMMANDS}')
            self._shut_down(dict.fromkeys(dict(publishers).get(topic, ())))
        except Exception as error:
            with self.lock:
                self.silent.add('the master')
            rospy.logwarn_throttle(5, f'The master does not answer, so Stop may not have reached other driving nodes: '
                                      f'{error}')
        finally:
            self.searching = False

    def _shut_down(self, addresses: Mapping[str, str | None]) -> None:
        """Shut down nodes. addresses: XMLRPC addresses by the names of the nodes; None: the master knows it."""
        with self.lock:
            names = set(addresses) - self.shutting_down - {rospy.get_name()}
            self.shutting_down |= names
        for name in names:      # a node that hangs must not delay the others
            Thread(target=self._shut_down_node, args=(name, addresses[name]), daemon=True).start()

    def _shut_down_node(self, node: str, address: str | None) -> None:
        try:
            address = address or call(rosgraph.get_master_uri(), 'lookupNode', node)
            if not address:
                raise KeyError(node)
            call(address, 'shutdown', 'stopped from the browser')
            answered = self.stopped
        except (ConnectionError, KeyError):     # the process of the node has exited, so it no longer drives
            answered = set()
        except Exception:       # the node does not answer
            answered = self.silent
        with self.lock:
            self.shutting_down.discard(node)
            answered.add(node)

    def take_shut_down(self) -> tuple[list[str], list[str]]:
        """Return the nodes that were shut down since the last call, and those that did not answer, at least once: rospy
        answers a second request at once, although it waits for the master before the node stops."""
        with self.lock:
            silent = self.silent | self.shutting_down
            found = sorted(self.stopped - silent), sorted(silent)
            self.stopped.clear()
            self.silent.clear()
        return found
