"""For every parameter of a chain another value than its default, by its declaration."""

from dataclasses import Field, fields

from crazybilliards.model import Chain


def other_values(**chosen):
    """Return a value for each parameter; ``chosen`` ones replace those worked out."""
    values = {each.name: _other(each) for each in fields(Chain)} | chosen
    return values | {"box": narrow_box(values["size"], values["radius"])}


def narrow_box(size, radius):
    """Return a distance between walls that leaves an eighth of a rod's length to each rod."""
    return 2.25 * radius * size


def _other(parameter: Field):
    default = parameter.default
    if isinstance(default, str):
        choices = parameter.metadata["check"].keywords["choices"]
        return next(choice for choice in choices if choice != default)
    if isinstance(default, int):
        return default + 1
    return 1.3 * default + 0.2
