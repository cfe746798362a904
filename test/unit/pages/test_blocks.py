"""The steps of a Markdown page."""
import pytest
from pages import blocks
from pages.blocks import Interrupt, Output, Run, Setup, Start

PAGE = """\
# A page

<!-- not run: installation -->
```sh
sudo apt-get install everything
```

Once, and in every terminal:

<!-- run -->
```sh
mkdir -p ws    # a folder
# only a comment

catkin_make \\
    --quiet
```

<!-- every terminal -->
```sh
source ws/setup.bash
```

1. Start these:

   <!-- terminals: base, rviz, run -->
   ```sh
   roslaunch base.launch
   rosrun rviz rviz
   rosrun pkg drive.py
   ```

   <!-- output of base, within 5 -->
   ```text
   at 1.0 m
     ...
   ```

<!-- Ctrl-C: rviz, base -->
Press **Ctrl-C** in the terminals of RViz and of the base.

<!-- terminal: base -->
```bash
roslaunch base.launch surface:=carpet
```

<!-- output, exact -->
```text
On carpet
```

<!-- run, status 1 -->
```sh
rosrun pkg drive.py fast
```

<!-- not output -->
```text
src/
```

```python
print('not for a shell')
```
"""


def test_steps():
    """One of each kind, in the order of the page."""
    assert blocks.parse(PAGE) == [
        Run(11, ['mkdir -p ws    # a folder', 'catkin_make \\\n    --quiet'], 0),
        Setup(20, ['source ws/setup.bash']),
        Start(27, 'roslaunch base.launch', 'base'),
        Start(27, 'rosrun rviz rviz', 'rviz'),
        Run(27, ['rosrun pkg drive.py'], 0),
        Output(34, ['at 1.0 m', '  ...'], 'base', 5),
        Interrupt(39, 'rviz'), Interrupt(39, 'base'),
        Start(43, 'roslaunch base.launch surface:=carpet', 'base'),
        Output(48, ['On carpet'], None, 0.0),
        Run(53, ['rosrun pkg drive.py fast'], 1)]


@pytest.mark.parametrize('page, trouble', [
    ('```sh\nls\n```\n', '1: a shell block without a comment directly above: one of run, terminals'),
    ('<!-- run -->\n\n```sh\nls\n```\n', "1: 'run' without a block directly below"),
    ('<!-- run -->\nText\n', "1: 'run' without a block directly below"),
    ('<!-- run -->\n', "1: 'run' without a block directly below"),
    ('<!-- output -->\n```sh\nls\n```\n', '2: a shell block without a comment'),
    ('<!-- run -->\n```python\n1\n```\n', "2: 'run' above a block that is neither shell nor text"),
    ('<!-- runs -->\n```sh\nls\n```\n', "1: unknown comment 'runs', expected"),
    ('Text <!-- run -->\n', '1: expected a comment alone on its line'),
    ('<!-- not run: no time -->\n```sh\nls\n```\n', "2: not run: 'no time': expected one of installation, "),
    ('```text\nls\n```\n', '1: a text block without a comment directly above: one of output'),
    ('<!-- output -->\n```text\nls\n```\n', '2: output without a command before'),
    ('<!-- run -->\n```sh\nls\n```\n<!-- output of base -->\n```text\nls\n```\n', "6: no terminal 'base' before"),
    ('```\nls\n```\n', '1: a block without a language'),
    ('```sh\nls\n', '1: this fence is not closed'),
    ('Text\n\n    ls\n', '3: an indented code block'),
    ('<!-- terminals: a, b -->\n```sh\nls\n```\n', '2: 2 names for 1 commands'),
    ('<!-- terminals: a, a -->\n```sh\nls\nls\n```\n', "2: a command runs in terminal 'a' already"),
    ('<!-- Ctrl-C: base -->\nPress Ctrl-C.\n', "1: no command runs in terminal 'base'"),
    ('<!-- terminal: a -->\n```sh\nls\n```\n<!-- Ctrl-C: a -->\nEnd it.\n', '5: Ctrl-C is missing in the line below'),
])
def test_errors(page, trouble):
    """Each is reported with its line."""
    with pytest.raises(ValueError) as caught:
        blocks.parse(page)
    assert str(caught.value).startswith(trouble)
