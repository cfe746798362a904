"""Runs of the page, in this Python."""
import json
import os

import yaml

from rbx1_nav.base.surfaces import known_surfaces
from rbx1_nav.extras.page.runner import SCRIPT, run_request

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), '..', '..', '..', '..'))
SURFACES = os.path.join(ROOT, 'config', 'surfaces')


def load(*parts):
    with open(os.path.join(ROOT, 'config', *parts)) as file:
        return yaml.safe_load(file)


CONFIG = {'robot': load('turtlebot.yaml'),
          'surfaces': {name: load('surfaces', f'{name}.yaml') for name in known_surfaces(SURFACES)}}


def request(method, surface='ideal', seed=7, stop=None, as_one_frame=True, text='', **parameters):
    """The frames of a run."""
    return json.loads(run_request(CONFIG, json.dumps(
        dict(method=method, surface=surface, seed=seed, stop=stop, as_one_frame=as_one_frame, text=text,
             parameters=parameters))))


def run_script(text, **options):
    """(last frame, texts in the log) of the run of a script."""
    frames = request(SCRIPT, text=text, **options)
    return frames[-1], [text for frame in frames for _, _, _, text in frame.get('log', [])]
