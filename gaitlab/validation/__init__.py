"""How far the figures are from the truth: tables of error on recordings that bring their truth with them."""

from gaitlab.validation.coverage import coverage_table
from gaitlab.validation.methods import methods_tables
from gaitlab.validation.methods_model import tables_json, tables_markdown, tables_text
from gaitlab.validation.model import Table
from gaitlab.validation.sets import SETS, validate, validate_all
from gaitlab.validation.text import to_json, to_text

__all__ = [
    "SETS",
    "Table",
    "coverage_table",
    "methods_tables",
    "tables_json",
    "tables_markdown",
    "tables_text",
    "to_json",
    "to_text",
    "validate",
    "validate_all",
]
