"""The Debian packages have the dependencies and the version that package.xml lists."""
import os
import re
import shutil
import subprocess
import xml.etree.ElementTree as ElementTree

import pytest

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), '..', '..'))
PACKAGES = ['package.xml', 'rbx1_bringup/package.xml']


def read(path):
    """The text of a file of this repository."""
    with open(os.path.join(ROOT, path), encoding='utf-8') as file:
        return file.read()


def fields(kind, package):
    """The fields of a paragraph in debian/control, without their continuation lines; kind: Source or Package."""
    paragraph = next(part for part in read('debian/control').split('\n\n') if part.startswith(f'{kind}: {package}\n'))
    return dict(re.findall(r'^(\S+): (.*)', paragraph, re.MULTILINE))


def listed(package, *tags):
    """The text of all elements of a package.xml that have one of these tags."""
    return {element.text for element in ElementTree.fromstring(read(package)) if element.tag in tags}


@pytest.mark.parametrize('package', PACKAGES)
def test_the_version_is_that_of_package_xml(package):
    version = re.match(r'ros-rbx1-nav \((\S+)\)', read('debian/changelog'))[1]
    assert listed(package, 'version') == {version}


@pytest.mark.parametrize('package', PACKAGES)
def test_what_package_xml_needs_to_build_is_installed_to_build(package):
    installed = fields('Source', 'ros-rbx1-nav')['Build-Depends'].split(', ')
    assert listed(package, 'buildtool_depend', 'build_depend') <= set(installed)


@pytest.mark.skipif(not shutil.which('make'), reason='script/unit does not need make; script/test installs it')
def test_rules_write_the_dependencies_of_package_xml(tmp_path):
    for path in ('debian/rules', 'script/common.sh', 'package.xml'):
        (tmp_path / path).parent.mkdir(exist_ok=True)
        shutil.copy(os.path.join(ROOT, path), tmp_path / path)
    stub = tmp_path / 'bin' / 'dh_gencontrol'
    stub.parent.mkdir()
    stub.write_text('#!/bin/sh\n')
    stub.chmod(0o755)
    subprocess.run(['make', '-s', '-f', 'debian/rules', 'override_dh_gencontrol'], cwd=tmp_path, check=True,
                   env={**os.environ, 'PATH': f'{stub.parent}:{os.environ["PATH"]}'})
    name, _, value = (tmp_path / 'debian' / 'ros-rbx1-nav.substvars').read_text().rstrip('\n').partition('=')
    assert '${%s}' % name in fields('Package', 'ros-rbx1-nav')['Depends'].split(', ')
    written = value.split(',')
    assert len(set(written)) == len(written)
    # ros-core, rosbash and rospack-tools contain the commands that the tutorial uses
    assert len(written) == len(listed('package.xml', 'exec_depend') | {'ros-core', 'rosbash', 'rospack-tools'})
    assert {'python3-rospy', 'python3-yaml', 'ros-robot-state-publisher', 'rviz', 'ros-core', 'rosbash'} <= set(written)


@pytest.mark.parametrize('package', ['ros-rbx1-nav', 'ros-rbx1-bringup'])
def test_the_udev_rules_are_installed_only_on_request(package):
    of_package = fields('Package', package)
    assert not any('udev' in of_package.get(kind, '') for kind in ('Depends', 'Pre-Depends', 'Recommends', 'Suggests'))


@pytest.mark.skipif(not shutil.which('git') or not shutil.which('dpkg'), reason='needs git and dpkg')
def test_a_later_commit_or_an_uncommitted_change_gives_a_higher_version(tmp_path):
    for path in ('script/common.sh', 'debian/changelog'):
        (tmp_path / path).parent.mkdir(exist_ok=True)
        shutil.copy(os.path.join(ROOT, path), tmp_path / path)

    def version():
        command = 'set -euo pipefail; source script/common.sh; package_version'
        return subprocess.run(['bash', '-c', command], cwd=tmp_path, check=True, text=True, stdout=subprocess.PIPE,
                              env={**os.environ, 'GIT_CEILING_DIRECTORIES': str(tmp_path.parent)}).stdout.strip()

    def commit(date):
        subprocess.run(['git', 'add', '.'], cwd=tmp_path, check=True)
        subprocess.run(['git', '-c', 'user.name=a', '-c', 'user.email=a@example.org', '-c', 'commit.gpgsign=false',
                        'commit', '-q', '--allow-empty', '-m', 'a'], cwd=tmp_path, check=True,
                       env={**os.environ, 'GIT_COMMITTER_DATE': date})

    versions = [version()]
    subprocess.run(['git', 'init', '-q', tmp_path], check=True)
    # 09:30 at +0200 is before 08:00 UTC
    for date in ('2026-11-22T09:30:00+0200', '2026-11-22T08:00:00+0000'):
        commit(date)
        versions.append(version())
    (tmp_path / 'changed').touch()
    versions.append(version())
    assert versions[1:3] == [f'{versions[0]}+git20261122{time}' for time in ('073000', '080000')]
    for older, newer in zip(versions, versions[1:]):
        subprocess.run(['dpkg', '--compare-versions', older, 'lt', newer], check=True)
