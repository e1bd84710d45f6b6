"""That kernels are compiled is said where somebody waits for it, once, and only if they are."""

from crazybilliards.model.process import announce_compilation, announced


def test_compiling_is_said_once_and_only_to_those_who_asked(capsys):
    announce_compilation()
    with announced(False):
        announce_compilation()
    with announced(True):
        pass  # every kernel was in the cache
    assert capsys.readouterr().err == ""
    with announced(True):
        announce_compilation()
        announce_compilation()
    announce_compilation()
    assert capsys.readouterr().err.count("compiling the kernels") == 1
