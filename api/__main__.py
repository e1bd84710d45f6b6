"""``python -m crazybilliards`` is the command ``crazybilliards``."""

from crazybilliards.comparison.commands.line import main

main()
