"""The priors that the tests of the filter use."""
import os

from rbx1_nav.base.surfaces import load_surface
from rbx1_nav.filter.priors import priors

SURFACES = os.path.join(os.path.dirname(__file__), '..', '..', '..', 'config', 'surfaces')
PRIORS = priors(load_surface('low_ply_carpet', SURFACES))
IDEAL = priors(None)
