"""Compares a running base with the URDF model of its robot and with what is published, and logs what does not match."""
from __future__ import annotations

from collections import Counter
from functools import partial
from http.client import HTTPException
import threading
from typing import Any, NamedTuple
import xmlrpc.client

import rosgraph
import rospy
from diagnostic_msgs.msg import DiagnosticStatus
from diagnostic_updater import DiagnosticStatusWrapper, Updater
from sensor_msgs.msg import JointState
from tf2_msgs.msg import TFMessage

from rbx1_nav.base.publisher import BasePublisher
from rbx1_nav.base.robot_parameters import Robot
from rbx1_nav.base.urdf import Tree, read_tree
from rbx1_nav.node.life import end_requested
from rbx1_nav.node.master import Server
from rbx1_nav.node.tf_prefix import check_prefix, find_prefix

PAGE = 'docs/your_robot.md'
WAIT = 3.0      # s of wall time in which the other nodes start
PERIOD = 30.0   # s of wall time between two checks
LISTEN = 2.0    # s: at least one message of a publisher with 1 Hz


class ModelCheck:
    """A thread that checks now and then; each problem is logged when it appears, and is in /diagnostics."""

    def __init__(self, publisher: BasePublisher, keys: tuple[str, str], diagnostics: Updater) -> None:
        """keys: see find_problems()."""
        self.publisher = publisher
        self.model = publisher.robot.model
        self.keys = keys
        self.prefix = check_prefix(find_prefix())
        self.problems: list[str] = []
        self.state = 'Not checked yet'
        diagnostics.add('Robot model', self.diagnose)

    def start(self) -> None:
        """Check what is known before other nodes run, and start the thread."""
        self.report(self.find_at_start())
        threading.Thread(target=self.run, daemon=True).start()

    def report(self, found: list[str]) -> None:
        for each in found:
            if each not in self.problems:
                rospy.logwarn('%s', each)
        for each in self.problems:
            if each not in found:
                rospy.loginfo('Resolved: %s', each)
        self.problems = found

    def run(self) -> None:
        wait = WAIT
        while not end_requested.wait(wait):
            try:
                found = self.find()
                if set(found) - set(self.problems):     # on a busy machine, nodes start late
                    end_requested.wait(WAIT)
                    found = [each for each in self.find() if each in found]
            except (OSError, HTTPException, xmlrpc.client.Error, rospy.ROSException):
                continue        # the master, or this node, is going
            self.report(found)
            wait = PERIOD

    def find_at_start(self) -> list[str]:
        """Return what is wrong whatever the other nodes do."""
        try:
            with Server(rosgraph.get_master_uri()) as master:
                tree = self.read_tree(master)
        except ValueError as error:
            return [str(error)]
        problem = find_prefix_problem(self.publisher.robot, self.prefix, tree) if tree and self.model else ''
        return [problem] if problem else []

    def read_tree(self, master: Server) -> Tree | None:
        """Return the Tree of the model, or None if there is no model. Raises ValueError if it is no URDF file."""
        name = master.call('searchParam', 'robot_description')
        if not name:
            return None
        try:
            return read_tree(str(master.call('getParam', name)))
        except ValueError as error:
            raise ValueError(f'{name}: {error}') from None

    def find(self) -> list[str]:
        """Return the problems. Raises ROSException if they cannot be determined now."""
        found = self.find_at_start()
        if found:
            return found
        with Server(rosgraph.get_master_uri()) as master:
            tree = self.read_tree(master)
            publishers: dict[str, list[str]]
            publishers, subscribers, _ = [dict(each) for each in master.call('getSystemState')]
            types = master.call('getTopicTypes')
        if not tree:
            self.state = 'No robot_description'
            return []
        own = self.publisher.joint_states.resolved_name
        topics = {topic for topic, kind in types if kind == 'sensor_msgs/JointState'
                  and topic.rpartition('/')[0] == own.rpartition('/')[0]}
        transformers = {*publishers.get('/tf', ()), *publishers.get('/tf_static', ())} - {rospy.get_name()}
        # robot_state_publisher turns joint states of this namespace into transforms
        found_by = {topic: sorted(transformers.intersection(subscribers.get(topic, ()))) for topic in topics}
        read = sorted(topic for topic in topics if found_by[topic])
        others = {topic: set(publishers.get(topic, ())) - {rospy.get_name()} for topic in topics}
        if not read:
            self.state = 'No robot_state_publisher'
            return [f"robot_description: expected a robot_state_publisher that shows {self.model or 'it'}, but none is "
                    'running: its last lines give the reason'] if self.model or any(others.values()) else []
        self.state = 'Consistent'
        topic = own if own in read else read[0]
        if len(found_by[topic]) > 1:
            return [f"robot_description: {' and '.join(found_by[topic])} publish the links: expected one of them, such "
                    'as with model:=none for the launch file of the base']
        if topic != own and not subscribers.get(own):
            return [f'{own}: nobody reads it, so that the wheels do not turn: expected a joint_state_publisher that '
                    f'publishes {topic}, with this topic in its source_list']
        keys = f'{rospy.get_name()}/{self.keys[0]}', f'{rospy.get_name()}/{self.keys[1]}'.rstrip('/')
        check = partial(find_problems, self.publisher.robot, self.prefix, keys, tree, reads_base=topic == own)
        if others[topic] or check(published=Published({}, set())):
            return check(published=listen(topic, others[topic]))
        return []

    def diagnose(self, status: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        """Fill in the DiagnosticStatus of the model."""
        if not self.problems:
            status.summary(DiagnosticStatus.OK, self.state)
        else:
            status.summary(DiagnosticStatus.WARN, self.problems[0])
        for number, each in enumerate(self.problems, 1):
            status.add(f'Problem {number}', each)
        return status


def listen(topic: str, nodes: set[str]) -> Published:
    """Return what is Published in LISTEN s of wall time. topic: of the joint states; nodes: that publish them, without
    this node. Raises ROSException if the clock does not advance."""
    published = Published({}, set())

    def on_joints(message: Any) -> None:
        if message._connection_header['callerid'] in nodes:
            published.joints.setdefault(message._connection_header['callerid'], set()).update(message.name)

    def on_transforms(message: Any) -> None:
        published.frames.update(each.child_frame_id for each in message.transforms)
    begin = rospy.get_rostime()
    subscribers = [rospy.Subscriber(topic, JointState, on_joints),
                   *(rospy.Subscriber(name, TFMessage, on_transforms) for name in ('/tf', '/tf_static'))]
    end_requested.wait(LISTEN)
    for each in subscribers:
        each.unregister()
    if rospy.get_rostime() == begin:
        raise rospy.ROSException('no time has passed')
    return published


class Published(NamedTuple):
    """What is published beside the base itself."""

    joints: dict[str, set[str]]     # names of joints by node, on the topic that robot_state_publisher reads
    frames: set[str]                # child frames of the transforms


def without_prefix(prefix: str, frame: str) -> str:
    """Return a frame without its tf_prefix, which may be ''."""
    return frame[len(prefix) + 1:] if prefix and frame.startswith(f'{prefix}/') else frame


def find_prefix_problem(robot: Robot, prefix: str, tree: Tree) -> str:
    """Return why the links of a model, to which nobody adds the prefix, do not belong to the base, or ''."""
    frame = without_prefix(prefix, robot.base_frame_id)
    if not prefix or robot.base_frame_id in tree.links or frame not in tree.links:
        return ''
    return (f"tf_prefix: {prefix}: the model's links have no prefix: expected robot:={prefix} as an argument of the "
            'launch file, in place of <group ns> and tf_prefix')


def find_problems(robot: Robot, prefix: str, keys: tuple[str, str], tree: Tree, published: Published,
                  reads_base: bool) -> list[str]:
    """Return a line for each thing that does not belong to the rest.

    prefix: tf_prefix of the base; keys: of the base frame and of the controller, for the lines; reads_base: whether
    robot_state_publisher reads the topic on which the base publishes its joints.
    """
    return [*_frame_problems(robot, prefix, keys[0], tree, published), *_joint_problems(
        robot, prefix, keys[1], tree, published, reads_base)]


def _frame_problems(robot: Robot, prefix: str, key: str, tree: Tree, published: Published) -> list[str]:
    links = tree.links | {f'{prefix}/{link}' for link in tree.links}
    roots = {tree.root, f'{prefix}/{tree.root}'}
    if robot.base_frame_id in roots or robot.base_frame_id not in links and roots & published.frames:
        return []       # the second: another node publishes the transform between the two
    problem = (f'not the root of robot_description, so that {robot.base_frame_id} has two parents'
               if robot.base_frame_id in links else 'not a link of robot_description')
    return [f'{key}: {without_prefix(prefix, robot.base_frame_id)}: {problem}: expected its root, '
            f'{without_prefix(prefix, tree.root)}']


def _joint_problems(robot: Robot, prefix: str, key: str, tree: Tree, published: Published,
                    reads_base: bool) -> list[str]:
    own = {*robot.wheel_joints, *(joint.name for joint in robot.joints)}
    by_node = {**published.joints, **({'the base': own} if reads_base else {})}
    counts = Counter(joint for names in by_node.values() for joint in names)
    twice = sorted(joint for joint, count in counts.items() if count > 1)
    problems = []
    if twice:
        nodes = sorted(node for node, names in by_node.items() if names & set(twice))
        problems.append(f'joint_states: {" and ".join(nodes)} publish {", ".join(twice)}, so that the angles '
                        f'alternate: expected the topic of one in the source_list of the other, see {PAGE}')
    frames = {without_prefix(prefix, frame) for frame in published.frames} | published.frames
    missing = [joint for joint, link in tree.movable.items() if joint not in counts and link not in frames]
    absent = [joint for joint in robot.wheel_joints if joint not in tree.movable]
    # wheels of another name, which another node may publish, but which do not turn
    others = sorted(tree.turning - own)
    renamed = len(others) >= len(absent) > 0
    keys = f'left_wheel and right_wheel of {key} (now {" and ".join(robot.wheel_joints)})'
    if missing:
        cures = []
        if renamed:
            cures.append(f'the wheels as {keys}')
        if not renamed or len(others) > len(absent) or set(missing) - set(others):
            cures.append(f'joint_state_publisher{" for the other joints" * renamed}, see {PAGE}')
        problems.append(f'joint_states: nobody publishes {", ".join(missing)}, so that there is no transform to '
                        f'{", ".join(tree.movable[joint] for joint in missing)}: expected {", and ".join(cures)}')
    elif renamed:
        wheels = [joint for joint in others if 'wheel' in joint] or others
        problems.append(f'{keys}: {" and ".join(absent)} is no movable joint of robot_description, so that the wheel '
                        f'does not turn: expected {" or ".join(wheels)}')
    return problems
