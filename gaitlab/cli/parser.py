"""Which commands and options there are. What they do lies in the other files of this folder, loaded when needed."""

from __future__ import annotations

import argparse
import importlib
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from gaitlab import __version__

if TYPE_CHECKING:
    Commands = argparse._SubParsersAction[argparse.ArgumentParser]

METHODS = ("gaitlab", "ikizoglu2018")
PLACEMENTS = ("left_foot", "right_foot", "left_knee", "right_knee")
VALIDATION_SETS = ("10m-walk", "leg-vicon", "foot-mocap", "foot-loop", "all", "coverage", "methods")


def build_parser() -> argparse.ArgumentParser:
    """The parser of the whole command line; each command carries its function as ``run``."""
    parser = argparse.ArgumentParser(
        prog="gaitlab", description="Clinical gait analysis from inertial sensors on feet and knees."
    )
    parser.add_argument("--version", action="version", version=f"gaitlab {__version__}")
    commands = parser.add_subparsers(title="commands", required=True, metavar="COMMAND")
    _analyze(commands)
    _doctor(commands)
    _validate(commands)
    _methods(commands)
    _compare(commands)
    _demo(commands)
    _serve(commands)
    _user(commands)
    _token(commands)
    _db(commands)
    _audit(commands)
    return parser


def _late(module: str, function: str) -> Callable[[argparse.Namespace], int]:
    """A function of this folder, imported when it is run: ``gaitlab --help`` should not load scipy."""

    def run(chosen: argparse.Namespace) -> int:
        status: int = getattr(importlib.import_module(f"gaitlab.cli.{module}"), function)(chosen)
        return status

    return run


def _analyze(commands: Commands) -> None:
    command = commands.add_parser(
        "analyze",
        help="analyse the recording of a walk",
        description="Analyse the recording of a walk and print its parameters. Where no placement is given it comes from"
        " file names, headers or a placement.json.",
    )
    _recording(command)
    command.add_argument(
        "--course", type=_positive, metavar="M", help="length of the timed course in metres (7.62: T25-FW)"
    )
    command.add_argument("--method", choices=METHODS, default=METHODS[0], help="default: %(default)s")
    command.add_argument(
        "--closed", action="store_true", help="use that each foot ends where it began; the result says so"
    )
    command.add_argument(
        "--known-way",
        type=_positive,
        metavar="M",
        help="use that the farthest place is M metres from the start; the result says so",
    )
    command.add_argument(
        "--out", type=_path, metavar="result.json", help="write the result as JSON; - for standard output"
    )
    command.add_argument(
        "--series", type=_folder, metavar="DIR", help="write the time series as CSV files into DIR"
    )
    command.add_argument(
        "--report",
        type=_report_path,
        action="append",
        default=[],
        metavar="out.html|out.pdf",
        help="write a report",
    )
    command.set_defaults(run=_late("analyze", "run"), usage_error=command.error)


def _recording(command: argparse.ArgumentParser) -> None:
    """Which files are read, and where each was worn."""
    command.add_argument(
        "paths", type=_path, nargs="*", metavar="PATH", help="a folder, a zip, or the files of one recording"
    )
    for placement in PLACEMENTS:
        option = f"--{placement.replace('_', '-')}"
        command.add_argument(
            option, type=_path, metavar="FILE", help=f"file of the {placement.replace('_', ' ')}"
        )
    command.add_argument(
        "--rate", type=_positive, metavar="HZ", help="sampling rate, where the files do not tell it"
    )


def _doctor(commands: Commands) -> None:
    command = commands.add_parser(
        "doctor",
        help="tell what a file is, how good it is, and what that means for a result",
        description="Tell what each file is: format, rate, clock, gaps, losses, saturation, units, missing columns, and what"
        " each means for a result. Exit status 1 if any of them cannot be used.",
    )
    command.add_argument(
        "files", type=_path, nargs="+", metavar="FILE", help="a recording's file, a folder or a zip"
    )
    command.add_argument(
        "--rate", type=_positive, metavar="HZ", help="sampling rate, where the file does not tell it"
    )
    command.add_argument("--json", action="store_true", help="print JSON")
    command.set_defaults(run=_late("doctor", "run"))


def _validate(commands: Commands) -> None:
    command = commands.add_parser(
        "validate",
        help="tell how far the figures are from the truth, on recordings that bring it with them",
        description="Analyse a folder of public recordings whose truth is known and print the table of errors beside the"
        " figures to reach. The recordings are found by the pattern of their names; one that cannot be used is listed with"
        " the reason, and the others count. The set coverage needs no folder: it simulates walks and tells how many of the"
        " 95 % intervals hold the truth. The set methods lays every published method beside its paper's own figures.",
    )
    command.add_argument("set", choices=VALIDATION_SETS, metavar="SET", help=", ".join(VALIDATION_SETS))
    command.add_argument(
        "folder",
        type=_path,
        nargs="?",
        metavar="DIR",
        help="folder of the recordings; for all and methods: the folder above; for coverage: none",
    )
    command.add_argument(
        "--json", type=_path, nargs="?", const="-", metavar="FILE", help="write JSON; - or nothing: print it"
    )
    command.add_argument("--trials", action="store_true", help="also each trial, stride or gait cycle")
    command.add_argument(
        "--markdown", action="store_true", help="methods: print a page instead of a table for the terminal"
    )
    command.add_argument("--all", action="store_true", help="methods: also calibrations, which take minutes")
    command.set_defaults(run=_late("validate", "run"), wrong_usage=command.error)


def _methods(commands: Commands) -> None:
    command = commands.add_parser(
        "methods",
        help="list the published methods that can be called by name",
        description="List the published methods that can be called by name: the question each answers, what it needs, and"
        " where it comes from. With a name: its constants with units and sources, and each deviation from the paper.",
    )
    command.add_argument(
        "name", nargs="?", metavar="NAME", help="show everything about the methods of this name"
    )
    command.add_argument("--json", action="store_true", help="print JSON")
    command.set_defaults(run=_late("methods", "run"))


def _compare(commands: Commands) -> None:
    command = commands.add_parser(
        "compare",
        help="compare every published method with ours on a recording of your own",
        description="Run every published method on a recording and print what each says beside ours: its numbers, the"
        " difference with its 95 % interval, and the time it took. A method whose input is missing says which. With --cohort"
        " each PATH is a recording of its own, and the lengths that the methods give are laid beside the known one.",
    )
    _recording(command)
    command.add_argument(
        "--known-length",
        type=_positive,
        metavar="M",
        help="how far each foot walked, in metres: sets the step-length models' factors",
    )
    command.add_argument("--height", type=_positive, metavar="M", help="the person's height in metres")
    command.add_argument("--sex", choices=("m", "f"), help="the person's sex")
    command.add_argument(
        "--methods", metavar="NAME,NAME", help="only these, and ours; gaitlab methods lists them"
    )
    command.add_argument("--cohort", action="store_true", help="several recordings of one known length")
    command.add_argument("--json", action="store_true", help="print JSON")
    command.set_defaults(run=_late("compare", "run"), wrong_usage=command.error)


def _demo(commands: Commands) -> None:
    command = commands.add_parser(
        "demo",
        help="make an example session, analyse it, store it and write its report",
        description="Simulate a timed 25-foot walk, write it as MT Manager files, read them like any others, analyse and"
        " store them, and write report.html, report.pdf and result.json.",
    )
    command.add_argument(
        "--dir", type=_folder, default=Path("gaitlab-demo"), help="where to put it all (default: %(default)s)"
    )
    command.add_argument("--serve", action="store_true", help="then serve the pages on this machine")
    command.add_argument("--port", type=_port, default=8000, help="default: %(default)s")
    command.set_defaults(run=_late("demo", "run"))


def _serve(commands: Commands) -> None:
    command = commands.add_parser(
        "serve",
        help="serve the pages and the REST interface",
        description="Serve the pages and the REST interface. The first start prints a one-time code for the first account."
        " Environment: GAITLAB_DATA_DIR (default gaitlab-data), GAITLAB_DATABASE_URL (default SQLite there).",
    )
    command.add_argument("--host", default="127.0.0.1", help="default: %(default)s, this machine only")
    command.add_argument("--port", type=_port, default=8000, help="default: %(default)s")
    command.add_argument(
        "--behind-proxy", action="store_true", help="a proxy on this machine speaks TLS for us"
    )
    command.set_defaults(run=_late("admin", "serve"))


def _user(commands: Commands) -> None:
    actions = commands.add_parser("user", help="accounts").add_subparsers(required=True, metavar="ACTION")
    add = actions.add_parser(
        "add", help="add an account; the password is asked for, or read from standard input"
    )
    add.add_argument("email")
    add.add_argument("--name", required=True)
    roles = ("admin", "clinician", "engineer", "reader")
    add.add_argument(
        "--role", action="append", choices=roles, required=True, help="may be given more than once"
    )
    add.set_defaults(run=_late("admin", "user_add"))
    actions.add_parser("list", help="list the accounts").set_defaults(run=_late("admin", "user_list"))
    disable = actions.add_parser("disable", help="end an account and its sessions and tokens")
    disable.add_argument("email")
    disable.set_defaults(run=_late("admin", "user_disable"))
    password = actions.add_parser("password", help="set a new password")
    password.add_argument("email")
    password.set_defaults(run=_late("admin", "user_password"))


def _token(commands: Commands) -> None:
    actions = commands.add_parser("token", help="API tokens").add_subparsers(required=True, metavar="ACTION")
    add = actions.add_parser("add", help="make a token for an account; it is shown this once")
    add.add_argument("email", help="whose rights it borrows")
    add.add_argument("--name", required=True, help="what it is for")
    add.add_argument(
        "--scope", action="append", help="permission such as session:write; default: all that REST needs"
    )
    add.add_argument(
        "--days", type=_days, default=90, help="until it expires (default: %(default)s, at most 365)"
    )
    add.set_defaults(run=_late("admin", "token_add"))
    actions.add_parser("list", help="list the tokens").set_defaults(run=_late("admin", "token_list"))
    revoke = actions.add_parser("revoke", help="end a token at once")
    revoke.add_argument("id")
    revoke.set_defaults(run=_late("admin", "token_revoke"))


def _db(commands: Commands) -> None:
    actions = commands.add_parser("db", help="the database").add_subparsers(required=True, metavar="ACTION")
    actions.add_parser("upgrade", help="bring its tables to this version").set_defaults(
        run=_late("admin", "db_upgrade")
    )
    actions.add_parser("status", help="say where it stands").set_defaults(run=_late("admin", "db_status"))
    actions.add_parser("sweep", help="remove contents that a crash left without a row").set_defaults(
        run=_late("admin", "db_sweep")
    )


def _audit(commands: Commands) -> None:
    actions = commands.add_parser("audit", help="the audit trail").add_subparsers(
        required=True, metavar="ACTION"
    )
    actions.add_parser("verify", help="recompute its chain of hashes").set_defaults(
        run=_late("admin", "audit_verify")
    )


def _path(text: str) -> str:
    if not text.strip():
        raise argparse.ArgumentTypeError("the path is empty")
    return text


def _folder(text: str) -> Path:
    return Path(_path(text))


def _days(text: str) -> int:
    if not (text.isdecimal() and len(text) <= 6):
        raise argparse.ArgumentTypeError(f"{text} is not a number of days")
    return int(text)


def _positive(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = -1.0
    if not 0.0 < value < float("inf"):
        raise argparse.ArgumentTypeError(f"{text} is not a number above zero")
    return value


def _port(text: str) -> int:
    value = int(text) if text.isdecimal() and len(text) <= 5 else 0
    if not 1 <= value <= 65535:
        raise argparse.ArgumentTypeError(f"{text} is not a port from 1 to 65535")
    return value


def _report_path(text: str) -> Path:
    path = Path(text)
    if path.suffix.lower() not in (".html", ".pdf"):
        raise argparse.ArgumentTypeError(f"{text} ends neither in .html nor in .pdf")
    return path
