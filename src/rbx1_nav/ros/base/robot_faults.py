"""Services and topics that trigger events on an emulated robot, such as a pulled cable or a dropped wheel."""
from __future__ import annotations

from concurrent.futures import Future
from math import floor
import queue
from typing import Callable

import rospy
from std_msgs.msg import Float64
from std_srvs.srv import SetBool, SetBoolResponse, Trigger, TriggerResponse

from rbx1_nav.config import ConfigError, Section
from rbx1_nav.create.emulator.body import CAPACITY
from rbx1_nav.create.emulator.emulator import EmulatedCreate
from rbx1_nav.create.emulator.pseudo_terminal import PseudoTerminal
from rbx1_nav.parameters import read
from rbx1_nav.ros.base.parameters import FAKE_CREATE
from rbx1_nav.ros.node import life


class RobotFaults:
    """The services and topics. Requests take effect when the thread that owns the robot calls apply()."""

    def __init__(self, robot: EmulatedCreate, terminal: PseudoTerminal) -> None:
        # functions to be called, each with a Future for its result: an error text, or ''
        self.requests: queue.Queue[tuple[Callable[[], object], Future[str]]] = queue.Queue()
        body, line = robot.body, robot.line
        for name, switch in [('pull_cable', lambda on: terminal.unplug() if on else terminal.plug()),
                             ('silence', lambda on: setattr(line, 'silent', on)),
                             ('drop_wheel', lambda on: setattr(body, 'wheel_dropped', on)),
                             ('cliff', lambda on: setattr(body, 'cliff', on)),
                             ('bump', lambda on: setattr(body, 'bumped', on)),
                             ('dock', lambda on: setattr(body, 'docked', on)),
                             ('charging_fault', lambda on: setattr(body, 'charging_fault', on))]:
            self._offer_switch(name, switch)
        rospy.Service('~power_cycle', Trigger, lambda _: TriggerResponse(
            *self._request('power_cycle', lambda: robot.switch_on(robot.now))))
        self._offer_number('charge', lambda value: setattr(body, 'charge', value * CAPACITY))
        self._offer_number('battery_temperature', lambda value: setattr(body, 'temperature', round(value)))
        self._offer_number('battery_voltage', lambda value: setattr(body, 'voltage', round(1000 * value)))
        self._offer_number('corruption', lambda value: setattr(line, 'corruption', value))
        self._offer_number('gyro_stuck', lambda value: setattr(body, 'gyro_stuck', floor(value)))

    def apply(self) -> None:
        """Execute all pending requests."""
        while not self.requests.empty():
            function, done = self.requests.get()
            try:
                function()
                done.set_result('')
            except ConfigError as error:    # the link cannot be created any more
                done.set_result(str(error))

    def _offer_switch(self, name: str, switch: Callable[[bool], None]) -> None:
        rospy.Service(f'~{name}', SetBool, lambda request: SetBoolResponse(
            *self._request(f'{name}: {request.data}', lambda: switch(request.data))))

    def _offer_number(self, name: str, function: Callable[[float], None]) -> None:
        """Offer a topic that changes the parameter with this name."""
        parameter = next(each for each in FAKE_CREATE if each.name == name)

        def on_message(message: Float64) -> None:
            try:
                read([parameter], Section({name: message.data}, rospy.get_name()))
            except ConfigError as error:
                rospy.logerr('%s; rejected', error)
            else:
                self._request(f'{name}: {message.data:g}', lambda: function(message.data))
        rospy.Subscriber(f'~{name}', Float64, on_message)

    def _request(self, text: str, function: Callable[[], object]) -> tuple[bool, str]:
        """Request a call of a function and wait for it; return whether it succeeded, and the text that is logged."""
        done: Future[str] = Future()
        self.requests.put((function, done))
        while not done.done():
            if life.end_requested.is_set():
                return False, f'{text}: the node is shutting down'
            life.sleep(0.001)
        if done.result():
            rospy.logerr('%s: %s', text, done.result())
            return False, f'{text}: {done.result()}'
        rospy.loginfo('%s', text)
        return True, text
