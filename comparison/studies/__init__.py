"""Comparisons of simulation and theory beyond single figures of the paper.

A module that holds a ``STUDY`` is found by ``crazybilliards reproduce``. The other modules are
comparisons that take any chain, each with its pictures; commands, notebooks and figures of the
paper call them.
"""
