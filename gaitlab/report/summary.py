"""A trial in plain sentences, and whether it may be used."""

from __future__ import annotations

from gaitlab.gait.verdicts import Quality
from gaitlab.quality import severity
from gaitlab.report.document import Verdict
from gaitlab.report.parameters import key_names
from gaitlab.report.strides import STATUS_OF
from gaitlab.report.wording import common_decimals, count, listed, number, percent, spoken, with_unit
from gaitlab.result import Parameter, Result, TrialQuality

LOSS_OF_NOTE = 0.05
"""Share of lost samples of one sensor from which the verdict mentions it."""

RESTS_ON_AN_ASSUMPTION = frozenset({"step_length"})
"""Key values that always rest on how the feet stood, so that they say nothing about this recording."""

MOST_NAMES = 3
MOST_REASONS = 4


def summary_sentences(result: Result) -> tuple[str, ...]:
    """Time, speed, lengths, rhythm and turns with their uncertainty; a missing walking time with the reason."""
    made = [_time(result), _gait(result), _support(result), _turns(result)]
    said = tuple(sentence for sentence in made if sentence)
    return said or ("No gait parameter could be determined from this recording.",)


def _time(result: Result) -> str:
    time = result.parameter("walk_time")
    timed = result.walk.timed
    if time is None or "walk_time" not in key_names(result):
        return ""
    if time.value is None:
        return f"The time over the course is not determinable: {_lower(time.reason)}"
    course = with_unit(f"{timed.course_m:g}", "m") if timed else "the course"
    pace = _sides(result, "walk_speed")
    return f"Walked {course} in {_sides(result, 'walk_time')}{f', at {pace} from standing' if pace else ''}."


def _gait(result: Result) -> str:
    steady, whole = _sides(result, "steady_speed"), _sides(result, "stride_velocity")
    return _joined(
        f"steady speed {steady}" if steady else f"speed of the straight strides {whole}" if whole else "",
        _named(result, "stride length", "stride_length"),
        _named(result, "cadence", "cadence"),
    )


def _support(result: Result) -> str:
    stance = _named(result, "stance", "stance_share")
    return _joined(
        f"{stance} of the stride" if stance else "", _named(result, "double support", "double_support_share")
    )


def _named(result: Result, label: str, name: str) -> str:
    told = _sides(result, name)
    return f"{label} {told}" if told else ""


def _joined(*parts: str) -> str:
    said = "; ".join(part for part in parts if part)
    return f"{said[0].upper()}{said[1:]}." if said else ""


def _turns(result: Result) -> str:
    turns = result.walk.turns
    if not turns:
        return "No turn." if result.walk.straights else ""
    if len(turns) > 3:
        return f"{count(len(turns), 'turn')}."
    angles = [
        f"{number(abs(t.angle_deg), 0)}° to the {'left' if t.angle_deg > 0 else 'right'}" for t in turns
    ]
    return f"{count(len(turns), 'turn')}: {listed(angles)}."


def _sides(result: Result, name: str) -> str | None:
    """``1.31 ± 0.02 m`` of both, else ``left 1.30 ± 0.02 m, right …``."""
    same = [p for p in result.parameters if p.name == name]
    decimals = common_decimals(same)
    found = {p.side: spoken(p, decimals) for p in same}
    if found.get("both"):
        return found["both"]
    said = [f"{side} {found[side]}" for side in ("left", "right") if found.get(side)]
    return ", ".join(said) or None


def verdict(result: Result) -> Verdict:
    """May the trial be used? The analysis says so; of a result stored before it did, the key values, the lost samples
    and the warnings decide."""
    counted = set(key_names(result)) - RESTS_ON_AN_ASSUMPTION
    key = [p for p in result.parameters if p.name in counted] or list(result.parameters)
    known = [p for p in key if p.value is not None]
    reserved = [p for p in known if p.status == "attention"]
    missing = [p for p in key if p.value is None]
    loss = _loss(result)
    if not key:
        return Verdict("not_determinable", "Not usable", "The analysis has no parameters.")
    said = [f"{len(known)} of {count(len(key), 'key value')} determined"]
    if reserved:
        said.append(f"{len(reserved)} with attention{_names(reserved)}")
    if missing and known:
        said.append(f"{len(missing)} missing{_names(missing)}")
    words = f"See {count(len(result.warnings), 'warning')}." if result.warnings else ""
    text = " ".join(part for part in ("; ".join(said) + ".", loss, words) if part)
    if result.quality is not None:
        return _stored_verdict(result.quality, text)
    if not known:
        return Verdict("not_determinable", "Not usable", text)
    serious = any(severity(warning.code) is not Quality.VALID for warning in result.warnings)
    if reserved or missing or loss or serious:
        return Verdict("attention", "Usable with attention", text)
    return Verdict("ok", "Usable", text)


def _stored_verdict(quality: TrialQuality, text: str) -> Verdict:
    """The analysis's own verdict, with as many reasons as one reads at the top."""
    reasons, more = quality.reasons[:MOST_REASONS], len(quality.reasons) - MOST_REASONS
    rest = (f"And {count(more, 'more reason')}: see the warnings.",) if more > 0 else ()
    return Verdict(STATUS_OF[quality.status], quality.status.capitalize(), text, (*reasons, *rest))


def _loss(result: Result) -> str:
    high = {
        name.replace("_", " "): percent(sensor.lost, sensor.samples)
        for name, sensor in result.sensors.items()
        if sensor.samples and sensor.lost / sensor.samples >= LOSS_OF_NOTE
    }
    return f"Lost samples: {listed([f'{name} {share}' for name, share in high.items()])}." if high else ""


def _names(parameters: list[Parameter]) -> str:
    """`` (step length left/right)``; nothing where there are too many to read."""
    sides: dict[str, list[str]] = {}
    for parameter in parameters:
        sides.setdefault(_lower(parameter.label), []).extend(
            [] if parameter.side == "both" else [parameter.side]
        )
    if len(sides) > MOST_NAMES:
        return ""
    named = [" ".join([label, "/".join(found)]).strip() for label, found in sides.items()]
    return f" ({', '.join(named)})"


def _lower(text: str) -> str:
    return text[:1].lower() + text[1:]
