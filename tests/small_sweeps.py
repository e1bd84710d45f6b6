"""A small sweep, an executor that computes its cases here and now, and what a folder lacks."""

from concurrent.futures import Executor, Future

from crazybilliards.comparison.sweeps import Sweep


class AtOnce(Executor):
    """Carries out what is submitted, here and now."""

    def submit(self, function, /, *arguments):
        future = Future()
        try:
            future.set_result(function(*arguments))
        except BaseException as error:
            future.set_exception(error)
        return future


def sweep(**changes):
    given = {"grid": {"size": [3, 5], "restitution": [0.5, 1.0]}, "chain": {"damping": 2.0}}
    given |= {"job": "simulate", "settings": {"duration": 100, "observe": ["widths", "density"]}}
    return Sweep(**(given | changes))


def missing_cases(cases, folder, **options):
    """Return the cases that a folder has no valid file of."""
    return [case for case in cases if not case.is_in(folder, **options)]
