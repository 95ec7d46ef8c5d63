"""Every published method on one recording, side by side with ours; and several recordings of one known length."""

from gaitlab.comparison.cohorts import Cohort, cohort
from gaitlab.comparison.comparing import compare
from gaitlab.comparison.model import Comparison
from gaitlab.comparison.text import cohort_json, cohort_text, to_json, to_text

__all__ = ["Cohort", "Comparison", "cohort", "cohort_json", "cohort_text", "compare", "to_json", "to_text"]
