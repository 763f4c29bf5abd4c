"""The test bench and the lists of laws."""
from __future__ import annotations
Certificate = Check = Field = Info = certify = drive = inputs = list = show = None
