"""The runs that the page requests: the exercise with one of its methods, or a script of the user."""
from __future__ import annotations

import json
import sys
import threading
from time import monotonic
import traceback
from types import FrameType
from typing import Any, Callable, Mapping

from rbx1_nav.base.robot_parameters import read_robot
from rbx1_nav.base.surfaces import read_surface
from rbx1_nav.exercise.legs import StuckError
from rbx1_nav.exercise.methods import METHODS
from rbx1_nav.extras.many_runs.simulated_run import CALIBRATION, EXERCISE, PARAMETERS, run
from rbx1_nav.extras.page.recorded_run import ERROR, INFO, RecordedSimulation, Stopped
from rbx1_nav.extras.page.rospy_stand_in import ROSException, ROSInterruptException, Rospy
from rbx1_nav.extras.web.choices import CHOICES, DEFAULTS, SCRIPTS, read_choice
from rbx1_nav.simulation.slip import read_seed

SCRIPT = 'script'       # name of the script in tracebacks, and of its run
PATIENCE = 2.0          # s of wall time without a sleep after which a script is ended


def describe_page(config: Mapping[str, Any]) -> str:
    """Return what the page can choose, as JSON. config: see run_request()."""
    return json.dumps({
        'surfaces': list(config['surfaces']), 'choices': CHOICES, 'defaults': DEFAULTS, 'scripts': SCRIPTS,
        'titles': {SCRIPT: SCRIPT, **{name: each.title for name, each in METHODS.items()}}})


def choose(config: Mapping[str, Any], name: str, text: str) -> Any:
    """Return the value of a choice, given as text. Raises ValueError with what was expected."""
    value = read_choice(name, text, list(config['surfaces']))
    return read_seed(value) if name == 'seed' else value


class Busy(BaseException):
    """Raised in a script that does not sleep. Not an Exception, so that `except Exception` does not catch it."""


def run_request(config: Mapping[str, Any], text: str) -> str:
    """Run what a request asks for, and return the frames of the run as a JSON list.

    config: parameters of the robot, and the surfaces by name, as in the YAML files; text: a JSON object with method (of
    METHODS, or SCRIPT with its `text`), surface, seed, parameters, stop (s, or null), as_one_frame.
    """
    request = json.loads(text)
    method, parameters = METHODS.get(request['method']), {**PARAMETERS, **request['parameters']}
    title = method.title if method else SCRIPT
    simulation = RecordedSimulation(
        read_robot(config['robot']), read_surface(config['surfaces'][request['surface']], request['surface']),
        request['seed'], EXERCISE['rate'], title, request['stop'], request['as_one_frame'])
    if method:
        simulation.finish(run_method(simulation, method.name, parameters))
    else:
        simulation.finish(run_script(simulation, request['text'], request['parameters']))
    return f"[{','.join(simulation.frames)}]"


def run_method(simulation: RecordedSimulation, method: str, parameters: Mapping[str, float]) -> str:
    """Run the exercise, and return the outcome."""
    try:
        run(simulation, method, parameters)
    except Stopped:
        simulation.base.command(simulation.now, 0.0, 0.0)
        simulation.come_to_rest()
    except (StuckError, ValueError) as error:
        simulation.log(ERROR, str(error))
        return 'failed; see the log'
    return 'finished'


class Watch:
    """A trace function that ends a script if it does not sleep for PATIENCE."""

    def __init__(self, simulation: RecordedSimulation) -> None:
        self.simulation = simulation
        self.slept, self.time = simulation.now, monotonic()

    def __call__(self, frame: FrameType, event: str, _: object) -> Any:
        if frame.f_code.co_filename != SCRIPT:
            return None
        frame.f_trace_opcodes = True    # a loop in a single line has no other events
        if self.slept != self.simulation.now:
            self.slept, self.time = self.simulation.now, monotonic()
        elif monotonic() - self.time > PATIENCE:
            raise Busy(f'no rospy.sleep() or Rate.sleep() for {PATIENCE:g} s: simulated time passes only in these')
        return self


def describe(error: BaseException) -> str:
    """Return an error as one line with the line number of the script."""
    lines = [each.lineno for each in traceback.extract_tb(error.__traceback__) if each.filename == SCRIPT]
    line = error.lineno if isinstance(error, SyntaxError) else lines[-1] if lines else None
    if isinstance(error, ModuleNotFoundError):
        text = f'the module {error.name} does not exist on this page'
    elif isinstance(error, SyntaxError):
        text = f'syntax error: {error.msg}'
    elif isinstance(error, (Busy, NotImplementedError, ROSException)):
        text = str(error)
    else:
        text = f'{type(error).__name__}: {error}'
    return f'line {line}: ' + ' '.join(text.split())


def no_threads(*_: object) -> None:
    raise NotImplementedError('threads do not exist on this page')


def run_script(simulation: RecordedSimulation, text: str, parameters: Mapping[str, Any]) -> str:
    """Run a script as rosrun does, with the stand-in for rospy, and return the outcome."""
    simulation.rest(CALIBRATION)
    modules, start_thread = dict(sys.modules), threading.Thread.start
    ros = Rospy(simulation, simulation.log, dict(parameters))
    outcome = 'finished'

    def show(*values: object, **_: object) -> None:
        simulation.log(INFO, ' '.join(map(str, values)))

    def call(function: Callable[[], object]) -> None:
        nonlocal outcome
        sys.settrace(Watch(simulation))
        try:
            function()
        except (SystemExit, ROSInterruptException, Stopped):
            pass
        except BaseException as error:
            simulation.log(ERROR, describe(error))
            outcome = 'failed; see the log'
        finally:
            sys.settrace(None)
    try:
        setattr(threading.Thread, 'start', no_threads)
        call(lambda: exec(compile(text, SCRIPT, 'exec'), {'__name__': '__main__', 'print': show}))
        call(ros.shutdown)
    finally:
        setattr(threading.Thread, 'start', start_thread)
        sys.modules.clear()
        sys.modules.update(modules)
    simulation.come_to_rest()
    return outcome
