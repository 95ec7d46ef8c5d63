"""From results to a report: all wording and rounding, no layout."""

from __future__ import annotations

import datetime as dt
import hashlib
import shlex
import statistics
from collections.abc import Sequence

from gaitlab.report.document import (
    Attachment,
    Comparison,
    Fact,
    FileRow,
    Report,
    SensorRow,
    SessionInfo,
    Subject,
    TrialReport,
    TrialSection,
)
from gaitlab.report.figures import Figure, figures
from gaitlab.report.parameters import group_tables, key_table
from gaitlab.report.strides import pooled_table, stride_rows
from gaitlab.report.summary import summary_sentences, verdict
from gaitlab.report.wording import count, decimals_for, number, percent, uncertainty, with_unit
from gaitlab.result import Foot, Parameter, Result

TESTS = {"t25fw": "Timed 25-foot walk", "10mwt": "10-metre walk test", "walk": "Free walk"}
MOST_SPANS = 12

VALUES_NOTE = (
    "Each value stands with its standard uncertainty (±, 68 %), its 95 % interval and n, the number of strides, "
    "steps or instants it rests on. Digits end where the uncertainty begins; intervals are rounded outwards."
)
STATUS_NOTE = (
    "Status: ok – may be used; attention – may be used with the reserve stated under it; not determinable – cannot "
    "be known from this recording, for the reason stated under it. A dash: no value of that kind."
)
FRAME = (
    "Axes: x along the first straight part of the walk, y to its left, z up; the origin lies midway between the "
    "feet at the start. Time 0 is the first packet of the recording."
)
RESIDUAL_NOTE = (
    "Residual velocity, median / largest: the speed that integration shows where the foot rests, before it is set to "
    "zero; the smaller, the better the stride before it. The knee has no rests of its own."
)


def build_report(
    subject: Subject | None,
    session: SessionInfo | None,
    trials: Sequence[TrialReport],
    *,
    created_at: dt.datetime,
) -> Report:
    """Word a session's report.

    ``subject`` and ``session`` may be None (an analysis on the command line). ``created_at`` has a time zone and is
    shown in UTC. The same arguments always give the same report.
    """
    subject, session = subject or Subject(), session or SessionInfo()
    created_at = created_at.astimezone(dt.UTC)
    hashes = [hashlib.sha256(trial.result.to_json().encode()).hexdigest() for trial in trials]
    sections = tuple(
        _section(trial, len(trials), digest) for trial, digest in zip(trials, hashes, strict=True)
    )
    joined = "".join(f"{digest}\n" for digest in hashes)
    test = TESTS.get(session.test, session.test)
    occasion = [part for part in (test, session.date.isoformat() if session.date else "") if part]
    return Report(
        title="Gait report",
        person=f"Patient {subject.code}" if subject.code else "No patient given",
        occasion=", ".join(occasion) or "Analysis of a recording",
        subject=_subject_facts(subject),
        session=_session_facts(session, len(trials)),
        trials=sections,
        comparison=_comparison(sections) if len(sections) > 1 else None,
        pooled=pooled_table([trial.result for trial in trials]),
        legend=(VALUES_NOTE, STATUS_NOTE),
        frame=FRAME,
        residual_note=RESIDUAL_NOTE,
        created=f"{created_at:%Y-%m-%d %H:%M} UTC",
        created_at=created_at,
        fingerprint=hashes[0] if len(hashes) == 1 else hashlib.sha256(joined.encode()).hexdigest(),
        attachments=tuple(
            Attachment(
                section.attachment,
                trial.result.to_json(),
                f"Result of trial {trial.number} (gaitlab.result/1)",
            )
            for section, trial in zip(sections, trials, strict=True)
        ),
    )


def _subject_facts(subject: Subject) -> tuple[Fact, ...]:
    rows = (
        ("Sex", "" if subject.sex == "unknown" else subject.sex),
        ("Born", "" if subject.birth_year is None else str(subject.birth_year)),
        ("Height", _metres(subject.height_m)),
        ("Weight", "" if subject.weight_kg is None else with_unit(f"{subject.weight_kg:g}", "kg")),
        ("Leg length", _metres(subject.leg_length_m)),
        ("Diagnosis", subject.diagnosis),
        ("Note", subject.note),
    )
    return tuple(Fact(label, value) for label, value in rows if value)


def _metres(value: float | None) -> str:
    return "" if value is None else with_unit(number(value, 2), "m")


def _session_facts(session: SessionInfo, n_trials: int) -> tuple[Fact, ...]:
    rows = (
        ("Course", "" if session.course_m is None else with_unit(f"{session.course_m:g}", "m")),
        ("Trials", str(n_trials) if n_trials > 1 else ""),
        ("Site", session.site),
        ("Session note", session.note),
    )
    return tuple(Fact(label, value) for label, value in rows if value)


def _section(trial: TrialReport, n_trials: int, digest: str) -> TrialSection:
    result = trial.result
    drawn = figures(result, trial.series, prefix=f"t{trial.number}-" if n_trials > 1 else "")
    return TrialSection(
        number=trial.number,
        heading=f"Trial {trial.number}" if n_trials > 1 else "",
        verdict=verdict(result),
        summary=summary_sentences(result),
        key=key_table(result),
        groups=group_tables(result),
        walk=_walk_facts(result),
        overview_figures=tuple(figure for figure in drawn if figure.wide),
        figure_pairs=_pairs([figure for figure in drawn if not figure.wide]),
        sensors=_sensor_rows(result),
        headings=tuple(
            f"Heading of the {placement.replace('_', ' ')}: {sensor.heading}."
            for placement, sensor in result.sensors.items()
            if sensor.heading
        ),
        strides=stride_rows(result),
        warnings=tuple(_warnings(result)),
        provenance=_provenance(result, digest),
        files=tuple(
            FileRow(f.placement.replace("_", " "), f.name, f.sha256) for f in result.provenance.inputs
        ),
        command=_command(result),
        attachment="result.json" if n_trials == 1 else f"trial-{trial.number}-result.json",
    )


def _pairs(single: Sequence[Figure]) -> tuple[tuple[Figure, ...], ...]:
    """Left and right of the same kind beside each other; one alone where the other is missing."""
    kinds: dict[str, list[Figure]] = {}
    for figure in single:
        kinds.setdefault(figure.name.split("_", 1)[1], []).append(figure)
    return tuple(tuple(kind) for kind in kinds.values())


def _walk_facts(result: Result) -> tuple[Fact, ...]:
    walk = result.walk
    facts = []
    if walk.timed is not None:
        course = with_unit(f"{walk.timed.course_m:g}", "m")
        facts.append(
            Fact(
                "Timed",
                f"{course}, from {_span(walk.timed.start_s, walk.timed.end_s)}; start: {walk.timed.rule}",
            )
        )
    check = result.parameter("course_check")
    if check is not None and check.value is not None:
        facts.append(Fact("Walk against the course", _course_check(check)))
    if walk.straights:
        facts.append(Fact("Straight parts", _some([_span(s.start_s, s.end_s) for s in walk.straights])))
    if walk.turns:
        spans = [f"{_span(t.start_s, t.end_s)}, {number(t.angle_deg, 0)}°" for t in walk.turns]
        facts.append(Fact("Turns (positive to the left)", _some(spans)))
    for side, foot in sorted(result.feet.items()):
        facts.append(Fact(f"{side.capitalize()} foot", _foot_fact(foot)))
    return tuple(facts)


def _course_check(check: Parameter) -> str:
    """The farthest place of rest against the known course: shown, never used."""
    decimals = decimals_for(check.sd, check.decimals)
    sign = "+" if (check.value or 0.0) > 0 else ""
    said = with_unit(f"{sign}{number(check.value or 0.0, decimals)} {uncertainty(check.sd, decimals)}", "%")
    reserve = check.reason if check.status != "ok" else "A check of the scale; no value is corrected by it."
    return f"{said}. {reserve}"


def _foot_fact(foot: Foot) -> str:
    turning = sum(stride.turning for stride in foot.strides)
    doubted = [
        sum(stride.quality == quality for stride in foot.strides) for quality in ("attention", "invalid")
    ]
    judged = f", {doubted[0]} with attention, {doubted[1]} invalid" if any(doubted) else ""
    return (
        f"{count(len(foot.strides), 'stride')}, {turning} of them in turns{judged}; "
        f"{count(len(foot.rests), 'rest')}; {count(len(foot.events.initial_contact_s), 'initial contact')}, "
        f"{len(foot.events.foot_off_s)} times foot off"
    )


def _span(start_s: float, end_s: float) -> str:
    return f"{number(start_s, 2)} to {with_unit(number(end_s, 2), 's')}"


def _some(spans: list[str]) -> str:
    more = f"; and {len(spans) - MOST_SPANS} more" if len(spans) > MOST_SPANS else ""
    return "; ".join(spans[:MOST_SPANS]) + more


def _sensor_rows(result: Result) -> tuple[SensorRow, ...]:
    rows = []
    for placement, sensor in result.sensors.items():
        side, _, part = placement.partition("_")
        foot = next((f for name, f in result.feet.items() if name == side), None) if part == "foot" else None
        rows.append(
            SensorRow(
                label=placement.replace("_", " "),
                device=sensor.device or "–",
                samples=str(sensor.samples),
                lost=f"{sensor.lost} ({percent(sensor.lost, sensor.samples)})",
                saturated=str(sensor.saturated),
                rests=str(len(foot.rests)) if foot else "–",
                residual=_residual(foot),
            )
        )
    return tuple(rows)


def _residual(foot: Foot | None) -> str:
    if foot is None or not foot.rests:
        return "–"
    sizes = [abs(rest.residual_velocity_mps) for rest in foot.rests]
    return f"{number(statistics.median(sizes), 3)} / {with_unit(number(max(sizes), 3), 'm/s')}"


def _warnings(result: Result) -> list[str]:
    said = []
    for warning in result.warnings:
        where = warning.placement.replace("_", " ").capitalize() + ": " if warning.placement else ""
        said.append(f"{where}{warning.message}")
    return said


def _provenance(result: Result, digest: str) -> tuple[Fact, ...]:
    made = result.provenance
    chosen = {key: "not set" if value is None else value for key, value in sorted(made.settings.items())}
    settings = "; ".join(f"{key} = {value}" for key, value in chosen.items())
    return (
        Fact("gaitlab", made.gaitlab),
        Fact("Method", made.method),
        Fact("Settings", settings or "–"),
        Fact("Settings, SHA-256", made.settings_sha256),
        Fact(
            "Clock",
            f"{with_unit(f'{result.clock.rate_hz:g}', 'Hz')}, first packet {result.clock.first_packet}",
        ),
        Fact("Result, SHA-256", digest),
    )


def _command(result: Result) -> str:
    """The command that computes this result again, with the files in the working folder."""
    words = ["gaitlab", "analyze"]
    for given in result.provenance.inputs:
        words += [f"--{given.placement.replace('_', '-')}", given.name]
    chosen = result.provenance.settings
    for option, name in (("--course", "course_m"), ("--known-way", "way_m")):
        length = chosen.get(name)
        if length is not None:
            words += [option, f"{length:g}" if isinstance(length, float) else str(length)]
    if chosen.get("closed"):
        words.append("--closed")
    words += ["--method", result.provenance.method, "--out", "result.json"]
    return shlex.join(words)


def _comparison(sections: Sequence[TrialSection]) -> Comparison:
    """Key values of the trials; where a parameter has no value for both sides, left and right."""
    labels = dict.fromkeys((row.label, row.unit) for section in sections for row in section.key.rows)
    rows = []
    for label, unit in labels:
        values = []
        for section in sections:
            row = next((r for r in section.key.rows if r.label == label), None)
            cells = [] if row is None else [row.both] if row.both else [c for c in (row.left, row.right) if c]
            values.append(" / ".join(f"{cell.value} {cell.uncertainty}".strip() for cell in cells) or "–")
        rows.append((f"{label}, {unit}" if unit else label, *values))
    rows.append(("Quality", *(section.verdict.label for section in sections)))
    return Comparison(("Key values (left / right)", *(section.heading for section in sections)), tuple(rows))
