"""Tribology of dry contacts: non-smooth contact dynamics with interface laws that users write."""

from fretwork._fretwork import __version__

__all__ = ["__version__"]
