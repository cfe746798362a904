"""The table of bench.py: one line per run, and the spread of the runs."""
import figures

# heading, path in the figures of a run, factor to the unit shown, decimals
COLUMNS = [
    ('fwd', 'forward', 1, 0), ('turn', 'turning', 1, 0), ('zero', 'zero', 1, 0), ('all', 'total', 1, 0),
    ('dist mm', 'distance_m', 1e3, 3), ('angle deg', 'angle_deg', 1, 3),
    ('dev mm', 'deviation_m', 1e3, 4), ('dev mrad', 'deviation_rad', 1e3, 3),
    ('min ms', 'command_period_s.min', 1e3, 2), ('p1', 'command_period_s.p1', 1e3, 2),
    ('p50', 'command_period_s.p50', 1e3, 2), ('p99', 'command_period_s.p99', 1e3, 2),
    ('max', 'command_period_s.max', 1e3, 2),
    ('odom Hz', 'odom_hz', 1, 2), ('CPU %', 'cpu_percent', 1, 2), ('%/Hz', 'cpu_percent_per_odom_hz', 1, 4),
    ('RSS MB', 'rss_peak_mb', 1, 1), ('PSS MB', 'pss_mb', 1, 1), ('x real', 'real_time_factor', 1, 2),
]

WIDTH = 6  # minimum width of a column


def look_up(row, path):
    """The figure at a dotted path; None if it does not exist."""
    for key in path.split('.'):
        row = row.get(key) if row else None
    return row


def remarks(row):
    """Unusual facts about a run, as text."""
    words = [f'{row["load"]} loops'] if row['load'] else []
    words += [f'driver exit status {row["driver_exit"]}'] if row['driver_exit'] else []
    words += [] if row['settled'] else ['still moving at the end']
    return ', '.join(words)


def line(name, values, remark=''):
    """One line of the table; values in the units of the figures of a run."""
    cells = []
    for (heading, _, factor, decimals), value in zip(COLUMNS, values):
        width = max(len(heading), WIDTH)
        cells.append(f'{value * factor:{width}.{decimals}f}' if value is not None else f'{"-":>{width}}')
    return f"{name:>6} {' '.join(cells)}{(f'  {remark}' if remark else '')}"


def header():
    """The first line of the table."""
    return f"{'run':>6} {' '.join((f'{heading:>{max(len(heading), WIDTH)}}' for heading, *_ in COLUMNS))}"


def summary(rows):
    """The lines below the runs: minimum, median, 90th percentile and maximum of each column, as {name: [value...]}."""
    kept = [[v for v in (look_up(row, path) for row in rows) if v is not None] for _, path, *_ in COLUMNS]
    return {name: [figures.percentile(values, percent) if values else None for values in kept]
            for name, percent in (('min', 0), ('median', 50), ('90 %', 90), ('max', 100))}


def print_spread(name, values):
    """Print one line for pooled values (s), in ms."""
    if values:
        numbers = ', '.join(f'{key} {1e3 * values[key]:.2f}' for key in ('min', 'p1', 'p50', 'p99', 'max'))
        print(f'{name}, {values["count"]} pooled (ms): {numbers}')
