"""dilatedem: broken sea ice against offshore structures, by the discrete element method of dilated polyhedra."""

__version__ = "0.1.0"
