"""Finds the robot, starts it, notices when it falls silent, and gets it back. All times are in ns."""
from rbx1_nav.config import AUTO
from rbx1_nav.create import protocol
from rbx1_nav.create.driver import sequences
from rbx1_nav.create.driver.search import RATES, Search
from rbx1_nav.units import SECOND

SILENCE = SECOND // 2           # without a reading: the robot does not answer
FLUSH_WAIT = SECOND // 10       # without an answer to a stop, after which garbage may have swallowed it
FIRST_WAIT = 3 * SECOND // 10   # that a robot that is on may need to answer, before it is started
START_WAIT = SECOND             # that a robot may need to start, before it is searched for
ROUNDS_BEFORE_WARNING = 2                    # rounds of the search before the first warning


class Contact:
    """Whether the robot at the other end of the line answers, and what is tried to make it answer.

    The line has the methods that Search needs, confirm(found): a robot was found, from now on its guardian may stop it, and
    is_same: whether it is on the same adapter as the one before.
    """

    def __init__(self, settings, driver, warn):
        """settings: Settings; driver: has use(model), ask(now, start), lost_robot() and a Sender; warn(text): logs a line."""
        self.settings = settings
        self.driver = driver
        self.warn = warn
        self.line = None
        self.found = None           # Found: the robot of this line, also while it does not answer
        self.answers = False        # whether readings arrive
        self.started = False        # whether the robot was started since it last answered
        self.dropouts = 0           # times that the robot fell silent
        self.search = Search((settings.baud,) if settings.baud else RATES, settings.wake)
        self.searching = False
        self._flushed = False
        self._attempt = None        # when the robot was last asked to answer
        self._refused = None        # a Found of the wrong type
        self._warned = False        # that no robot answers

    def attach(self, now, line):
        """A line was opened. The first bytes on it are a stop if the robot is known, else those of the search."""
        self.line = line
        self.answers = False
        if not (self.found and line.is_same):
            self._begin_search(now)
            return
        self.searching = False
        line.confirm(self.found)
        self._begin_asking(now)

    def detach(self):
        """The line is lost."""
        self.line = None
        self._lose()

    def receive(self, now, data):
        """Process bytes of a robot that is searched for."""
        self.search.receive(now, data)

    def tick(self, now, reading_time):
        """Do what is due. reading_time: when the robot made the last reading."""
        if not self.line:
            return
        if self.searching:
            self._finish_search(now, self.search.tick(now))
            self._warn_of_silence()
        elif self.answers:
            if now - reading_time > SILENCE:
                self._fall_silent(now)
        elif self.started:
            if now - self._attempt > START_WAIT:
                self._begin_search(now)
        elif now - self._attempt > FIRST_WAIT:
            self._start(now)
        elif now - self._attempt > FLUSH_WAIT and not self._flushed:
            self._flush(now)

    @property
    def may_ask(self):
        """Whether there is a line to a robot whose rate is known: then any command may be sent."""
        return self.line is not None and self.found is not None and not self.searching

    def hear(self):
        """A reading has arrived. Returns whether the robot did not answer before."""
        before, self.answers, self.started = self.answers, True, False
        return not before

    def _lose(self):
        self.dropouts += self.answers
        self.answers = False

    def _begin_asking(self, now):
        self._attempt, self.started, self._flushed = now, False, False
        self.line.set_rate(self.found.baud)     # another process may have changed it
        self.driver.sender.stop(now)
        if self.driver.polled:
            self.driver.ask(now)
        else:
            self._flush(now)        # a robot that sends a stream need not hear anything

    def _flush(self, now):
        self._flushed = True
        self.line.write(sequences.FLUSH)
        self.driver.sender.stop(now)
        self.driver.ask(now)

    def _start(self, now):
        self._attempt, self.started = now, True
        self.driver.sender.stop(now)
        self.driver.ask(now, start=True)

    def _fall_silent(self, now):
        self._lose()
        self.driver.lost_robot()
        self.warn('The robot has stopped responding. If it is still moving, stop it by hand: it keeps executing its last '
                  'command')
        self._begin_asking(now)

    # the search

    def _begin_search(self, now):
        self.searching = True
        self.search.begin(now, self.line, (self.found or self.settings.model).baud)

    def _finish_search(self, now, found):
        if not found:
            return
        before = self.found.model.name if self.found else self.settings.robot_type
        if before not in (AUTO, found.model.name):
            self._refuse(found, before)
            self.search.wait(now, START_WAIT)
            return
        self.searching, self._refused, self.found = False, None, found
        self.driver.use(found.model)
        self.line.confirm(found)
        self._start(now)

    def _refuse(self, found, before):
        if found == self._refused:
            return
        self._refused = found
        if self.found:
            self.warn('A %s answers at %d baud, in place of a %s: restart this node to drive it'
                      % (found.model.name, found.baud, before))
        else:
            self.warn('robot_type: %s: a %s answers at %d baud: expected robot_type:=%s, or auto'
                      % (before, found.model.name, found.baud, found.model.name))

    def _warn_of_silence(self):
        if self.search.rounds >= ROUNDS_BEFORE_WARNING and not self._warned and not self.found and not self._refused:
            self._warned = True
            self.warn('No robot answers at %s baud: expected a Create, Create 2 or Roomba that is switched on and connected'
                      % ', '.join(map(str, self.search.rates)))
