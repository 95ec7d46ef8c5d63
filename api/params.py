"""Parameters that several routes share."""

from __future__ import annotations

from typing import Annotated

from fastapi import Path

Id = Annotated[
    str, Path(pattern=r"^[A-Za-z0-9_-]{1,64}$", description="Identifier as given in an earlier answer.")
]
"""An identifier in a path. What cannot be one is not found, and never reaches the database."""

KEY_PATTERN = r"^[\x21-\x7e]{1,64}$"
"""What an idempotency key may look like."""
