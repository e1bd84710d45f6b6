"""What a function says of a file that it refuses."""


def refused(read, path):
    """Whether reading was refused, in one line that names the file."""
    message = what_is_wrong(read, path)
    assert "\n" not in message, message
    assert not message or str(path.parent) in message, message
    return bool(message)


def what_is_wrong(read, *arguments):
    """Return the message of the ValueError that reading raises; nothing if it succeeds."""
    try:
        read(*arguments)
    except ValueError as error:
        return str(error)
    return ""
