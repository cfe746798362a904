"""Nodes that drive by a clock, and the clock that stays in step with them."""
from rbx1_nav.simulation import lockstep
from rbx1_nav.simulation.lockstep import Lockstep

MOVE, FASTER, STOP = (0.2, 0.0), (0.3, 0.0), (0.0, 0.0)


class Nodes:
    """Drivers `a` and `b`, whose processes can be observed; they sleep as soon as `work` is empty."""

    def __init__(self):
        self.drivers = {'a', 'b'}
        self.work = []          # functions, one called at each check; while there are any, a node is awake
        self.never_sleeps = None
        self.looks = 0
        self.driver_looks = 0
        self.woken = set()      # names of the drivers that have woken by themselves
        self.new_upstream = False
        self.off_clock = set()
        self.poll = []          # functions, one called at each call of still_polling()

    def update(self):
        pass

    def connecting(self):
        return False

    def sees(self, name):
        return name in self.drivers

    def on_clock(self, name):
        return name not in self.off_clock

    def note(self, _):
        pass

    def mark(self, _):
        pass

    def woke_by_itself(self, name):
        return name in self.woken

    def awake(self):
        self.looks += 1
        if self.work:
            self.work.pop(0)()
            return 'a'
        return self.never_sleeps

    def awake_drivers(self):
        self.driver_looks += 1
        return self.never_sleeps

    def polling(self):
        return list(self.poll)

    def still_polling(self, _):
        if self.poll:
            self.poll.pop()()
        return bool(self.poll)

    def forget(self, name):
        self.drivers.discard(name)
        if self.never_sleeps == name:
            self.never_sleeps = None

    def update_upstream(self):
        return self.new_upstream

    def connected(self, _):
        return True

    def unread(self, _):
        return False


class World:
    """A Lockstep, and the commands with the ticks at which they took effect."""

    def __init__(self, report=None):
        self.applied = []
        self.reports = []
        self.nodes = Nodes()
        self.lockstep = Lockstep(lambda command: self.applied.append((self.lockstep.tick, command)),
                                 report or (lambda *each: self.reports.append(each)), self.nodes, lambda: False)

    def send(self, name, command):
        self.lockstep.receive(name, name, command)

    def send_unprompted(self):
        """Send enough commands between two ticks to release the driver."""
        for _ in range(lockstep.UNPROMPTED):
            self.send('a', MOVE)

    def tick(self, *commands):
        """Make a tick that is answered with these commands, each (name, command)."""
        self.lockstep.begin_tick()
        self.nodes.work += [lambda each=each: self.send(*each) for each in commands]
        self.lockstep.end_tick()

    def drive(self, *ticks, name='a', until=40):
        """Let a driver send MOVE at these ticks, counted from the next one."""
        begin = self.lockstep.tick + 1
        for tick in range(until):
            self.tick(*[(name, MOVE)] * (tick in ticks))
        return begin
