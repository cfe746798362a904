"""Broken links, in repositories of a few files."""
import pytest
from pages import links

README = """\
# Top [of](docs/a.md) `it_all`, and more!
## Twice
## Twice
[a](docs/a.md), [![picture](docs/p.png "title")](docs/a.md#part), [ref][r]
[own](#top-of-it_all-and-more), [2](#twice-1)
[folder](docs) <https://example.org/x_(y)> [site](https://example.org/a(b)?q=1#c) `[no](link)`
<a name="here"></a> [here](#here)

[r]: docs/b%20c.md
```sh
[no](link)
```
"""
FILES = {'README.md': README, 'docs/a.md': '## Part\n[back](../README.md#twice)\n', 'docs/b c.md': '', 'docs/p.png': ''}


def problems(folder, **changed):
    """The problems of a repository with FILES, some added or changed."""
    for path, text in {**FILES, **changed}.items():
        (folder / path).parent.mkdir(exist_ok=True)
        (folder / path).write_text(text)
    return links.problems(str(folder))


def test_fine(tmp_path):
    assert problems(tmp_path) == []


@pytest.mark.parametrize('link, trouble', [
    ('[a](docs/none.md)', 'no such file'),
    ('[a](docs/A.md)', 'no such file'),
    ('![a](none.png)', 'no such file'),
    ('<img src="none.png">', 'no such file'),
    ('<a href="none.md">', 'no such file'),
    ('[x]: none.md', 'no such file'),
    ('[a](docs/a.md#none)', 'no such heading'),
    ('[a](#Twice)', 'no such heading'),
    ('[a](#twice-2)', 'no such heading'),
    ('[a](docs/p.png#L3)', 'expected an anchor in a Markdown page only'),
    ('[a](../other.md)', 'leads out of the repository'),
    ('[a](/docs/a.md)', 'leads out of the repository'),
    ('[a](http://example.org)', 'expected a relative link or https://host/...'),
    ('[a](https:/example.org)', 'expected a relative link or https://host/...'),
    ('[a](https://localhost)', 'expected a relative link or https://host/...'),
    ('<ftp://example.org>', 'expected a relative link or https://host/...'),
])
def test_broken(tmp_path, link, trouble):
    """In any Markdown file of the repository."""
    found, = problems(tmp_path, **{'CONTRIBUTING.md': f"Text\n{link}\n"})
    assert found.startswith('CONTRIBUTING.md:2: ') and found.endswith(f': {trouble}')
