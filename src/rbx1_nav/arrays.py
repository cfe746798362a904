"""The type of an array of numbers, for type hints."""
from typing import TYPE_CHECKING

import numpy

if TYPE_CHECKING:
    from numpy.typing import NDArray    # not available in Debian 11's numpy

    Array = NDArray[numpy.float64]
else:
    Array = numpy.ndarray
