"""``python -m crazybilliards`` is the command ``crazybilliards``."""

from crazybilliards.apps.commands.line import main

main()
