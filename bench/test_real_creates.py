"""The score of the predictions of real_creates.py."""
import numpy

from real_creates import energy_score


def test_the_energy_score_is_the_smaller_the_better_the_prediction():
    generator = numpy.random.default_rng(4)
    points = generator.standard_normal((300, 2))
    good, shifted, timid, bold = (numpy.mean([
        energy_score(generator.standard_normal((200, 2)) * width + shift, point) for point in points])
        for width, shift in ((1, 0), (1, 1), (3, 0), (0.2, 0)))
    assert good < min(shifted, timid, bold)
    # without spread, the score is the distance
    assert energy_score(numpy.zeros((10, 2)), numpy.array([3.0, 4.0])) == 5
