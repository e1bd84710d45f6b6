"""Check that there is enough memory, before any of it is allocated.

Linux grants more memory than there is, and kills the process when the memory is used.
"""


def require_memory(wanted: str, needed: float) -> None:
    """Raise a ValueError with both numbers unless ``needed`` bytes are available.

    ``wanted`` says what the memory is for, and begins with the name of the argument to change.
    """
    import psutil  # here, because most commands allocate little and start sooner without it

    available = psutil.virtual_memory().available
    if needed > available:
        raise ValueError(
            f"{wanted} would take {needed / 2**30:.3g} GiB of memory, "
            f"{available / 2**30:.3g} GiB are available"
        )
