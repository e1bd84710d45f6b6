"""``python -m crazybilliards`` is the command ``crazybilliards``."""

from crazybilliards.comparison.commands.main import main

main()
