"""The pages quote the results of simulate.py that docs/why_it_misses.md shows; the page test runs this command."""
import os
import re

import pytest
from pages import markdown

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), '..', '..', '..'))
WHY, ANSWERS, TUTORIAL = (f'docs/{page}.md' for page in ('why_it_misses', 'answers', 'tutorial'))
FIGURES = 'bench/figures.md'
ERROR = re.compile(r'(?P<what>misses its start|/odom is wrong|/odom_ekf is wrong) by (?P<mean>[\d.]+) m '
                   r'\(median (?P<median>[\d.]+), 90 % below (?P<most>[\d.]+)\) and (?P<angle>[\d.]+) degrees')
NUMBER = r'(\d+(?:\.\d+)?)'


def results(page):
    """The errors in the outputs of simulate.py on a page: {(surface, method, what): (cm, degrees)}."""
    found = {}
    for _, language, lines in markdown.split(markdown.read(ROOT, page)):
        if language != 'text' or ' runs of each method on ' not in lines[0]:
            continue
        surface, method = re.match(r'100 runs of each method on (\w+), seeds 0 to 99\.', lines[0]).group(1), ''
        for line in lines:
            method = (re.match(r'timed|odom|ekf', line) or [method])[0]
            error = ERROR.search(line)
            if error:
                found[surface, method, error['what']] = 100 * float(error['mean']), float(error['angle'])
    return found


RESULTS = results(WHY)
MISSES, ODOMETRY, ESTIMATE = 'misses its start', '/odom is wrong', '/odom_ekf is wrong'
CARPET, HARD = 'low_ply_carpet', 'hard_floor'
CM, DEGREES = 0, 1
# (page, sentence with a # for each number, the result for each number)
QUOTED = [
    (WHY, 'the robot is # cm from its start, but its odometry is wrong by only # cm',
     [(CARPET, 'timed', MISSES, CM), (CARPET, 'timed', ODOMETRY, CM)]),
    (WHY, 'final heading is # degrees off', [(CARPET, 'timed', MISSES, DEGREES)]),
    (WHY, 'The robot stops # cm from its start and # degrees off its initial heading. It cannot do better',
     [(CARPET, 'odom', MISSES, CM), (CARPET, 'odom', MISSES, DEGREES)]),
    (WHY, 'the solid robot is # cm away', [(CARPET, 'odom', MISSES, CM)]),
    (WHY, 'its heading is off by # degrees, and the heading of the odometry by # degrees',
     [(CARPET, 'ekf', ESTIMATE, DEGREES), (CARPET, 'ekf', ODOMETRY, DEGREES)]),
    (WHY, 'uses the estimate, and the robot stops # cm from its start and # degrees off',
     [(CARPET, 'ekf', MISSES, CM), (CARPET, 'ekf', MISSES, DEGREES)]),
    (WHY, 'The robot stops # cm from its start on average. This distance has two components',
     [(CARPET, 'ekf', MISSES, CM)]),
    (WHY, 'A timed run still misses its start by # cm and # degrees',
     [(HARD, 'timed', MISSES, CM), (HARD, 'timed', MISSES, DEGREES)]),
    (WHY, 'A run with odometry misses it by # cm and # degrees. With the gyro, the error is # cm and # degrees',
     [(HARD, method, MISSES, unit) for method in ('odom', 'ekf') for unit in (CM, DEGREES)]),
    (FIGURES, '| true final distance from the start, mean (cm) | # | # | # |',
     [(CARPET, method, MISSES, CM) for method in ('timed', 'odom', 'ekf')]),
    (FIGURES, '| true final distance from the start (cm) | # | # | 0–99',
     [(HARD, method, MISSES, CM) for method in ('odom', 'ekf')]),
    (FIGURES, '| true final angle from the initial heading (degrees) | # | # | 0–99',
     [(HARD, method, MISSES, DEGREES) for method in ('odom', 'ekf')]),
    (TUTORIAL, 'the mean distance from the start is # cm when timed, # cm with odometry, and # cm with odometry and',
     [(CARPET, method, MISSES, CM) for method in ('timed', 'odom', 'ekf')]),
    (FIGURES, 'steer) (cm) | | #, # | #,',
     [(CARPET, method, MISSES, CM) for method in ('odom', 'odom', 'ekf')]),
    (ANSWERS, 'It stops 55 cm from its start instead of # cm.', [(CARPET, 'timed', MISSES, CM)]),
    (ANSWERS, 'it stops 20 cm from its start instead of # cm,', [(CARPET, 'odom', MISSES, CM)]),
    (ANSWERS, '| with odometry and gyro: distance from the start | # cm |', [(CARPET, 'ekf', MISSES, CM)]),
    (ANSWERS, '| angle from the initial heading | # degrees |', [(CARPET, 'ekf', MISSES, DEGREES)]),
    (ANSWERS, '| with odometry alone: distance from the start | # cm | # cm |', 2 * [(CARPET, 'odom', MISSES, CM)]),
]


@pytest.mark.parametrize('page, sentence, keys', QUOTED)
def test_a_page_quotes_the_results(page, sentence, keys):
    text = ' '.join(markdown.read(ROOT, page).split())
    found = re.findall(re.escape(sentence).replace(r'\#', NUMBER), text)
    assert len(found) == 1, f'{page}: {len(found)} times: {sentence}'
    numbers = found[0] if isinstance(found[0], tuple) else found
    for number, (surface, method, what, unit) in zip(numbers, keys):
        decimals = len(number.partition('.')[2])
        expected = RESULTS[surface, method, what][unit]
        # the shown result is rounded too
        assert abs(float(number) - expected) <= 0.5 * 10 ** -decimals + 0.05 + 1e-9, (sentence, number, expected)
