"""Laws written in Python."""
