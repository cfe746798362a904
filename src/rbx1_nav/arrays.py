"""The type of an array of numbers, for hints."""
from typing import TYPE_CHECKING

import numpy

if TYPE_CHECKING:
    from numpy.typing import NDArray    # Debian 11's numpy does not have it

    Array = NDArray[numpy.float64]
else:
    Array = numpy.ndarray
