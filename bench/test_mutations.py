"""The list of constants that are not changed has only names that the package has."""
import mutations


def test_each_constant_of_the_list_exists():
    assert mutations.unknown_tuning() == []
