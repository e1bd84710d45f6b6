"""``python -m crazybilliards`` is the command ``crazybilliards``."""

from crazybilliards.comparison.commands.entry import main

main()
