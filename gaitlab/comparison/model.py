"""What a comparison of methods hands on: a table for each question, and what its pictures are drawn from."""

from __future__ import annotations

from dataclasses import dataclass

from gaitlab.analysis import Analysis
from gaitlab.methods.model import Method, Question
from gaitlab.recording.model import Floats, Side


@dataclass(frozen=True)
class Value:
    """One number of a method: ``mean stride 1.42 m``. NaN where nothing determines it."""

    name: str
    value: float
    unit: str
    decimals: int
    signed: bool = False


@dataclass(frozen=True)
class Difference:
    """Method less ours over pairs: strides, rests or cycles that both have.

    Attributes
    ----------
    of : str
        What is compared: ``stride length``.
    mean : float
        NaN where there is no pair.
    half_width : float
        Of its 95 % interval: Student's t over the pairs, and what all values of ours share. NaN for fewer than two.
    n : int
        Pairs.
    pairs : str
        What they are: ``strides``.
    """

    of: str
    mean: float
    half_width: float
    n: int
    pairs: str
    unit: str
    decimals: int

    @property
    def differs(self) -> bool:
        """The interval does not hold zero."""
        return abs(self.mean) > self.half_width


@dataclass(frozen=True)
class Answer:
    """What a method says of one side; ``reason`` where it says nothing, or what is to be known of it."""

    side: Side
    values: tuple[Value, ...]
    reason: str = ""


@dataclass(frozen=True)
class Line:
    """A method in the table of its question.

    Attributes
    ----------
    answers : tuple of Answer
        One a side that it was run on; none where an input is missing.
    difference : Difference or None
        None for our own method and where nothing of ours is its counterpart.
    seconds : float
        Spent in the method itself; NaN where it was not run.
    reason : str
        Why it has no answer.
    failed : bool
        It broke: a fault of the program.
    """

    method: Method
    answers: tuple[Answer, ...]
    difference: Difference | None
    seconds: float
    reason: str = ""
    failed: bool = False

    def answer(self, side: Side) -> Answer | None:
        """What it says of a side."""
        return next((one for one in self.answers if one.side is side), None)


@dataclass(frozen=True)
class QuestionTable:
    """The methods that answer one question."""

    question: Question
    lines: tuple[Line, ...]

    def line(self, name: str) -> Line:
        """The method of that name."""
        return next(line for line in self.lines if line.method.name == name)


@dataclass(frozen=True, eq=False)
class MethodPath:
    """Places of one foot by one method from above, shape (k, 2), from (0, 0)."""

    method: str
    side: Side
    place_m: Floats


@dataclass(frozen=True, eq=False)
class MethodLengths:
    """Stride lengths of one foot by one method and by ours, shapes (m,); NaN where not determinable."""

    method: str
    side: Side
    length_m: Floats
    ours_m: Floats


@dataclass(frozen=True, eq=False)
class Comparison:
    """All methods on one recording.

    Attributes
    ----------
    analysis : Analysis
        Ours, to which all are compared.
    seconds : float
        For all of it.
    """

    analysis: Analysis
    tables: tuple[QuestionTable, ...]
    paths: tuple[MethodPath, ...]
    lengths: tuple[MethodLengths, ...]
    known_length_m: float | None
    seconds: float

    def table(self, question: Question) -> QuestionTable:
        """The table of a question."""
        return next(table for table in self.tables if table.question is question)


def is_ours(method: Method) -> bool:
    """Whether it is gaitlab's own."""
    return method.name.startswith("gaitlab")
