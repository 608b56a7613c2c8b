"""Ctrl-C and other signals while the engine works."""

import os
import signal
import subprocess
import sys
import threading
import time

import pytest

import holonom as hm

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals are sent otherwise there")


@pytest.fixture
def interrupt():
    """Sends Ctrl-C once, after a while."""
    # Where the tests are started in the background, the signal is ignored from the start.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    yield
    timer.join()
    signal.signal(signal.SIGINT, before)


class TooLate(Exception):
    pass


@pytest.fixture
def alarm():
    """Has a handler of a signal raise an exception, after a while."""

    def ring(*_):
        raise TooLate("time is over")

    before = signal.signal(signal.SIGALRM, ring)
    signal.setitimer(signal.ITIMER_REAL, 0.3)
    yield
    signal.setitimer(signal.ITIMER_REAL, 0)
    signal.signal(signal.SIGALRM, before)


LONG = {"end": 2e4, "step": 1e-3}


def pendulum():
    m = hm.load("example:double-pendulum")
    m.output(every=1000)
    return m


def test_ctrl_c_stops_a_run_and_keeps_it(interrupt):
    run = pendulum().simulate(**LONG)
    assert (run.status, run.reason) == ("stopped", "interrupted")
    assert len(run) > 1 and run.t[-1] < 2e4


# Where the tests are started in the background, the signal is ignored from the start.
STUDY = """
import signal, sys, holonom as hm
signal.signal(signal.SIGINT, signal.default_int_handler)
m = hm.load("example:double-pendulum")
study = hm.sweep(m, rows={"simulation.end": [0.01] + [1e6] * 3}, step=0.01, columns=["energy"], out=sys.argv[1], threads=2)
print(len(study), study.whole, flush=True)
"""


def test_ctrl_c_ends_a_study_and_keeps_what_there_is(tmp_path):
    study = subprocess.Popen([sys.executable, "-c", STUDY, str(tmp_path)], stdout=subprocess.PIPE, text=True)
    journal = tmp_path / "sweep.journal"
    while not (journal.exists() and journal.read_bytes().count(b"\n") >= 2):
        assert study.poll() is None
        time.sleep(0.02)
    study.send_signal(signal.SIGINT)
    assert study.communicate(timeout=60)[0].split() == ["1", "False"] and study.returncode == 0


def test_one_ctrl_c_ends_a_comparison(interrupt):
    with pytest.raises(KeyboardInterrupt):
        pendulum().compare(methods=["conserving-ggl", "radau", "trapezoidal"], **LONG)


CALLS = {
    "simulate": lambda m: m.simulate(**LONG),
    "sweep": lambda m: hm.sweep(m, {"simulation.end": [2e4] * 4}, step=1e-3),
    "compare": lambda m: m.compare(methods=["conserving-ggl", "radau"], **LONG),
    "stability": lambda m: m.stability(methods=["conserving-ggl", "radau"], **LONG),
    "step": lambda m: hm.Simulation(m, step=1e-3).step(10**8),
}


@pytest.mark.parametrize("call", CALLS.values(), ids=CALLS.keys())
def test_what_the_handler_of_a_signal_raises_comes_out_as_it_is(alarm, call):
    begun = time.monotonic()
    with pytest.raises(TooLate, match="time is over"):
        call(pendulum())
    assert time.monotonic() - begun < 30


@pytest.fixture
def chain():
    """A simulation whose steps take long."""
    m = hm.Model(plane="xz")
    last = m.ground
    for k in range(1000):
        link = m.body(f"link{k}", mass=1, inertia=0.1, position=[k + 0.5, 0])
        m.revolute(f"pin{k}", last, link, at=[k, 0])
        last = link
    return hm.Simulation(m, step=1e-3)


def test_signals_are_seen_between_long_steps(chain, alarm):
    begun = time.monotonic()
    with pytest.raises(TooLate):
        chain.step(10**6)
    elapsed = time.monotonic() - begun
    assert elapsed < 0.5 + 20 * elapsed / chain.steps
