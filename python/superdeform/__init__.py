"""Turns a normal 3D character into its super-deformed (SD, chibi) version.

`convert` takes the bytes of a GLB or VRM file and gives those of another. `Character`, `Style` and `Deformer` do the same with
NumPy arrays. `OPTIONS` has every number that can be set: its range, its default, what it does.
"""

from .abi import OPTIONS
from .character import Character
from .deformer import Deformed, Deformer
from .files import Conversion, convert
from .library import Error, version
from .options import options
from .style import Style

__all__ = ["OPTIONS", "Character", "Conversion", "Deformed", "Deformer", "Error", "Style", "convert", "options", "version"]
__version__ = version()
