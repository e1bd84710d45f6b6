"""Whatever its options, a command ends with a result or with one line and exit status 2.

Each option of each command gets nasty values, one at a time, the others being those of a small
job. The command runs in this process, and a Ctrl-C is sent after two seconds to jobs that are
long. It must end with status 0, with 2 and one line on standard error, or by Ctrl-C; never with a
traceback, and never with NaN in what it prints.
"""

import pytest
from exploration import interrupted_when_long
from typer.main import get_command

from crazybilliards.apps.commands.line import app, main

NASTY = [
    *("x", "nan", "inf", "-inf", "0", "-1", "1.5", "1e300", "-1e300", "1e-300", "1e60", "1e-60"),
    *("1000000000", "true", "None", "", "1,2", ",", "1,,2", "nan,1", "\x00", "é\n"),
    *("9" * 30, "9" * 5000),
]
SMALL = {
    "compare": ["--size", "4", "--duration", "300", "--amplitude", "1", "--threads", "1"],
    "simulate": ["--size", "4", "--duration", "50", "--threads", "1"],
    "relax": ["--size", "4", "--duration", "1", "--replicas", "2", "--threads", "1"],
    "theory": ["--size", "4", "--restitution", "1"],
}
# Not tried: paths, and what only switches something on.
LEFT_OUT = {"output", "checkpoint", "help"}
OPTIONS = [
    (command, option.opts[0])
    for command in SMALL
    for option in get_command(app).commands[command].params
    if option.opts[0].startswith("--") and option.name not in LEFT_OUT
]


def ended(arguments, monkeypatch):
    """Run a command; return its exit status."""
    monkeypatch.setattr("sys.argv", ["crazybilliards", *arguments])
    try:
        with interrupted_when_long(), pytest.raises(SystemExit) as caught:
            main()
    except KeyboardInterrupt:  # between two commands
        return 130
    return caught.value.code


def require_clear(status, printed):
    """Check how a command ended and what it said."""
    assert "Traceback" not in printed.err
    assert "nan" not in printed.out
    if status == 2:
        lines = [line for line in printed.err.splitlines() if line.strip()]
        assert len(lines) == 1, lines
        assert lines[0].startswith("crazybilliards: error: ")
        assert len(lines[0]) < 600
    else:
        assert status in (0, None, 1, 130), (status, printed.err)


@pytest.mark.filterwarnings("ignore:amplitude=0 and a start at rest")
@pytest.mark.filterwarnings("ignore:.* has no (arctanh fit|theory)")
@pytest.mark.filterwarnings("ignore:stiffness=0. nothing ties the rods")
@pytest.mark.parametrize(("command", "option"), OPTIONS)
def test_an_option_is_taken_or_refused_in_one_line(command, option, monkeypatch, capsys):
    for value in NASTY:
        arguments = [command, *SMALL[command], option, value]
        require_clear(ended(arguments, monkeypatch), capsys.readouterr())
