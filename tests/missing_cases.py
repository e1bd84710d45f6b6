"""What a folder lacks of a sweep, as the tests ask for it."""

from crazybilliards.comparison.sweeps.missing import check_cases, find_missing


def missing_cases(cases, folder, **options):
    """Return the cases that a folder has no valid file of, the shortest first."""
    return list(find_missing(check_cases(cases), folder, **options))
