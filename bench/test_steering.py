"""Steering on the legs: the pages quote what the answer to exercise 5 gains."""
import os
import re

import numpy
import pytest
import simulated
import steering

DOCS = f'{simulated.CONFIG}/../docs'


def test_the_pages_quote_the_gain():
    """answers.md, why_it_misses.md and figures.md: steered, the mean distance and the rms of y of 100 runs, cm."""
    results = steering.simulate('ekf', 100, steering.load_answer().steering)
    ends = numpy.array([result.end.truth for result in results])
    gain = 100 * numpy.hypot(*ends.T[:2]).mean(), 100 * numpy.sqrt((ends[:, 1] ** 2).mean())
    texts = {}
    for page in 'answers', 'why_it_misses', '../bench/figures':
        with open(f'{DOCS}/{page}.md', encoding='utf-8') as file:
            texts[os.path.basename(page)] = ' '.join(file.read().split())
    for page, sentence, value in [
            ('answers', r'distance from the start \| 7.6 cm \| (\S+) cm', gain[0]),
            ('answers', r'y \(root mean square\) \| 5.4 cm \| (\S+) cm', gain[1]),
            ('why_it_misses', r'reduces the error across the legs to (\S+) cm', gain[1]),
            ('why_it_misses', r'and the distance from the start to (\S+) cm', gain[0]),
            ('figures', r'#5-steer\) \(cm\) .* \| 7.6, (\S+) \| 0–99', gain[0]),
            ('figures', r'across the legs, .* \| 5.4, (\S+) \| 0–99', gain[1])]:
        number, = re.findall(sentence, texts[page])
        # rounded to a millimeter; versions of numpy may differ by as much
        assert float(number) == pytest.approx(value, abs=0.1)
