"""The table of bench.py: one line per run, and the spread of the runs."""
import figures

# heading, figure of a run, factor to the unit shown, decimals
COLUMNS = [
    ('fwd', 'forward', 1, 0), ('turn', 'turning', 1, 0), ('zero', 'zero', 1, 0), ('all', 'total', 1, 0),
    ('dist mm', 'distance_m', 1e3, 3), ('angle deg', 'angle_deg', 1, 3),
    ('dev mm', 'deviation_m', 1e3, 4), ('dev mrad', 'deviation_rad', 1e3, 3),
    ('min ms', 'min', 1e3, 2), ('p1', 'p1', 1e3, 2), ('p50', 'p50', 1e3, 2), ('p99', 'p99', 1e3, 2),
    ('max', 'max', 1e3, 2),
    ('odom Hz', 'odom_hz', 1, 2), ('CPU %', 'cpu_percent', 1, 2), ('%/Hz', 'cpu_percent_per_odom_hz', 1, 4),
    ('RSS MB', 'rss_mb', 1, 1), ('PSS MB', 'pss_mb', 1, 1), ('x real', 'real_time_factor', 1, 2),
]

WIDTH = 6  # minimum width of a column


def line(name, row, remark=''):
    """One line of the table, with the figures of a run."""
    cells = []
    for heading, figure, factor, decimals in COLUMNS:
        width, value = max(len(heading), WIDTH), row.get(figure)
        cells.append(f'{value * factor:{width}.{decimals}f}' if value is not None else f'{"-":>{width}}')
    return f"{name:>6} {' '.join(cells)}{(f'  {remark}' if remark else '')}"


def header():
    """The first line of the table."""
    return f"{'run':>6} {' '.join((f'{heading:>{max(len(heading), WIDTH)}}' for heading, *_ in COLUMNS))}"


def summary(rows):
    """The lines below the runs: minimum, median, 90th percentile and maximum of each column."""
    kept = {figure: [row[figure] for row in rows if row.get(figure) is not None] for _, figure, *_ in COLUMNS}
    for name, percent in (('min', 0), ('median', 50), ('90 %', 90), ('max', 100)):
        yield line(name, {figure: figures.percentile(values, percent) for figure, values in kept.items() if values})


def print_spread(name, values):
    """Print one line for pooled values (s), in ms."""
    if values:
        numbers = ', '.join(f'{key} {1e3 * value:.2f}' for key, value in figures.spread(values).items())
        print(f'{name}, {len(values)} pooled (ms): {numbers}')
