"""The running system, as known to the master: the base, its surface and reset service, and the driving nodes."""
from __future__ import annotations

from threading import Lock, Thread
import time
from typing import Any, Callable

import rosgraph
import rospy
from std_srvs.srv import Empty

from rbx1_nav.ros.network.bases import private_namespace
from rbx1_nav.ros.network.master import Server, call
from rbx1_nav.ros.node import life
from rbx1_nav.ros.web.state import State
from rbx1_nav.ros.web.topics import COMMANDS, Topics

PERIOD = 2.0        # s
RESET_TIMEOUT = 5.0  # s


class System:
    """Queries the master once per PERIOD, and updates the status of the page."""

    def __init__(self, state: State, connected: Callable[[], set[str]], namespace: str = '') -> None:
        """connected(): returns the names of the nodes that receive the commands of this node; namespace: see Topics."""
        self.state = state
        self.namespace = namespace
        self.connected = connected
        self.lock = Lock()
        self.drawn: tuple[str, str] | None = None   # surface and seed, from /diagnostics
        self.topics = Topics(state, self.on_seed, namespace)
        self.reset_service = ''     # '' if there is none
        self.searching = False      # whether the master is being asked for driving nodes
        self.shutting_down: set[str] = set()    # nodes that have not answered yet
        self.stopped: set[str] = set()
        self.silent: set[str] = set()
        self.not_connected = ''     # a base that does not receive the commands of this node, at the last Stop
        self.thread = Thread(target=self._run, daemon=True)

    def start(self) -> None:
        """Start the thread."""
        self.thread.start()

    def on_seed(self, surface: str, seed: str) -> None:
        """Store the surface and the seed that a simulated base reports."""
        self.drawn = surface, seed
        self.state.set_status(surface=surface, seed=seed)

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
        base = self.topics.base if self.state.hears('odometry') else None
        odom = rospy.resolve_name(f'{self.namespace}odom')
        private = private_namespace(base, odom, master.call) if base else ''
        name = f'{private}/reset'
        self.reset_service = name if base and name in services else ''
        self.state.set_status(base=base or '', simulated=self.simulated,
                              can_reset=bool(self.simulated and self.reset_service))
        values: dict[str, Any] = {'surface': '', 'seed': '', 'simulated_time': False}
        if base:
            values['simulated_time'] = bool(_param(master, '/use_sim_time', False))
        if self.simulated and self.topics.truth:
            private = private_namespace(self.topics.truth, odom, master.call)
            values['surface'] = str(_param(master, f'{private}/surface', 'ideal')).rpartition('/')[2]
            values['seed'] = str(_param(master, f'{private}/seed', 'random'))
            if self.drawn and self.topics.truth == base:    # the base itself has reported them
                del values['surface'], values['seed']
        else:
            self.drawn = None
        self.state.set_status(**values)

    def reset(self) -> None:
        """Put a simulated robot back at its start. Raises ROSException or rospy.ServiceException."""
        if not self.reset_service:
            raise rospy.ROSException('the base has no reset service')
        rospy.wait_for_service(self.reset_service, RESET_TIMEOUT)
        rospy.ServiceProxy(self.reset_service, Empty)()

    def forget_frame(self) -> None:
        """Delete the parameter of a run that the page has started, so that it does not affect later runs."""
        call(rosgraph.get_master_uri(), 'deleteParam', rospy.resolve_name(f'{self.namespace}out_and_back/odom_frame'))

    @property
    def pending(self) -> bool:
        """Whether nodes are still being shut down."""
        with self.lock:
            return self.searching or bool(self.shutting_down)

    def shut_down_drivers(self) -> None:
        """Shut down all other nodes that publish the commands, as `rosnode kill` does. Does not wait for them."""
        with self.lock:
            if self.searching:
                return
            self.searching = True
        Thread(target=self._shut_down_drivers, daemon=True).start()

    def _shut_down_drivers(self) -> None:
        publishers: Any = ()
        subscribers: Any = ()
        try:
            publishers, subscribers, _ = call(rosgraph.get_master_uri(), 'getSystemState')
        except Exception as error:
            rospy.logwarn_throttle(5, f'The master does not answer, so Stop may not have reached other driving nodes: '
                                      f'{error}')
            with self.lock:
                self.silent.add('the master')
        topic, base = rospy.resolve_name(f'{self.namespace}{COMMANDS}'), self.topics.base or ''
        names = set(dict(publishers).get(topic, ())) - {rospy.get_name()}
        listening = base in dict(subscribers).get(topic, ())
        with self.lock:
            self.not_connected = base if listening and base not in self.connected() else ''
            names -= self.shutting_down
            self.shutting_down |= names
            self.searching = False
        for name in names:      # a node that hangs must not delay the others
            Thread(target=self._shut_down, args=(name,), daemon=True).start()

    def _shut_down(self, node: str) -> None:
        try:
            uri = call(rosgraph.get_master_uri(), 'lookupNode', node)
            if not uri:
                raise KeyError(node)
            call(uri, 'shutdown', 'stopped from the browser')
            answered = self.stopped
        except (ConnectionError, KeyError):     # the process of the node has exited, so it no longer drives
            answered = set()
        except Exception:       # the node does not answer
            answered = self.silent
        with self.lock:
            self.shutting_down.discard(node)
            answered.add(node)

    def take_shut_down(self) -> tuple[list[str], list[str], str]:
        """Return the nodes that were shut down since the last call, those that did not answer, and the name of a base
        that subscribes to the commands but is not connected, or ''."""
        with self.lock:
            found = sorted(self.stopped), sorted((self.silent | self.shutting_down) - self.stopped), self.not_connected
            self.stopped.clear()
            self.silent.clear()
        return found


def _param(master: Server, name: str, default: object) -> Any:
    return master.call('getParam', name) if master.call('hasParam', name) else default
