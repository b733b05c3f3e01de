"""Commands run in the process of the tests."""

from freesweep.cli import BAD_INPUT, main


def run(*words):
    """Exit code of a command, in this process."""
    try:
        return main(list(words))
    except SystemExit as end:  # argparse
        return end.code


def refused(capsys, *words, code=BAD_INPUT):
    """What a refused command says on standard error; nothing on standard output."""
    assert run(*words) == code
    out, err = capsys.readouterr()
    assert out == ""
    assert "Traceback" not in err
    return err
