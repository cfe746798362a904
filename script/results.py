"""The results of tests that script/run_tests.py has run: the files that rostest, rosunit and pytest have written."""
import glob
import os
import xml.etree.ElementTree as ElementTree

# Rostests with the same set-up that leave nothing behind in it. Each set runs on one master, one after another.
SETS = {
    'set_tools': ['interrupted_start', 'launch_arguments', 'simulate_command', 'usage'],
    'set_base': ['consistent_outputs', 'rejected_commands', 'message_counts'],
    'set_scripts': ['remembered_parameters', 'two_drivers'],
    'set_fast': ['result', 'released_publisher'],
    'set_real_time': ['keyboard_driving', 'contradictory_commands'],
    'set_calibration': ['angular_calibration', 'linear_calibration'],
    'set_fake_create': ['emulated_robot', 'independent_client'],
    'set_create': ['create_drives', 'create_port', 'topics_of_create', 'turning_at_bump'],
    'set_create_fails': ['create_killed', 'create_refuses', 'create_silence']}


def read(path):
    """Return the test cases of a result file; None if it cannot be read, such as the file of a killed test."""
    try:
        return list(ElementTree.parse(path).iter('testcase'))
    except (ElementTree.ParseError, LookupError):       # LookupError: an unknown encoding
        return None


def failures(cases):
    """Return the (test case, element that says why) of the test cases that have failed."""
    return [(case, trouble) for case in cases for trouble in [case.find('failure'), case.find('error')]
            if trouble is not None]


def failed_tests(results):
    """Return the names of all test cases that have failed."""
    return {case.get('name') for path in glob.glob(os.path.join(results, '**', 'rosunit-*.xml'), recursive=True)
            for case, _ in failures(read(path) or [])}


def failures_of_sets(results):
    """Return the failures of sets, as texts by the name of the set: the job of a set does not fail if its tests do."""
    found = {}
    for name, members in SETS.items():
        for path in glob.glob(os.path.join(results, '**', 'rosunit-*.xml'), recursive=True):
            if os.path.basename(path)[len('rosunit-'):-len('.xml')] in members:
                for case, trouble in failures(read(path) or []):
                    found.setdefault(name, []).append(f"{case.get('name')}: {trouble.text}")
    return found


def has_own_result(results, path):
    """Whether the test of a rostest has left a result."""
    # test/unit/test_rostests.py: a test has the name of its file, with the folder if two files have the same name
    name = os.path.basename(path)[len('rostest-'):]
    name = name[len('test_'):] if name.startswith('test_') else name
    return any(read(own) for each in {name, name.partition('_')[2]}
               for own in glob.glob(os.path.join(results, '**', 'rosunit-' + each), recursive=True))


def summarize(results):
    """Print all results in a folder. Returns the numbers of tests that passed and that failed, and the names of those
    that failed."""
    passed = failed = 0
    names = []
    for path in sorted(glob.glob(os.path.join(results, '**', '*.xml'), recursive=True)):
        cases = read(path)
        # rostest's own file counts if the test left no file because it crashed, hung, or did not start
        if '/rosunit-' in path and cases is None or '/rostest-' in path and has_own_result(results, path):
            continue
        cases = cases or []
        bad = failures(cases)
        name = os.path.splitext(os.path.basename(path))[0]
        if name.partition('-')[2] in SETS and cases:    # the tests of a set have results of their own
            cases = [case for case, _ in bad]
            if not bad:
                continue
        print('%-32s %d of %d' % (name, len(cases) - len(bad), len(cases)))
        for case, trouble in bad:
            names.append(f"{name} {case.get('name')}")
            print(f"FAILED: {names[-1]}\n{trouble.text or ''}")
        passed += len(cases) - len(bad)
        failed += len(bad) or not cases
    return passed, failed, names
