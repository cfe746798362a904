"""Nodes that drive by a clock, and the clock that stays in step with them."""
from types import SimpleNamespace

from rosgraph_msgs.msg import Clock

from rbx1_nav.extras.lockstep import lockstep
from rbx1_nav.extras.lockstep.lockstep import Lockstep

MOVE, FASTER, STOP = (SimpleNamespace(linear=speed, angular=0.0) for speed in (0.2, 0.3, 0.0))


class Connection:
    """A connection to a subscriber, which runs a function when it receives a message."""

    _queue = ()

    def __init__(self, name, on_message):
        self.endpoint_id = name
        self.on_message = on_message

    def write_data(self, _):
        self.on_message()


class Processes:
    """The drivers a, b and the source s; they sleep as soon as `work` is empty."""

    def __init__(self):
        self.drivers, self.own_name = {'a', 'b'}, 'base'
        self.work = []          # functions, one called at each look; while there are any, a node is awake
        self.never_sleeps = None
        self.looks = 0
        self.obstacles = {}
        self.starting = {}
        self.forgotten = {}
        self.new_source = False
        self.processes = {}

    def update(self):
        return False

    def waits_for(self):
        self.looks += 1
        if self.work:
            self.work.pop(0)()
            return 'a'
        return self.never_sleeps

    def forget(self, name):
        self.drivers.discard(name)
        if self.never_sleeps == name:
            self.never_sleeps = None
        return name != 'starting'

    def is_connected(self, _):
        return True

    def obstacle(self, name):
        return self.obstacles.get(name)

    def find_sources(self):
        return self.new_source

    def groups(self, topic):
        return [([each], each.endpoint_id != 'recorder')
                for each in sorted(topic.connections, key=lambda each: each.endpoint_id != 'recorder')]


class World:
    """A Lockstep; `applied` has the commands with the ticks at which they took effect."""

    def __init__(self, monkeypatch, report=None):
        self.applied, self.reports, self.sleeps, self.lines, self.tests = [], [], [], [], []
        self.processes = Processes()
        self.headers = {name: {'callerid': name} for name in 'ab'}
        self.lockstep = Lockstep(self.processes, report or (lambda *each: self.reports.append(each)), lambda: False)
        self.now = 100.0
        self.target = SimpleNamespace(apply=lambda command: self.applied.append((self.lockstep.tick, command)))
        monkeypatch.setattr(lockstep, 'monotonic', lambda: self.now)
        monkeypatch.setattr(lockstep, 'sleep', self.sleep)
        monkeypatch.setattr(lockstep, 'find_pollers', lambda *_: self.tests.append(self.now))
        monkeypatch.setattr(lockstep.rospy, 'loginfo', lambda text, *values: self.lines.append(text % values))

    def sleep(self, seconds):
        self.sleeps.append(seconds)
        self.now += seconds

    def send(self, name, command):
        self.lockstep.receive(self.target, self.headers[name], command)

    def deliver(self, *connections, message=Clock()):
        self.lockstep.deliver(SimpleNamespace(impl=SimpleNamespace(connections=connections, seq=0)), message)

    def tick(self, *commands, listen=0.001):
        """Make a tick that is answered with these commands, each (name, command); listen: s."""
        self.lockstep.begin()
        self.lockstep.apply()
        self.deliver(Connection('a', lambda: self.processes.work.extend(
            [lambda each=each: self.send(*each) for each in commands])))
        self.lockstep.apply()
        self.lockstep.listen(self.now + listen)

    def drive(self, count, listen=0.001):
        """Let a driver send MOVE at so many ticks."""
        for _ in range(count):
            self.tick(('a', MOVE), listen=listen)
