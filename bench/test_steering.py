"""Steering on the legs: the pages quote what the answer to exercise 5 gains."""
from functools import partial
import re

import numpy
import pytest
import simulated
import steering
from rbx1_nav.extras.many_runs import simulated_run

DOCS = f'{simulated.CONFIG}/../docs'


def test_the_pages_quote_the_gain(monkeypatch):
    """docs/answers.md, why_it_misses.md and figures.md: steered, the mean distance and the rms of y of 100 runs, cm."""
    robot, carpet = simulated.robot(), simulated.floor('low_ply_carpet')
    monkeypatch.setattr(simulated_run, 'out_and_back_by_odometry', partial(steering.steered_legs, steering.load_answer().steering))
    ends = numpy.array([simulated_run.simulate('ekf', robot, carpet, seed).end.truth for seed in range(100)])
    gain = 100 * numpy.hypot(*ends.T[:2]).mean(), 100 * numpy.sqrt((ends[:, 1] ** 2).mean())
    texts = {}
    for page in 'answers', 'why_it_misses', 'figures':
        with open(f'{DOCS}/{page}.md', encoding='utf-8') as file:
            texts[page] = ' '.join(file.read().split())
    for page, sentence, value in [
            ('answers', r'distance from the start \| 7.6 cm \| (\S+) cm', gain[0]),
            ('answers', r'y \(root mean square\) \| 5.3 cm \| (\S+) cm', gain[1]),
            ('why_it_misses', r'reduces the error across the legs to (\S+) cm', gain[1]),
            ('why_it_misses', r'and the distance from the start to (\S+) cm', gain[0]),
            ('figures', r'7.6 cm straight ahead and (\S+) cm', gain[0]),
            ('figures', r'across the legs 5.3 cm and (\S+) cm', gain[1])]:
        number, = re.findall(sentence, texts[page])
        # rounded to a millimeter; versions of numpy may differ by as much
        assert float(number) == pytest.approx(value, abs=0.1)
