"""What a folder lacks of a sweep, as the tests ask for it."""


def missing_cases(cases, folder, **options):
    """Return the cases that a folder has no valid file of."""
    return [case for case in cases if not is_there(case, folder, **options)]


def is_there(case, folder, **options):
    try:
        case.check_file(folder, **options)
    except (FileNotFoundError, ValueError):
        return False
    return True
