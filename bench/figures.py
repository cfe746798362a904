"""The figures of a run, from what was recorded. Pure arithmetic: no ROS, no files, no clock.

Units: metres, radians, seconds. Headings are counter-clockwise positive.
A command is (received, v, w): when it was received (s), forward speed (m/s), turning speed (rad/s).
An odometry record is (received, stamp, x, y, heading, v, w). A pose is (x, y, heading).
"""
import math

GAP = 0.5  # s; a longer pause between two commands is the end of a stream, not its period


def wrap(angle):
    """The same angle (rad) within -pi to pi."""
    return math.remainder(angle, 2 * math.pi)


def yaw(x, y, z, w):
    """Heading (rad) of a quaternion that turns about the vertical."""
    return math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))


def relative(pose, start):
    """The pose as seen from start: x ahead of it, y to its left, heading wrapped."""
    dx, dy = pose[0] - start[0], pose[1] - start[1]
    c, s = math.cos(start[2]), math.sin(start[2])
    return c * dx + s * dy, c * dy - s * dx, wrap(pose[2] - start[2])


def arc(pose, v, w, duration):
    """The pose after driving at constant v, w for a duration: along a circle, so its chord halves the turn."""
    x, y, heading = pose
    half = w * duration / 2
    chord = v * duration * (math.sin(half) / half if abs(half) > 1e-6 else 1 - half * half / 6)
    return x + chord * math.cos(heading + half), y + chord * math.sin(heading + half), heading + 2 * half


def integrate(commands, end, timeout):
    """The exact pose at time end (s) from (0, 0, 0); a command holds until the next, at most timeout (s; 0: no end)."""
    pose = 0.0, 0.0, 0.0
    ends = [received for received, _, _ in commands[1:]] + [end]
    for (received, v, w), until in zip(commands, ends):
        held = max(until - received, 0.0)
        pose = arc(pose, v, w, min(held, timeout) if timeout else held)
    return pose


def deviation(pose, reference):
    """How far pose is from reference: (m, rad), both positive."""
    return math.hypot(pose[0] - reference[0], pose[1] - reference[1]), abs(wrap(pose[2] - reference[2]))


def percentile(values, percent):
    """The smallest of the values that has at least that many percent of them at or below it (nearest rank)."""
    ordered = sorted(values)
    return ordered[max(math.ceil(percent / 100 * len(ordered)), 1) - 1]


def spread(values):
    """The values' count, min, p1, p50, p99 and max; None without values."""
    if not values:
        return None
    row = {'count': len(values), 'min': min(values)}
    row.update((f'p{percent}', percentile(values, percent)) for percent in (1, 50, 99))
    row['max'] = max(values)
    return row


def command_periods(commands):
    """For how long each moving command was the newest (s); pauses and what follows a zero command are left out."""
    return [after[0] - before[0] for before, after in zip(commands, commands[1:])
            if (before[1] or before[2]) and after[0] - before[0] <= GAP]


def shown_after(published, odometry):
    """From each published (time, v) to the receipt of the first odometry that shows it, before the next one (s).

    An odometry message shows a command when its forward speed is nearer to the new one than to the old one, or, for a
    start from rest, when its position has moved by 0.1 mm. A command that is never shown gives None.
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


def usage(samples, begin, end):
    """Share of a core between the first and the last sample in the interval; a sample is (time, CPU seconds, ...)."""
    inside = [sample for sample in samples if begin <= sample[0] <= end]
    if len(inside) < 2:
        return None
    return (inside[-1][1] - inside[0][1]) / (inside[-1][0] - inside[0][0])


def run_figures(commands, odometry, samples, timeout, exact):
    """All figures of one run, and its periods (s) for pooling; exact is the pose to end at, or None to integrate."""
    moving = [c for c in commands if c[1] or c[2]]
    row = {'forward': sum(1 for c in commands if c[1]), 'turning': sum(1 for c in commands if c[2]),
           'zero': len(commands) - len(moving), 'total': len(commands)}
    if not moving:
        return row, [], []
    begin, end = moving[0][0], commands[-1][0]
    start = ([r for r in odometry if r[0] <= begin] or odometry)[-1 if odometry[0][0] <= begin else 0][2:5]
    final = relative(odometry[-1][2:5], start)
    reference = exact or integrate(commands, odometry[-1][0], timeout)
    off, off_heading = deviation(final, reference)
    row.update(final_pose=final, distance_m=math.hypot(final[0], final[1]), angle_deg=abs(math.degrees(final[2])),
               reference_pose=reference, deviation_m=off, deviation_rad=off_heading)

    periods = command_periods(commands)
    driving = [r for r in odometry if begin <= r[0] <= end]
    odom_periods = [b[0] - a[0] for a, b in zip(driving, driving[1:])]
    row.update(command_period_s=spread(periods), odom_period_s=spread(odom_periods))
    if len(driving) > 1:
        wall, ros = driving[-1][0] - driving[0][0], driving[-1][1] - driving[0][1]
        row.update(duration_s=end - begin, odom_hz=(len(driving) - 1) / wall, real_time_factor=ros / wall,
                   odom_hz_ros_time=(len(driving) - 1) / ros if ros > 0 else None)
        share = usage(samples, begin, end)
        if share is not None:
            row.update(cpu_percent=100 * share, cpu_percent_per_odom_hz=100 * share / row['odom_hz'])
    return row, periods, odom_periods
