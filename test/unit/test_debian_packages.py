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
    # common.sh lists the packages with the commands that the tutorial uses
    command = ['bash', '-c', 'set -eu; source script/common.sh; echo "${command_packages[@]}"']
    commands = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, universal_newlines=True,
                              check=True).stdout.split()
    assert len(written) == len(listed('package.xml', 'exec_depend') | set(commands))
    assert {'python3-rospy', 'python3-yaml', 'ros-robot-state-publisher', 'rviz', *commands} <= set(written)


@pytest.mark.parametrize('package', ['ros-rbx1-nav', 'ros-rbx1-bringup'])
def test_the_udev_rules_are_installed_only_on_request(package):
    of_package = fields('Package', package)
    assert not any('udev' in of_package.get(kind, '') for kind in ('Depends', 'Pre-Depends', 'Recommends', 'Suggests'))
