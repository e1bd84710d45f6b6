"""The theory: exact equilibrium, force balance, the gas at rest and in time.

The public names are listed in ``__init__.pyi``. Each loads its module when it is first used.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
