"""The readers, one per family of files. A further family is a further line here."""

from __future__ import annotations

from gaitlab.recording import mtmanager
from gaitlab.recording.file import InputFile
from gaitlab.recording.samples import Samples


def read_samples(file: InputFile) -> Samples:
    """Read a sensor file by the family its content belongs to.

    So far there is one, MT Manager text; its reader refuses every other file by name of what it is.
    """
    return mtmanager.read(file)
