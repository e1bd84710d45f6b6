"""For every parameter of a chain another value than its default, by its declaration."""

from dataclasses import Field, fields

from crazybilliards.model import Chain


def other_values(**chosen):
    """Return a value for each parameter; ``chosen`` ones replace those worked out."""
    return {each.name: _other(each) for each in fields(Chain)} | chosen


def _other(parameter: Field):
    default = parameter.default
    if isinstance(default, str):
        choices = parameter.metadata["check"].keywords["choices"]
        return next(choice for choice in choices if choice != default)
    if isinstance(default, int):
        return default + 1
    return 1.3 * default + 0.2
