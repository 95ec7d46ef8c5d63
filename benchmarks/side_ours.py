"""gaitlab's side of ``side_by_side.py``: files in memory → recording → result."""

from __future__ import annotations

import sys
from pathlib import Path

from worker import one_core, serve

one_core()

from gaitlab.analysis import Settings, analyze  # noqa: E402 on its core before anything is loaded
from gaitlab.recording import InputFile, Placement, Recording, read_files  # noqa: E402


def main() -> None:
    left, right = (Path(name) for name in sys.argv[1:3])
    files = {
        Placement.LEFT_FOOT: InputFile(left.name, left.read_bytes()),
        Placement.RIGHT_FOOT: InputFile(right.name, right.read_bytes()),
    }

    def analysed(recording: object) -> str:
        assert isinstance(recording, Recording)
        feet = analyze(recording, Settings()).result.feet
        return ", ".join(f"{len(foot.strides)} strides {side}" for side, foot in feet.items())

    def parse_with_pandas() -> None:
        import pandas as pd
        from texts import frame_of

        for file in files.values():
            assert isinstance(frame_of(file.content), pd.DataFrame)

    serve(lambda: read_files(files), analysed, parse_with_pandas if "--pandas" in sys.argv else None)


if __name__ == "__main__":
    main()
