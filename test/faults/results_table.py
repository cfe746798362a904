"""The table of results of the fault suite: a row for each row that was run, with its seed, date and commit."""
import os
import re
import subprocess
import time

FOLDER = os.path.dirname(os.path.abspath(__file__))
PATH = os.path.join(FOLDER, 'results.md')
HEAD = """\
# Results of the fault suite

`script/test --faults --table` updates the rows that it runs. `times` is the number of faults, and
each figure is the range over them. [Reliability](../../docs/reliability.md#test-results) summarizes the results.

| row | fault | guarantee | times | result | seed | date | commit |
|---|---|---|---|---|---|---|---|
"""


def spread(values):
    """Numbers as text: one value if all are equal; otherwise smallest, largest and median."""
    values = sorted(values)
    if values[0] == values[-1]:
        return f'{values[0]:.4g}'
    return f'{values[0]:.3g} to {values[-1]:.3g}, median {values[len(values) // 2]:.3g}'


def outcome(result):
    """The result of a row as text. A failure that passed when repeated is not `all held`."""
    if result['failures']:
        text = f"failed: {len(result['failures'])} of {result['faults']}, also when repeated"
    elif result['repeated']:
        text = f"failed once: {result['repeated']} of {result['faults']}; passed when repeated"
    else:
        text = 'all held'
    return '; '.join([text, *(f'{figure}: {spread(values)}' for figure, values in sorted(result['figures'].items()))])


def commit():
    """The commit that was tested; a + follows if files have changed since."""
    found = subprocess.run(['git', '-C', FOLDER, 'describe', '--always', '--dirty=+', '--abbrev=8', '--exclude=*'],
                           stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, check=False)
    return found.stdout.strip() or 'unknown'


def update(path, modules, results, seed):
    """Update the rows that were run. modules: by name, with FAULT and PROMISE; results: see Row.result()."""
    rows = {}
    if os.path.exists(path):
        with open(path, encoding='utf-8') as file:
            rows = {match[1]: match[0] for match in re.finditer(r'(?m)^\| `(\w+)` \|.*', file.read())}
    run = f"{seed} | {time.strftime('%Y-%m-%d')} | {commit()}"
    for result in results:
        if not result['skipped']:
            name = result['name']
            rows[name] = (f'| `{name}` | {modules[name].FAULT} | {modules[name].PROMISE} | {result["faults"]} '
                          f'| {outcome(result)} | {run} |')
    with open(path, 'w', encoding='utf-8') as file:
        file.write(HEAD + ''.join(f'{rows[name]}\n' for name in sorted(rows)))
