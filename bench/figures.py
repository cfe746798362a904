"""The figures of a run, computed from the recorded messages, without ROS, files or a clock.

Units: meters, radians, seconds. Headings are counter-clockwise positive.
A command is (received, v, w): time of arrival (s), forward speed (m/s), turning speed (rad/s).
An odometry record is (received, stamp, x, y, heading, v, w). A pose is (x, y, heading).
"""
import math
import struct

GAP = 0.5  # s: a longer pause between two commands terminates a stream


def wrap(angle):
    """The equivalent angle between -pi and pi, rad."""
    return math.remainder(angle, 2 * math.pi)


def yaw(x, y, z, w):
    """The heading (rad) of a quaternion about the vertical axis."""
    return math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))


def relative(pose, start):
    """The pose in the frame of the pose `start`: x ahead, y to the left; the heading is wrapped."""
    dx, dy = pose[0] - start[0], pose[1] - start[1]
    c, s = math.cos(start[2]), math.sin(start[2])
    return c * dx + s * dy, c * dy - s * dx, wrap(pose[2] - start[2])


def arc(pose, v, w, duration):
    """The pose after `duration` (s) at constant v and w: along an arc, whose chord is rotated by half of the turn."""
    x, y, heading = pose
    half = w * duration / 2
    chord = v * duration * (math.sin(half) / half if abs(half) > 1e-6 else 1 - half * half / 6)
    return x + chord * math.cos(heading + half), y + chord * math.sin(heading + half), heading + 2 * half


def integrate(commands, end, timeout):
    """The exact pose at the time `end` (s). A command lasts until the next, at most `timeout` (s; 0: no limit)."""
    pose = 0.0, 0.0, 0.0
    ends = [received for received, _, _ in commands[1:]] + [end]
    for (received, v, w), until in zip(commands, ends):
        held = max(until - received, 0.0)
        pose = arc(pose, v, w, min(held, timeout) if timeout else held)
    return pose


def deviation(pose, reference):
    """The distance (m) and angle (rad, not negative) between two poses."""
    return math.hypot(pose[0] - reference[0], pose[1] - reference[1]), abs(wrap(pose[2] - reference[2]))


def percentile(values, percent):
    """The smallest value that at least `percent` of the values do not exceed (nearest rank)."""
    ordered = sorted(values)
    return ordered[max(math.ceil(percent / 100 * len(ordered)), 1) - 1]


def spread(values):
    """min, p1, p50, p99 and max of the values."""
    return {name: percentile(values, percent)
            for name, percent in (('min', 0), ('p1', 1), ('p50', 50), ('p99', 99), ('max', 100))}


def command_periods(commands):
    """How long each moving command was the latest one (s), excluding pauses and the time after zero commands."""
    return [after[0] - before[0] for before, after in zip(commands, commands[1:])
            if (before[1] or before[2]) and after[0] - before[0] <= GAP]


def shown_after(published, odometry):
    """The delay (s) from each published (time, v) to the first odometry that shows it; None if the next one is earlier.

    An odometry message shows a command if its forward speed is closer to the new speed than to the old one or, for a
    start from rest, if the position has changed by 0.1 mm.
    """
    delays = []
    ends = [time for time, _ in published[1:]] + [math.inf]
    old = 0.0
    for (time, new), end in zip(published, ends):
        before = [record for record in odometry if record[0] <= time][-1]

        def shows(record):
            moved = old == 0 and math.hypot(record[2] - before[2], record[3] - before[3]) > 1e-4
            return moved or abs(record[5] - new) < abs(record[5] - old)

        seen = [] if shows(before) else [r[0] for r in odometry if time < r[0] <= end and shows(r)]
        delays.append(seen[0] - time if seen else None)
        old = new
    return delays


def line_speeds(texts, offset):
    """An odometry record for each Drive Direct command (145) in texts of /line: its time plus `offset` (s), and the
    mean speed as v."""
    records = []
    for text in texts:
        stamp, data = text.split()
        if data.startswith('91'):
            right, left = struct.unpack('>hh', bytes.fromhex(data[2:]))  # mm/s
            received = float(stamp) + offset
            records.append((received, received, 0.0, 0.0, 0.0, (right + left) / 2000, 0.0))
    return records


def usage(samples, begin, end):
    """Fraction of a core between the first and the last sample in an interval; a sample is (time, CPU time, ...), s."""
    inside = [sample for sample in samples if begin <= sample[0] <= end]
    if len(inside) < 2:
        return None
    return (inside[-1][1] - inside[0][1]) / (inside[-1][0] - inside[0][0])


def run_figures(commands, odometry, samples, timeout, exact):
    """All figures of a run, and its command periods (s) for pooling. exact: the expected pose; None: integrate the
    commands."""
    moving = [c for c in commands if c[1] or c[2]]
    row = {'forward': sum(1 for c in commands if c[1]), 'turning': sum(1 for c in commands if c[2]),
           'zero': len(commands) - len(moving), 'total': len(commands)}
    if not moving:
        return row, []
    begin, end = moving[0][0], commands[-1][0]
    start = ([r for r in odometry if r[0] <= begin] or odometry)[-1 if odometry[0][0] <= begin else 0][2:5]
    final = relative(odometry[-1][2:5], start)
    off, off_heading = deviation(final, exact or integrate(commands, odometry[-1][0], timeout))
    periods = command_periods(commands)
    row.update(distance_m=math.hypot(final[0], final[1]), angle_deg=abs(math.degrees(final[2])),
               deviation_m=off, deviation_rad=off_heading, **(spread(periods) if periods else {}))
    driving = [r for r in odometry if begin <= r[0] <= end]
    if len(driving) > 1:
        wall, ros = driving[-1][0] - driving[0][0], driving[-1][1] - driving[0][1]
        row.update(odom_hz=(len(driving) - 1) / wall, real_time_factor=ros / wall)
        share = usage(samples, begin, end)
        if share is not None:
            row.update(cpu_percent=100 * share, cpu_percent_per_odom_hz=100 * share / row['odom_hz'])
    return row, periods
