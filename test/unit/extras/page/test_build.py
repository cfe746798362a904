"""script/page packs what the runs need, and nothing else."""
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader
import io
import json
import os
import zipfile

import pytest

from page_runs import CONFIG, ROOT

LOADER = SourceFileLoader('page_script', os.path.join(ROOT, 'script', 'page'))


@pytest.fixture(name='page')
def fixture_page():
    module = module_from_spec(spec_from_loader(LOADER.name, LOADER))
    LOADER.exec_module(module)
    return module


def test_the_core_is_what_the_runs_import_and_the_configuration(page):
    with zipfile.ZipFile(io.BytesIO(page.pack_core())) as archive:
        names = set(archive.namelist())
        assert json.loads(archive.read('config.json')) == CONFIG
    assert {'rbx1_nav/__init__.py', 'rbx1_nav/extras/page/rospy_stand_in.py', 'rbx1_nav/filter/filter.py'} < names
    assert not [name for name in names if name.startswith(('rbx1_nav/driving/', 'rbx1_nav/extras/create/'))]


def test_a_package_that_is_not_the_expected_one_is_refused(page, tmp_path, monkeypatch):
    monkeypatch.setenv('XDG_CACHE_HOME', str(tmp_path))
    path = tmp_path / 'rbx1_nav-page' / 'pyodide-0.29.5.tgz'
    path.parent.mkdir()
    path.write_bytes(b'another package')
    with pytest.raises(OSError, match='pyodide-0.29.5.tgz: its sha512 is wrong: expected the package at https://'):
        page.fetch_pyodide()
    assert not path.exists()


def test_the_policy_allows_no_other_host(page):
    assert 'connect-src \'self\'' in page.HEAD and 'http' not in page.POLICY and 'unsafe-inline' not in page.POLICY
