"""What was measured: sensors on one packet clock, and the readers that get them out of files."""

from gaitlab.recording.file import InputFile
from gaitlab.recording.model import Finding, Placement, Recording, Sensor, Side, Source
from gaitlab.recording.reading import read_files, read_recording

__all__ = [
    "Finding",
    "InputFile",
    "Placement",
    "Recording",
    "Sensor",
    "Side",
    "Source",
    "read_files",
    "read_recording",
]
