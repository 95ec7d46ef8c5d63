"""What can go wrong, in words for the person who can mend it. No HTTP here: the web maps class to status.

GaitlabError
├── InputError        a file, a field or a recording cannot be used as it is          (exit 1, 422)
├── TooLarge          a body, a file or an archive is over its limit                  (exit 1, 413)
├── NotAllowed        the caller is known and may not do this                         (exit 1, 403)
├── NotLoggedIn       the caller is not known                                         (exit 1, 401)
├── NotFound          there is no such thing, or it is another site's                 (exit 1, 404)
├── Conflict          the request contradicts what is stored                          (exit 1, 409)
├── TooManyAttempts   log-ins or codes were tried too often                           (exit 1, 429)
└── Misconfigured     the installation itself is wrong; nothing is served             (exit 1, 503)
"""

from __future__ import annotations


class GaitlabError(Exception):
    """One problem in one sentence, with what to do about it.

    Attributes
    ----------
    code : str
        Stable machine-readable name, such as ``not_a_number``.
    message : str
        What is wrong, in one sentence.
    hint : str
        What to do about it; may be empty.
    """

    def __init__(self, code: str, message: str, hint: str = "") -> None:
        super().__init__(message)
        self.code = code
        self.message = message
        self.hint = hint

    def __str__(self) -> str:
        return f"{self.message} {self.hint}".strip()


class InputError(GaitlabError):
    """A file, a form field or a recording that cannot be used as it is.

    Attributes
    ----------
    file : str or None
        Name of the file as the user gave it.
    line : int or None
        Line in that file, counted from 1.
    column : str or None
        Heading of the column (or name of the form field).
    """

    def __init__(
        self,
        code: str,
        message: str,
        hint: str = "",
        *,
        file: str | None = None,
        line: int | None = None,
        column: str | None = None,
    ) -> None:
        super().__init__(code, message, hint)
        self.file = file
        self.line = line
        self.column = column

    @property
    def place(self) -> str:
        """Where the problem is: ``walk_lf.txt, line 12, column Acc_X``; empty where it is in no file."""
        parts = [self.file or ""]
        if self.line is not None:
            parts.append(f"line {self.line}")
        if self.column is not None:
            parts.append(f"column {self.column}")
        return ", ".join(part for part in parts if part)

    def __str__(self) -> str:
        return f"{self.place}: {super().__str__()}" if self.place else super().__str__()


class TooLarge(InputError):
    """A body, a file or an archive over its limit."""


class NotAllowed(GaitlabError):
    """The caller is known and may not do this."""


class NotLoggedIn(GaitlabError):
    """The caller is not known, or no longer."""


class NotFound(GaitlabError):
    """There is no such thing, or it belongs to another site: the two look the same."""


class Conflict(GaitlabError):
    """The request contradicts what is stored."""


class TooManyAttempts(GaitlabError):
    """Log-ins or codes were tried too often."""


class Misconfigured(GaitlabError):
    """The installation itself is wrong; nothing is served until it is mended."""
