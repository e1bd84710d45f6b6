"""Handlers of signals are restored, whatever arrives meanwhile."""

import signal

import pytest

from crazybilliards.model.process import interrupts_noted


def test_ctrl_c_between_two_restorations_leaves_no_handler_behind(monkeypatch):
    before = signal.getsignal(signal.SIGTERM)
    setting = signal.signal

    def and_interrupt(number, handler):
        earlier = setting(number, handler)
        if handler is signal.default_int_handler:  # from here on Ctrl-C raises an error again
            signal.raise_signal(signal.SIGINT)
        return earlier

    monkeypatch.setattr(signal, "signal", and_interrupt)
    came = []

    def interrupted_thrice():
        with interrupts_noted() as noted:
            signal.raise_signal(signal.SIGINT)
            signal.raise_signal(signal.SIGTERM)
            came.extend(noted)

    with pytest.raises(KeyboardInterrupt):
        interrupted_thrice()
    assert came == [signal.SIGINT, signal.SIGTERM]
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    assert signal.getsignal(signal.SIGTERM) == before
